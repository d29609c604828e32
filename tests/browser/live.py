"""sphode run --live in a browser: python3 live.py SPHODE CASE.yml; frames come, pause, go on and stop do what they say,
only the right address answers, and what is watched has the same bits as what is not."""
import atexit
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
common = [sphode, "run", case, "--quiet", "--lenient", "--force", "--set", "run.end=0.03s", "--set", "checkpoint.steps=100", "--set", "output.series=2e-5s"]


def start(directory, *more):
    run = subprocess.Popen([*common, "-o", directory, "--live", *more], stderr=subprocess.PIPE, text=True)
    atexit.register(run.kill)  # a failure while it is paused would leave it
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
    dark = "Array.from(document.getElementById('%s').getContext('2d').getImageData(0, 20, 58, 400).data).filter((v, i) => i %% 4 < 3 && v < 160).length"
    assert browser.run(dark % "view") > 100, "numbers stand beside the axis"
    assert browser.run("tics(0, 1, 5)") == [0, 0.2, 0.4, 0.6000000000000001, 0.8, 1]
    low, high = browser.run("colours(last)")
    values = browser.run("Array.from(last.data).filter((v, i) => i < 3 * last.fluid && i % 3 === 2)")
    assert min(values) <= low < high <= max(values) and sum(low <= v <= high for v in values) >= 0.98 * len(values), "colours leave out half a percent at either end"
    marks = [float(t) for t in browser.run("Array.from(document.querySelectorAll('#range span')).map(s => s.textContent)")]
    assert len(marks) >= 2 and marks == sorted(marks) and low <= marks[0] and marks[-1] <= high * (1 + 1e-6), marks
    browser.click("#pause")
    browser.until("it goes on", lambda: step() > held)
    browser.until("its end is told", lambda: "ended" in state(), 120)
    assert run.wait(60) == 0, run.returncode
    with open(os.path.join(watched, "series.csv")) as file:
        head, *lines = file.read().split("\n")[:-1]
    names, rows = browser.run("table.names"), browser.run("table.rows")
    assert names == head.split(",") and browser.run("Array.from(document.getElementById('column').options).map(o => o.value)") == names[1:]
    written = {line.split(",")[0]: line for line in lines}
    times = [float(t) for t in written]
    assert len(lines) > 1000 and 200 < len(rows) <= 402, (len(lines), len(rows))
    assert all(row == [float(x) for x in lines[times.index(row[0])].split(",")] for row in rows), "its rows are those of the table"
    steps = {times.index(b[0]) - times.index(a[0]) for a, b in zip(rows[:-1], rows[1:-1])}
    assert len(steps) == 1, steps
    chart = "document.getElementById('series').toDataURL()"
    assert browser.text("#column").startswith("step") and browser.run("document.getElementById('column').value") == "kinetic [J/m]"
    kinetic = browser.run(chart)
    browser.keys("#column", "front")
    assert browser.run("document.getElementById('column').value") == "front [m]" and browser.run(chart) != kinetic, "another column is drawn"
    stopped, url, port = start(os.path.join(folder.name, "stopped"), "--set", "run.end=10s")
    browser.open(url)
    browser.until("a frame comes", lambda: step() > 0)
    browser.click("#stop")
    assert stopped.wait(60) == 1, stopped.returncode
subprocess.run([*common, "-o", alone], check=True)
series = [os.path.join(directory, "series.csv") for directory in (watched, alone)]
assert filecmp.cmp(*series, shallow=False), "not the same bits"
print("the live page: frames, colours, pause, go on, stop; the run has the bits of one that nobody watched")
