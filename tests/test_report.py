"""The report of a diagnosis: the answer first, complete, in one file, and readable in a real browser."""

import json
import re
from html.parser import HTMLParser
from itertools import pairwise

import pytest

from tests import browser, fixture_diagnosis
from wedgesweep import diagnosis_result, formatting, report, rotation
from wedgesweep.config.model import NO_FRICTION
from wedgesweep.diagnosis_result import VERDICTS, DiagnosisResult
from wedgesweep.effects import EFFECTS
from wedgesweep.errors import InputError, SweepError
from wedgesweep.report import html, ladder, misfit, phrases, summary
from wedgesweep.report.inline_figures import InlineFigures
from wedgesweep.report.sentence import sentence as sentence_of

# The verdict whose page has its figures; test_figures_diagnosis.py draws those of all verdicts.
WITH_FIGURES = "named"
VOID = {"meta", "img", "link", "br"}


class Page(HTMLParser):
    """Tags with their attributes, headings and texts; fails on tags that are not closed."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.headings, self.open, self.texts = [], [], [], []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.texts.append(data)
        if self.open and re.fullmatch("h[1-6]", self.open[-1]):
            self.headings.append((int(self.open[-1][1]), data))

    def of(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]

    @property
    def text(self):
        return plain(" ".join(" ".join(self.texts).split()))


def page_of(directory, document):
    """The report of a result whose document has been changed."""
    (directory / diagnosis_result.JSON).write_text(json.dumps(document), encoding="utf-8")
    return Page(report.write(directory).read_text(encoding="utf-8"))


def told(document, data):
    """The answer of a diagnosis in a sentence."""
    return plain(sentence_of(DiagnosisResult(document, data)))


def plain(text):
    return text.replace(formatting.NO_BREAK, " ").replace("\N{NARROW NO-BREAK SPACE}", " ")


def _caption(figures, name, caption="", tests=None):
    return html.paragraph(caption)


@pytest.fixture
def no_figures(monkeypatch):
    """Pages without figures, for tests of their text."""
    monkeypatch.setattr(InlineFigures, "__call__", _caption)


def _write(directory, verdict):
    """Page of a diagnosis of a verdict; figures of its third test are folded away."""
    with pytest.MonkeyPatch.context() as patched:
        if verdict != WITH_FIGURES:
            patched.setattr(InlineFigures, "__call__", _caption)
        patched.setattr(misfit, "TESTS_SHOWN", 2)
        fixture_diagnosis.write(directory, verdict, tests=3)
        return report.write(directory)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page with its figures."""
    return _write(tmp_path_factory.mktemp(WITH_FIGURES), WITH_FIGURES)


@pytest.fixture(scope="module", params=VERDICTS)
def written(request, tmp_path_factory, page):
    """Verdict, directory and page of a diagnosis of each verdict."""
    if request.param != WITH_FIGURES:
        page = _write(tmp_path_factory.mktemp(request.param), request.param)
    return request.param, page.parent, Page(page.read_text(encoding="utf-8"))


NAMED = "guide_friction; force 2.13 N, 95 % interval 1.95 to 2.31 N"
# Words of the lead, and of the sentence below it.
TOLD = {
    "nothing-missing": ("misses nothing", "over 3 tests the error", "noise alone may leave (p = 0."),
    "named": (
        *("Missing or wrong in the model: ", "Two causes together explain", NAMED),
        *("stribeck; peak 0.080, 95 % interval 0.070 to 0.090", "of the excess over noise is gone"),
    ),
    "consistent-with": ("; the evidence is weak.", "The tests are consistent with", NAMED),
    "tied": ("; these 3 tests cannot tell which.", "Two explanations", "(guide_friction, behind by 3.2)"),
    "data-insufficient": ("cannot show what.", "24 Hz and 0.1 mm would distinguish stribeck from guide_"),
    "none-of-mine": (
        *("none of the known effects.", "none of the 9 candidates explains"),
        "to 1.2 % of the response, friction that falls from its static value with velocity (stribeck)",
    ),
}


def test_the_answer_comes_first_and_nothing_is_left_out(written):
    verdict, directory, page = written
    result = diagnosis_result.read(directory)
    document, lead, sentence = result.document, plain(summary.lead(result)), plain(report.sentence(directory))
    of_lead, *of_sentence = TOLD[verdict]
    assert of_lead in lead
    assert "_" not in lead
    assert all(words in sentence for words in of_sentence)
    # One sentence: a stop only inside numbers and at the end.
    assert re.findall(r"\.(?:\s|$)", sentence) == ["."]
    places = [page.text.index(words) for words in (lead, "Error of the model", sentence, "How it was done")]
    assert places == sorted(places)
    for each in document["candidates"]:
        assert " + ".join(each["effects"]) in page.text
    for words in (*document["detectable"], *document["not_testable"], "next step"):
        assert words in page.text
    assert all(test["name"] in page.text for test in document["misfit"]["tests"])
    if verdict == "named":
        assert "error on held-out tests, times the noise" in page.text
        assert plain(phrases.accuracy(document["ladder"][0]["accuracy"])) in page.text
    row = f"explains all tests to {plain(phrases.accuracy(document['ladder'][1]['accuracy']))} "
    assert (row in page.text) == (verdict == "none-of-mine")


def test_one_accessible_file_that_fetches_nothing(written):
    verdict, directory, page = written
    images = page.of("img")
    assert bool(images) == (verdict == WITH_FIGURES)
    assert all(image["src"].startswith("data:image/svg+xml;base64,") for image in images)
    assert all(len(image["alt"]) > 40 and image["width"] and image["height"] for image in images)
    own = {f"#{tag['id']}" for _, tag in page.tags if "id" in tag}
    assert {link["href"] for link in page.of("a")} <= {"extended.toml", *own}
    assert page.of("script") == page.of("link") == []
    text = (directory / report.PAGE).read_text(encoding="utf-8")
    assert not re.search(r"https?://|url\(|@import", text)
    levels = [level for level, _ in page.headings]
    assert (levels[0], levels.count(1)) == (1, 1)
    assert all(after - before <= 1 for before, after in pairwise(levels))
    assert all(head["scope"] in ("row", "col") for head in page.of("th"))
    assert len(page.of("caption")) == len(page.of("table"))


def test_effects_beyond_two_are_listed_with_their_gain(tmp_path):
    fixture_diagnosis.write(tmp_path, "none-of-mine")
    result = diagnosis_result.read(tmp_path)
    levels = result.document["ladder"]
    further = {"effects": ["guide_friction", "quadratic_drag", "backlash"], "accuracy": 0.02, "rivals": []}
    levels += [{**levels[-1], "effects": ["guide_friction", "quadratic_drag"]}][: 3 - len(levels)]
    told = plain(ladder.section(result, lambda *_: ""))
    assert "one at a time" not in told
    levels.append({**further, "accuracy_held_out": 0.03})
    told = plain(ladder.section(result, lambda *_: ""))
    assert "one at a time, as long as tests left out gain: backlash (held-out tests: 3 %)" in told
    assert "never named" in told


# Accuracies of a cause that leads by far.
LEADING = {"code": "more-accurate", "accuracy": 0.004, "base": 0.47, "next_best": 0.26, "held_out": 0.016}
TIED = {"effects": ["ageing", "preload"], "accuracy": 0.007}
LARGER = [
    {"effects": ["stribeck", other], "accuracy": left}
    for other, left in (("preload", 0.001), ("ageing", 0.002))
]
VARIES = {"code": "varies", "parameter": "friction_level.scale"}
FAR = {"code": "at-limit", "effect": "friction_level", "standard_deviations": 5.03}


def beside(code, *rivals, **numbers):
    """A reason and the rivals that it is about."""
    return {
        "reason": {"code": code, **numbers},
        "rivals": [{"effects": names.split("+"), "gap": 30.0} for names in rivals],
    }


# What is changed in the result of a verdict, and what its sentence then says of the doubt.
DOUBTS = [
    ("consistent-with", {}, "only 300"),
    ("consistent-with", beside("leaves-more", p=0.002), "in the tests that show it, p = 0.002"),
    ("consistent-with", beside("unconfirmed"), "held-out tests do not confirm it"),
    ("consistent-with", beside("unchecked"), "not all rivals and held-out tests were tried"),
    ("consistent-with", {"reason": VARIES | {"p": 0.002}}, "test to test, p = 0.002 for one value"),
    ("consistent-with", {"reason": FAR}, ", 5 standard deviations from what is stated"),
    ("consistent-with", {"reason": LEADING}, "(without: 47 %; next best: 26 %; held-out tests: 1.6 %)"),
    ("consistent-with", {"reason": LEADING | {"parameter": "stribeck.peak"}}, "stribeck.peak differs a"),
    ("consistent-with", {"reason": LEADING | {"larger": LARGER}}, "much less, stribeck + preload (0.1 %) or"),
    ("consistent-with", beside("others-adequate", "preload"), "(preload would also leave only noise)"),
    (
        "consistent-with",
        beside("pair-leaves-less", "guide_friction+preload", model_error=0.04),
        "under a model error of 4 %; guide_friction + preload leave less",
    ),
    ("tied", {"reason": LEADING | {"rivals": [TIED]}}, "or ageing + preload to 0.7 %"),
    ("data-insufficient", beside("no-signal", power_over_noise=1.04), "1 times its power"),
    ("data-insufficient", beside("unchecked"), "so far, to within the noise,"),
    ("data-insufficient", beside("others-adequate", "preload", "stribeck"), "2 explanations would each"),
    ("data-insufficient", beside("few-tests", "preload"), "but so few tests"),
    ("data-insufficient", beside("confounded", "preload+bolster_mass"), "could look like these two"),
    (
        "data-insufficient",
        beside("component-suffices", "end_stop+velocity_lag", effects=["end_stop"]),
        "but end_stop alone leaves hardly more",
    ),
    ("none-of-mine", {"reason": VARIES | {"p": 1e-9}}, "p < 0.001 for one value"),
]


@pytest.mark.parametrize(("verdict", "change", "words"), DOUBTS)
def test_the_reason_for_a_reservation_is_given(verdict, change, words):
    document, data = fixture_diagnosis.build(verdict)
    assert words in told(document | change, data)


def test_tests_that_are_too_few_still_tell_the_best_explanations():
    document, data = fixture_diagnosis.build("data-insufficient")
    document["rivals"] = []
    number, document["record_by_record"] = {"value": 0.7, "ci95": [0.6, 0.8]}, []
    for effect, keys in ("directional_damping", ("asymmetry", "time_s")), ("guide_friction", ("force_N",)):
        own = {"record": "a", "parameters": {f"{effect}.{key}": number for key in keys}}
        one = {"effects": [effect], "accuracy": 0.067, "records": [own, own]}
        document["record_by_record"].append(one)
    sentence = told(document, data)
    assert "cannot show what; so far, to within the noise," in sentence
    levels = [{**each, "accuracy": 1.2} for each in document["ladder"]]
    assert "explains all tests" not in told({**document, "ladder": levels}, data)
    assert "fitted to each by itself, directional_damping to 6.7" in sentence
    assert "with fewer numbers, guide_friction to 6.7 % (guide friction.force 0.7, 0.7 N)" in sentence


def test_sentence_says_what_the_budget_left_out_and_whose_history_matters():
    document, data = fixture_diagnosis.build("none-of-mine")
    complete = told(document, data).removesuffix(".")
    first = {
        "what": "pairs with one of the best single effects",
        "left_out": 60,
        "of": 76,
        "ended_by": "budget",
    }
    then = {"what": "forward selection", "left_out": 20, "of": 20, "ended_by": "budget"}
    for untried, words in (
        ([first], f"before it tried {first['what']} (60 of 76)."),
        ([first, then], f"tried 80 more fits, first of all {first['what']} (60 of 76)."),
    ):
        sentence = told({**document, "untried": untried}, data)
        assert sentence.startswith(complete)
        assert sentence.endswith(words)
    document["untried"] = [first, then]
    assert told({**document, "reason": LEADING}, data).endswith("if nothing of that is missing as well.")
    document["never_tried"] = [["ageing", "preload"], ["end_stop", "preload"]]
    singles = sum(len(each["effects"]) == 1 for each in document["candidates"])
    never = f"2 of the {singles * (singles - 1) // 2} possible pairs of effects were never tried"
    pair = {**document["candidates"][0], "effects": ["preload", "stribeck"]}
    for tried, words in (([pair], "alone or in the pairs that were tried"), ([], "alone; no pair was tried")):
        rows = [*document["candidates"], *tried]
        sentence = told({**document, "candidates": rows}, data)
        assert f"{never} (ageing + preload, end_stop + preload)." in sentence
        assert words in sentence
    late = [{**first, "ended_by": "time limit"}]
    assert "the search had no time left before it tried" in told({**document, "untried": late}, data)
    del document["never_tried"]
    for names, words in ((["a"], "in 1 test (a)"), (list("abcd"), "in 4 tests (a, b and c, ...)")):
        sentence = told({**document, "never_steady": names}, data)
        assert sentence.startswith(f"{complete}; {words} friction keeps ageing")


@pytest.mark.usefixtures("no_figures")
def test_a_next_test_that_was_not_looked_for_is_told_as_such(tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "data-insufficient")
    unfinished = [{"step": "next test", "reason": "time limit"}]
    for steps, times in ((unfinished, 2), ([], 0)):
        page = page_of(tmp_path, {**document, "next_test": None, "unfinished": steps}).text
        assert page.count("The diagnosis ended before it looked for the next test.") == times


def test_sentence_says_what_was_not_tried_because_the_model_lacks_friction():
    document, data = fixture_diagnosis.build("none-of-mine")
    why = dict.fromkeys(("friction_level", "stribeck", "ageing"), NO_FRICTION)
    words = "stribeck and ageing were not tried, as they change friction, and the model has none"
    leading = [document["ladder"][0], {**document["ladder"][1], "effects": ["guide_friction"]}]
    for levels, excluded, told_so in ((leading, why, True), (leading, {}, False), ([], why, False)):
        assert (words in told({**document, "ladder": levels, "excluded": excluded}, data)) == told_so


def test_few_candidates_are_described_in_words():
    document, data = fixture_diagnosis.build("none-of-mine")
    document["detectable"], document["not_testable"] = {}, []
    singles = [each for each in document["candidates"] if len(each["effects"]) == 1]
    for few, words in (([], "there is no candidate that"), (singles[:1], "the only candidate does not")):
        assert words in told({**document, "candidates": few}, data)


# Numbers of tests that are asked for, and words of the sentence and of the order to make them.
OF_OTHER_KINDS = [
    (
        {"kind": "transient", "motion": "release", "start_mm": 2.1, "duration_s": 4.0},
        *("a release from 2.1 mm would", "at rest from 2.1 mm and record its motion for 4 s"),
    ),
    (
        {"kind": "transient", "motion": "sweep", "frequency_hz": 1.25, "to_hz": 5.0}
        | {"amplitude_N": 3.0, "duration_s": 8.0},
        *("a sine-sweep from 1.25 to 5 Hz with 3 N would", "a sine of 3 N from 1.25 to 5 Hz in 8 s"),
    ),
    (
        {"kind": "loop", "frequency_hz": 0.5, "amplitude_mm": 6.0, "duration_s": 6.0},
        *("the force under a sine of 0.5 Hz and 6 mm would", "Impose a sine of 0.5 Hz and 6 mm for 6 s"),
    ),
]


@pytest.mark.usefixtures("no_figures")
def test_a_recommended_test_is_told_as_what_to_do_and_what_it_distinguishes(tmp_path):
    document, data = fixture_diagnosis.write(tmp_path, "tied")
    test = document["next_test"]
    pair = {key: test[key] for key in ("separates", "distance")}
    for numbers, sentence, order in OF_OTHER_KINDS:
        text = page_of(tmp_path, {**document, "next_test": numbers | pair}).text
        assert plain(report.sentence(tmp_path)).endswith(f"{sentence} distinguish them.")
        assert order in text
        assert f'kind = "{numbers["kind"]}"' in text
    for distance, words in ((29.0, "would not reliably"), (31.0, "would")):
        test["distance"] = distance
        assert f"{words} distinguish stribeck from guide_friction" in page_of(tmp_path, document).text
        unsure = "no test would reliably distinguish them, the best one is a test at 24 Hz"
        assert (unsure in told(document, data)) == (distance < 30.0)
    document["rivals"].append({"effects": ["preload"], "gap": 5.0})
    far = {"separates": ["guide_friction", "preload"], "distance": 50.0}
    for distance, words in ((3.0, "stribeck from guide_friction, but not from preload."), (40.0, "them.")):
        near = {"separates": ["stribeck", "preload"], "distance": distance}
        document["next_test"] = {**test, "pairs": [pair, near, far]}
        assert told(document, data).endswith(f"0.1 mm would distinguish {words}")


@pytest.mark.usefixtures("no_figures")
def test_equations_of_what_was_added(tmp_path):
    fixture_diagnosis.write(tmp_path, "consistent-with")
    page = Page(report.write(tmp_path).read_text(encoding="utf-8"))
    # As mathematics, the effect's first, and the base model's after it.
    texts = [math["alttext"] for math in page.of("math")]
    assert texts[0] == "R = -force sign(z')"
    assert "mu = mu_d sign(v)  for |v| > v_t" in texts
    assert "constant dry friction" not in "".join(texts)
    assert not any("_" in text for text in page.texts if text.startswith("mu"))
    assert EFFECTS["guide_friction"].described() in page.text
    assert "Family: missing-force" in page.text


@pytest.mark.usefixtures("no_figures")
def test_of_a_rotation_torques_and_angles_are_told(tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "none-of-mine")
    document["model"] = document["model"] | {"system": "oscillator", "motion": "rotation"}
    page = page_of(tmp_path, rotation.written(document))
    assert not re.search(r"(?<![\w.-])(?:forces?|displacement)(?![\w-])|\(N\)|\bmm\b", page.text, re.I)
    assert "The missing torque" in page.text
    assert "differs from the base model's by 0.4 N m" in plain(page.text)
    assert "at 5.00 × 10⁻⁴ rad and 0.04 rad/s" in plain(page.text)
    assert "stiffness of the spring (N m/rad)" in page.text
    assert rotation.prose("the force of 1 test (force.csv)") == "the torque of 1 test (force.csv)"


@pytest.mark.usefixtures("no_figures")
def test_text_of_the_user_is_not_markup(tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "named")
    document["title"] = 'run <script>alert("1")</script> & $title'
    document["misfit"]["tests"][0]["name"] = "<b>00</b>"
    page = page_of(tmp_path, document)
    assert page.of("script") == page.of("b") == []
    assert 'alert("1")</script> & $title' in page.text
    assert html.element("p", "a < b", title='"') == '<p title="&quot;">a &lt; b</p>'


@pytest.mark.usefixtures("no_figures")
def test_the_page_tells_what_is_unusual(tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "named", tests=5, velocity=False, known=False)
    document["method"]["model_error"] = 0.02
    text = page_of(tmp_path, document).text
    assert "error on held-out tests, times the noise and model error " in text
    assert "of the excess over noise and model error (" in text
    # No interval, nothing detectable, fits without numbers; a number beyond its range; a distortion.
    document["detectable"], document["not_testable"], document["gain"]["ci95"] = {}, [], None
    harmonics = {"second": 0.0021, "second_phase_deg": 20.0, "third": 0.0013, "third_phase_deg": -90.0}
    document["uncertain"] = {"input_distortion": harmonics | {"second_std": 0.0003, "third_std": 0.0002}}
    document["misfit"]["tests"][1]["q_base"] = None
    numbers, friction = (each["parameters"] for each in document["causes"])
    numbers["peak"] = {"value": None, "ci95": [None, None]}
    numbers["velocity_mm_per_s"]["ci95"] = [None, None]
    friction["force_N"]["searched"] = [0.0, 2.0]
    text = page_of(tmp_path, document).text
    for words in (
        *("peak not determined", "velocity 5.10 mm/s, no interval", "too few tests for an interval"),
        *("These tests would not have shown any effect", "No test gives the energy"),
        *("second harmonic over the first 0.0021", "outside of the searched range, 0 to 2"),
    ):
        assert words in text


@pytest.mark.usefixtures("no_figures")
def test_the_page_of_one_test_and_of_numbers_far_from_stated(tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "data-insufficient", tests=1)
    text = page_of(tmp_path, document).text
    assert "too few tests to hold one out" in text
    assert "Uncertain parameters of the model" in text
    document["uncertain"] = {}
    document["not_testable"], document["misfit"]["implausible"] = ["ageing"], ["bolster_mass"]
    document["misfit"] |= {"chi2_base": None, "excess_base": None, "p_base": None}
    document["candidates"] = [each for each in document["candidates"] if each["effects"] in ([], ["ageing"])]
    text = page_of(tmp_path, document | beside("nearly-tolerable", "guide_friction")).text
    assert "Uncertain parameters of the model" not in text
    for words in (
        *("but this test cannot show what", "fitted to 1 test, the base model", "was compared with run-00"),
        *("1 single candidate was fitted", "do not show what it would change, or start phases"),
        *("but only with bolster_mass far from what is stated)", "only noise, but it hardly fits better"),
    ):
        assert words in text


def test_what_is_missing_or_damaged_is_named(tmp_path):
    with pytest.raises(InputError, match=r"diagnosis\.json: no such file; 'wedgesweep diagnose"):
        report.write(tmp_path)
    document, data = fixture_diagnosis.write(tmp_path)
    file = tmp_path / diagnosis_result.JSON
    for broken, words in (
        ("{", "not the JSON of a diagnosis"),
        ("[]", "not a JSON object"),
        (json.dumps({**document, "verdict": "guilty"}), "'guilty' is none of nothing-missing"),
        (json.dumps({key: each for key, each in document.items() if key != "gain"}), "gain: missing"),
    ):
        file.write_text(broken, encoding="utf-8")
        with pytest.raises(InputError, match=re.escape(words)):
            report.write(tmp_path)
    file.write_text(json.dumps(document), encoding="utf-8")
    data.drop_vars("q").to_netcdf(tmp_path / diagnosis_result.DATASET, engine="netcdf4")
    with pytest.raises(InputError, match=r"diagnosis\.nc: has no q"):
        report.write(tmp_path)
    (tmp_path / diagnosis_result.DATASET).write_bytes(b"half a dataset")
    with pytest.raises(SweepError, match="damaged"):
        report.write(tmp_path)
    assert {each.name for each in tmp_path.iterdir()} == {diagnosis_result.JSON, diagnosis_result.DATASET}


@pytest.mark.acceptance
def test_the_page_is_the_same_from_one_process_and_from_two(tmp_path):
    fixture_diagnosis.write(tmp_path, "nothing-missing", tests=2)
    one, two = (report.write(tmp_path, n_jobs).read_text(encoding="utf-8") for n_jobs in (1, 2))
    assert one == two
    assert one.count("<figure ") > 5
    assert "<!--" not in one


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
    if browser.PROGRAM is None:
        pytest.skip("no chromium or chrome here")
    with browser.tab() as found:
        yield found


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
