"""The report in a real browser, opened from disk: whole, quiet, readable in light, dark and on paper."""

import pytest

from tests import browser, fixture_diagnosis
from wedgesweep import report

pytestmark = pytest.mark.skipif(browser.PROGRAM is None, reason="no chromium or chrome here")

# Contrast of WCAG 2 between the colours of all texts and the background behind them, the least of them.
CONTRAST = """(() => {
  const channels = colour => colour.match(/[\\d.]+/g).map(Number);
  const linear = c => (c /= 255) <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const light = colour => {
    const [r, g, b] = channels(colour).map(linear);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = node => {
    const colour = getComputedStyle(node).backgroundColor;
    return node.parentElement && channels(colour)[3] === 0 ? behind(node.parentElement) : colour;
  };
  const texts = document.querySelectorAll("p, h1, h2, h3, th, td, a, summary, figcaption, caption, pre");
  return Math.min(...[...texts].map(node => {
    const both = [light(getComputedStyle(node).color), light(behind(node))].sort((a, b) => b - a);
    return (both[0] + 0.05) / (both[1] + 0.05);
  }));
})()"""


@pytest.fixture(scope="module")
def tab():
    with browser.tab() as found:
        yield found


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    directory = tmp_path_factory.mktemp("named")
    fixture_diagnosis.write(directory, "named", tests=3)
    return report.write(directory)


def test_opens_without_error_and_without_network(tab, page):
    tab.open(page)
    assert tab.evaluate("document.readyState") == "complete"
    faults = [event["entry"] for event in tab.of("Log.entryAdded")]
    assert faults + tab.of("Runtime.consoleAPICalled") + tab.of("Runtime.exceptionThrown") == []
    asked = {event["request"]["url"].partition(":")[0] for event in tab.of("Network.requestWillBeSent")}
    assert asked <= {"file", "data"}
    assert tab.of("Network.loadingFailed") == []
    assert tab.evaluate("document.querySelector('main .sentence').innerText") == report.sentence(page.parent)


def test_the_browser_reports_errors(tab, tmp_path):
    """A page that requests a missing file and logs an error is noticed, so the test above can fail."""
    page = tmp_path / "page.html"
    page.write_text("<img src='http://127.0.0.1:9/none.png'><script>console.error('heard')</script>")
    tab.open(page)
    assert tab.of("Runtime.consoleAPICalled")
    assert any(event["request"]["url"].startswith("http") for event in tab.of("Network.requestWillBeSent"))


def test_every_figure_has_a_size_and_is_inside_the_page(tab, page):
    for width in (1100, 390):
        tab.open(page, width=width)
        tab.evaluate("document.querySelectorAll('details').forEach(each => each.open = true)")
        tab.evaluate("Promise.all([...document.images].map(each => each.decode())).then(() => true)")
        sizes = tab.evaluate("[...document.images].map(i => [i.naturalWidth, i.width, i.height, i.complete])")
        assert len(sizes) >= 10
        assert all(natural > 0 and shown > 0 and high > 0 and done for natural, shown, high, done in sizes)
        # Figures keep their size, so that their text can be read, and scroll in place.
        drawn = tab.evaluate("[...document.images].map(i => [i.width, +i.getAttribute('width')])")
        assert all(shown == own for shown, own in drawn)
        boxes = tab.evaluate("[...document.querySelectorAll('figure')].map(f => f.clientWidth)")
        assert all(0 < box <= width for box in boxes)
        assert tab.evaluate("document.documentElement.scrollWidth") <= width
        small = "[...document.querySelectorAll('body *')].map(e => parseFloat(getComputedStyle(e).fontSize))"
        assert min(tab.evaluate(small)) >= 10.0


@pytest.mark.acceptance
def test_a_figure_opens_large_on_a_tap_and_closes_where_it_was(tab, page):
    box = "(({left, top, width, height}) => [left, top, width, height])"
    box += "(document.querySelector('figure').getBoundingClientRect())"
    for width in (1200, 400):
        tab.open(page, width=width)
        before = tab.evaluate("document.querySelector('figure img').width")
        tab.evaluate("document.querySelector('figure a.open').click()")
        assert tab.evaluate(box) == [0, 0, width, 900]
        assert tab.evaluate("document.querySelector('figure img').width") >= 1.4 * before
        assert tab.evaluate("document.querySelector('figure').scrollWidth") > width
        tab.evaluate("document.querySelector('figure a.close').click()")
        left, top, _, height = tab.evaluate(box)
        assert tab.evaluate("document.querySelector('figure img').width") == before
        assert left > 0
        assert -10 <= top < 900
        assert height < 900


@pytest.mark.acceptance
def test_texts_stand_out_in_light_and_dark(tab, page):
    backgrounds = []
    for dark in (False, True):
        tab.open(page, dark=dark)
        backgrounds.append(tab.evaluate("getComputedStyle(document.body).backgroundColor"))
        assert tab.evaluate(CONTRAST) > 4.5
    assert backgrounds[0] != backgrounds[1]


@pytest.mark.acceptance
def test_prints(tab, page, tmp_path):
    tab.open(page, dark=True)
    assert tab.print().startswith(b"%PDF")
    tab.screenshot(tmp_path / "page.png")
    assert (tmp_path / "page.png").stat().st_size > 100_000
