"""A browser, driven by clicks: the W3C WebDriver protocol, spoken to chromedriver with nothing but Python."""
import json
import re
import shutil
import subprocess
import sys
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


def skip(reason):
    print(reason, file=sys.stderr)
    sys.exit(77)


class Browser:
    def __enter__(self):
        driver = shutil.which("chromedriver") or skip("no chromedriver here (Debian: chromium-driver)")
        self.process = subprocess.Popen([driver, "--port=0"], stdout=subprocess.PIPE, text=True)
        for line in self.process.stdout:
            found = re.search(r"on port (\d+)", line)
            if found and found.group(1) != "0":
                self.root = f"http://127.0.0.1:{found.group(1)}"
                break
        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1300,900"]
        options = {"goog:chromeOptions": {"args": arguments}}
        self.session = None
        self.session = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": options}})["sessionId"]
        return self

    def __exit__(self, *about):
        try:
            if self.session:
                self.ask("DELETE", "")
        finally:
            self.process.terminate()
            self.process.wait()

    def ask(self, method, path, body=None):
        path = path if path == "/session" else f"/session/{self.session}{path}"
        data = json.dumps(body if body is not None else {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as reply:
                return json.load(reply)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()) from None

    def open(self, url):
        self.ask("POST", "/url", {"url": url})

    def find(self, css):
        return self.ask("POST", "/element", {"using": "css selector", "value": css})[ELEMENT]

    def click(self, css):
        self.ask("POST", f"/element/{self.find(css)}/click")

    def keys(self, css, text):
        self.ask("POST", f"/element/{self.find(css)}/value", {"text": text})

    def text(self, css):
        return self.ask("GET", f"/element/{self.find(css)}/text")

    def run(self, script):
        return self.ask("POST", "/execute/sync", {"script": "return " + script, "args": []})

    def until(self, what, condition, seconds=30):
        """Waits for condition(); what it is, for the message."""
        end = time.time() + seconds
        while time.time() < end:
            if condition():
                return
            time.sleep(0.1)
        raise SystemExit(f"not within {seconds} s: {what}")
