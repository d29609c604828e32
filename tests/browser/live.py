"""sphode run --live in a browser: python3 live.py SPHODE CASE.yml; frames come, pause, go on and stop do what they say,
only the right address answers, and what is watched has the same bits as what is not."""
import filecmp
import os
import re
import subprocess
import sys
import tempfile
import urllib.error
import urllib.request

from drive import Browser, skip

sphode, case = sys.argv[1:3]
folder = tempfile.TemporaryDirectory()
watched, alone = os.path.join(folder.name, "watched"), os.path.join(folder.name, "alone")
common = [sphode, "run", case, "--quiet", "--lenient", "--force", "--set", "run.end=0.03s", "--set", "checkpoint.steps=100"]


def start(directory, *more):
    run = subprocess.Popen([*common, "-o", directory, "--live", *more], stderr=subprocess.PIPE, text=True)
    for line in run.stderr:
        if "without libmicrohttpd" in line:
            skip(line.strip())
        found = re.search(r"http://127\.0\.0\.1:(\d+)/[0-9a-f]{32}/", line)
        if found:
            return run, found.group(0), found.group(1)
    raise SystemExit("no address was told")


def status(url, method="GET"):
    try:
        return urllib.request.urlopen(urllib.request.Request(url, method=method), timeout=20).status
    except urllib.error.HTTPError as error:
        return error.code


with Browser() as browser:
    run, url, port = start(watched)
    assert status(url + "pause", "POST") == 200
    browser.open(url)
    step = lambda: int(browser.run("document.body.dataset.step || 0"))
    state = lambda: browser.text("#state")
    browser.until("a frame comes, paused", lambda: step() > 0 and "paused" in state())
    for wrong in ["", "0" * 32 + "/", url.split("/")[3][:-1] + "/"]:
        assert status(f"http://127.0.0.1:{port}/{wrong}") == 404, wrong
    assert status(url + "frame", "DELETE") == 405 and status(url + "frames") == 404
    assert status(url + "burn", "POST") == 404
    held = step()
    browser.keys("#field", "pressure")
    browser.until("the colour is the pressure", lambda: "[Pa]" in browser.text("#unit"))
    assert step() == held, "a paused run makes no step"
    lit = "Array.from(document.getElementById('view').getContext('2d').getImageData(0, 0, 2000, 2000).data).filter((v, i) => i % 4 < 3 && v < 250).length"
    assert browser.run(lit) > 1000, "particles are drawn"
    browser.click("#pause")
    browser.until("it goes on", lambda: step() > held)
    browser.until("its end is told", lambda: "ended" in state(), 120)
    assert run.wait(60) == 0, run.returncode
    stopped, url, port = start(os.path.join(folder.name, "stopped"), "--set", "run.end=10s")
    browser.open(url)
    browser.until("a frame comes", lambda: step() > 0)
    browser.click("#stop")
    assert stopped.wait(60) == 1, stopped.returncode
subprocess.run([*common, "-o", alone], check=True)
series = [os.path.join(directory, "series.csv") for directory in (watched, alone)]
assert filecmp.cmp(*series, shallow=False), "not the same bits"
print("the live page: frames, colours, pause, go on, stop; the run has the bits of one that nobody watched")
