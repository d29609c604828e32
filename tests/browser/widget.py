"""docs/widget in a browser: every control changes what it must."""
import pathlib
import sys

from drive import Browser

page = pathlib.Path(__file__).resolve().parents[2] / "docs/widget/index.html"
RIGHT, END, HOME = "\ue014", "\ue010", "\ue011"


def neighbours(browser):
    return float(browser.run("document.querySelector('#facts tr:nth-child(2) td:nth-child(2)').textContent"))


with Browser() as browser:
    browser.open(page.as_uri())
    browser.until("the table is filled", lambda: "neighbours" in browser.text("#facts"))
    first = neighbours(browser)
    assert "Sound" in browser.text("#verdict"), browser.text("#verdict")
    browser.keys("#h", END)
    assert neighbours(browser) > 3 * first and "Larger" in browser.text("#verdict"), "h at its largest"
    browser.keys("#h", HOME)
    assert neighbours(browser) < first / 3 and "Too small" in browser.text("#verdict"), "h at its smallest"
    browser.keys("#kernel", "quintic-spline")
    assert browser.run("document.getElementById('h').value") == "1", "a kernel brings its h"
    two = neighbours(browser)
    browser.keys("#dim", "3")
    browser.until("3D has more neighbours", lambda: neighbours(browser) > 2 * two)
    before = browser.text("#facts tr:nth-child(3)")
    browser.keys("#disorder", HOME)
    assert browser.text("#facts tr:nth-child(3)") != before, "order changes the density estimate"
    browser.keys("#dx", RIGHT * 5)
    assert browser.text("#dxText") == "15 mm", browser.text("#dxText")
print("the page on the choice of h: 7 controls and their numbers")
sys.exit(0)
