"""The report of a diagnosis: the answer first, complete, and in one file."""

import json
import re
from html.parser import HTMLParser
from itertools import pairwise

import pytest

from tests import fixture_diagnosis
from wedgesweep import diagnosis_result, formatting, report, rotation
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


@pytest.fixture(scope="module", params=VERDICTS)
def written(request, tmp_path_factory):
    """Verdict, directory and page of a diagnosis of each verdict."""
    directory = tmp_path_factory.mktemp(request.param)
    with pytest.MonkeyPatch.context() as patched:
        if request.param != WITH_FIGURES:
            patched.setattr(InlineFigures, "__call__", _caption)
        patched.setattr(misfit, "TESTS_SHOWN", 2)  # figures of the third are folded away
        fixture_diagnosis.write(directory, request.param, tests=3)
        return request.param, directory, Page(report.write(directory).read_text(encoding="utf-8"))


def test_the_answer_comes_first(written):
    verdict, directory, page = written
    sentence = plain(report.sentence(directory))
    assert sentence.endswith(".")
    assert page.text.index(sentence) < page.text.index(f"Verdict: {verdict}".split(":")[0])
    assert page.text.index(sentence) < page.text.index("How it was done")


def test_nothing_comes_from_elsewhere(written):
    verdict, directory, page = written
    addresses = [image["src"] for image in page.of("img")]
    assert bool(addresses) == (verdict == WITH_FIGURES)
    assert all(address.startswith("data:image/svg+xml;base64,") for address in addresses)
    assert {link["href"] for link in page.of("a")} <= {
        "extended.toml",
        *(f"#{tag['id']}" for _, tag in page.tags if "id" in tag),
    }
    assert not page.of("script")
    assert not page.of("link")
    text = (directory / report.PAGE).read_text(encoding="utf-8")
    assert not re.search(r"https?://|url\(|@import", text)


def test_accessible(written):
    _, _, page = written
    assert all(len(image["alt"]) > 40 and image["width"] and image["height"] for image in page.of("img"))
    levels = [level for level, _ in page.headings]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))
    assert all(head["scope"] in ("row", "col") for head in page.of("th"))
    assert len(page.of("caption")) == len(page.of("table"))


def test_every_candidate_limit_and_test_is_on_the_page(written):
    _, directory, page = written
    document = diagnosis_result.read(directory).document
    for each in document["candidates"]:
        assert " + ".join(each["effects"]) in page.text
    for effect in (*document["detectable"], *document["not_testable"]):
        assert effect in page.text
    for test in document["misfit"]["tests"]:
        assert test["name"] in page.text


NAMED = "guide_friction; force 2.13 N, 95 % interval 1.95 to 2.31 N"
EXPECTED = {
    "nothing-missing": ("Nothing is missing: over 12 tests the error", "noise alone may leave (p = 0."),
    "named": (
        "Two causes together explain",
        "stribeck; peak 0.080, 95 % interval 0.070 to 0.090",
        NAMED,
        "they reduce the error from",
        "of the excess over noise is gone",
    ),
    "consistent-with": ("The tests are consistent with", NAMED, "evidence is weak"),
    "tied": (
        "Two explanations",
        "(guide_friction, behind by 3.2)",
        "a test at 24 Hz and 0.1 mm would distinguish them",
    ),
    "data-insufficient": (
        "but these 2 tests cannot show what",
        "24 Hz and 0.1 mm would distinguish stribeck from guide_friction",
    ),
    "none-of-mine": (
        "none of the 9 candidates explains",
        "best attempt, stribeck, still leaves an error of",
        "to 1.2 % of the response, friction that falls from its static value with velocity (stribeck) "
        "explains all tests (held-out tests: 1.5 %; without: 35 %; next best, guide_friction: 14 %)",
    ),
}


LEADS = {
    "nothing-missing": "The model misses nothing that these tests show.",
    "named": "Missing or wrong in the model: ",
    "consistent-with": "; the evidence is weak.",
    "tied": "; these 3 tests cannot tell which.",
    "data-insufficient": "The model misses something, and these 3 tests cannot show what.",
    "none-of-mine": "The model misses something that is none of the known effects.",
}


def test_the_page_begins_with_what_is_missing_in_plain_words(written):
    verdict, directory, page = written
    result = diagnosis_result.read(directory)
    lead = summary.lead(result)
    assert LEADS[verdict] in lead
    assert "_" not in lead
    assert page.text.index(plain(lead)) < page.text.index("Error of the model")
    assert page.text.index("Error of the model") < page.text.index(plain(report.sentence(directory)))
    assert "next step" in page.text
    if verdict == "named":
        assert "error on held-out tests, times the noise" in page.text
        base = result.document["ladder"][0]["accuracy"]
        assert plain(phrases.accuracy(base)) in page.text
    nearly = result.document["ladder"][1]
    row = f"explains all tests to {plain(phrases.accuracy(nearly['accuracy']))} "
    assert (row in page.text) == (verdict == "none-of-mine")


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


@pytest.mark.parametrize("verdict", VERDICTS)
def test_sentence(verdict):
    sentence = told(*fixture_diagnosis.build(verdict))
    for words in EXPECTED[verdict]:
        assert words in sentence
    # One sentence: a stop only inside numbers and at the end.
    assert not re.search(r"\.\s", sentence)


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


@pytest.mark.parametrize(
    ("verdict", "change", "words"),
    [
        ("consistent-with", {}, "(the misfit exceeds noise by only 300)"),
        (
            "consistent-with",
            beside("leaves-more", p=0.002),
            "(it leaves more than noise in the tests that show it, p = 0.002)",
        ),
        ("consistent-with", beside("unconfirmed"), "(held-out tests do not confirm it)"),
        (
            "consistent-with",
            {"reason": VARIES | {"p": 0.002}},
            "(friction_level.scale would have to differ from test to test, p = 0.002 for one value)",
        ),
        (
            "consistent-with",
            {"reason": FAR},
            ", 5 standard deviations from what is stated; with it as stated the model does not fit.",
        ),
        ("consistent-with", beside("unchecked"), "(not all rivals and held-out tests were tried)"),
        (
            "consistent-with",
            {"reason": LEADING},
            "explains all tests (without: 47 %; next best: 26 %; held-out tests: 1.6 %), though no",
        ),
        (
            "consistent-with",
            {"reason": LEADING | {"parameter": "stribeck.peak"}},
            "though stribeck.peak differs a little from test to test: ",
        ),
        (
            "tied",
            {"reason": LEADING | {"rivals": [TIED]}},
            "explains all tests, or ageing + preload to 0.7 % (without: 47 %;",
        ),
        (
            "consistent-with",
            {"reason": LEADING | {"larger": LARGER}},
            "; more is missing: another effect beside it leaves much less, stribeck + preload (0.1 %) or",
        ),
        (
            "data-insufficient",
            {"reason": {"code": "no-signal", "power_over_noise": 1.04}},
            "These 2 tests hold hardly more than noise: 1 times its power",
        ),
        (
            "data-insufficient",
            {"reason": {"code": "unchecked"}},
            "and not everything was tried that may explain it; so far, to within the noise,",
        ),
        (
            "none-of-mine",
            {"reason": VARIES | {"p": 1e-9}},
            "(friction_level.scale would have to differ from test to test, p < 0.001 for one value)",
        ),
        ("none-of-mine", {"reason": {"code": "unconfirmed"}}, "(held-out tests do not confirm it)"),
        (
            "consistent-with",
            beside("others-adequate", "preload"),
            "(preload would also leave only noise)",
        ),
        (
            "consistent-with",
            beside("pair-leaves-less", "guide_friction+preload", model_error=0.04),
            "(by itself it explains the tests only under a model error of 4 %; "
            "guide_friction + preload leave less)",
        ),
        (
            "data-insufficient",
            beside("others-adequate", "preload", "stribeck"),
            "cannot show what: 2 explanations would each leave only noise; a test",
        ),
        (
            "data-insufficient",
            beside("few-tests", "preload"),
            "what: preload would leave only noise, but so few tests",
        ),
        (
            "data-insufficient",
            beside("confounded", "preload+bolster_mass"),
            "no candidate could look like these two",
        ),
        (
            "data-insufficient",
            beside("component-suffices", "end_stop+velocity_lag", effects=["end_stop"]),
            "but end_stop alone leaves hardly more",
        ),
        (
            "data-insufficient",
            beside("unconfirmed", "ageing"),
            "ageing would leave only noise, but held-out tests do not confirm it",
        ),
    ],
)
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


def test_sentence_says_what_the_budget_left_out():
    document, data = fixture_diagnosis.build("none-of-mine")
    complete = told(document, data)
    first = {"what": "pairs with one of the best single effects", "left_out": 60, "of": 76}
    then = {"what": "forward selection", "left_out": 20, "of": 20}
    for untried, words in (
        ([first], f"before it tried {first['what']} (60 of 76)."),
        ([first, then], f"tried 80 more fits, first of all {first['what']} (60 of 76)."),
    ):
        document["untried"] = untried
        sentence = told(document, data)
        assert sentence.startswith(complete.removesuffix("."))
        assert sentence.endswith(words)
        assert not re.search(r"\.\s", sentence)
    numbers = {"accuracy": 0.1, "base": 0.5, "next_best": 0.4, "held_out": 0.1}
    leading = told({**document, "reason": {"code": "more-accurate", **numbers}}, data)
    assert leading.endswith("; the intervals hold if nothing of that is missing as well.")
    document["never_tried"] = [["ageing", "preload"], ["end_stop", "preload"]]
    singles = sum(len(each["effects"]) == 1 for each in document["candidates"])
    never = f"2 of the {singles * (singles - 1) // 2} possible pairs of effects were never tried"
    assert f"{never} (ageing + preload, end_stop + preload)." in told(document, data)


def test_sentence_names_tests_whose_history_matters():
    document, data = fixture_diagnosis.build("named")
    complete = told(document, data)
    for names, words in ((["a"], "in 1 test (a)"), (list("abcd"), "in 4 tests (a, b and c, ...)")):
        document["never_steady"] = names
        sentence = told(document, data)
        assert sentence.startswith(f"{complete.removesuffix('.')}; {words} friction keeps ageing")


@pytest.mark.parametrize(
    ("candidates", "words"),
    [(0, "there is no candidate that these tests could show"), (1, "the only candidate does not explain it")],
)
def test_few_candidates_are_described_in_words(candidates, words):
    document, data = fixture_diagnosis.build("none-of-mine")
    document["candidates"] = [each for each in document["candidates"] if len(each["effects"]) == 1][
        :candidates
    ]
    document["detectable"], document["not_testable"] = {}, []
    assert words in told(document, data)


@pytest.mark.usefixtures("no_figures")
@pytest.mark.parametrize(("size", "words"), [(0.0, "noise"), (0.02, "noise and model error")])
def test_the_gain_says_over_what_the_excess_is(size, words, tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "named")
    document["method"]["model_error"] = size
    text = page_of(tmp_path, document).text
    assert f"of the excess over {words} is gone (" in plain(report.sentence(tmp_path))
    assert f"error on held-out tests, times the {words} " in f"{text} "
    assert f"of the excess over {words} (" in text


@pytest.mark.usefixtures("no_figures")
@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        ("tied", "no test would reliably distinguish them, the best one is a test at 24 Hz"),
        ("data-insufficient", "no test would reliably distinguish stribeck from"),
    ],
)
def test_a_recommended_test_says_whether_it_distinguishes_reliably(verdict, words, tmp_path):
    document, data = fixture_diagnosis.write(tmp_path, verdict)
    document["next_test"]["distance"] = 29.0
    assert words in told(document, data)
    weak = page_of(tmp_path, document).text
    assert "would not reliably distinguish stribeck from guide_friction" in weak
    document["next_test"]["distance"] = 31.0
    assert "would distinguish stribeck from guide_friction" in page_of(tmp_path, document).text


OTHER_KINDS = {
    "release": (
        {"kind": "transient", "motion": "release", "start_mm": 2.1, "duration_s": 4.0},
        "a release from 2.1 mm would distinguish them",
        "Release the mass at rest from 2.1 mm and record its motion for 4 s",
    ),
    "sweep": (
        {
            **{"kind": "transient", "motion": "sweep", "frequency_hz": 1.25, "to_hz": 5.0},
            **{"amplitude_N": 3.0, "duration_s": 8.0},
        },
        "a sine-sweep from 1.25 to 5 Hz with 3 N would distinguish them",
        "Sweep a sine of 3 N from 1.25 to 5 Hz in 8 s; record input and motion",
    ),
    "loop": (
        {"kind": "loop", "frequency_hz": 0.5, "amplitude_mm": 6.0, "duration_s": 6.0},
        "the force under a sine of 0.5 Hz and 6 mm would distinguish them",
        "Impose a sine of 0.5 Hz and 6 mm for 6 s; record displacement and force",
    ),
}


@pytest.mark.usefixtures("no_figures")
@pytest.mark.parametrize("kind", OTHER_KINDS)
def test_a_test_of_another_kind_is_told_as_what_to_do(kind, tmp_path):
    document, _ = fixture_diagnosis.write(tmp_path, "tied")
    test, sentence, order = OTHER_KINDS[kind]
    document["next_test"] = test | {key: document["next_test"][key] for key in ("separates", "distance")}
    text = page_of(tmp_path, document).text
    assert plain(report.sentence(tmp_path)).endswith(f"{sentence}.")
    assert order in text
    assert f'kind = "{test["kind"]}"' in text


def test_rivals_that_the_next_test_does_not_distinguish_are_named():
    document, data = fixture_diagnosis.build("tied")
    document["rivals"].append({"effects": ["preload"], "gap": 5.0})
    test = document["next_test"]
    near = {"separates": ["stribeck", "preload"], "distance": 3.0}
    far = {"separates": ["guide_friction", "preload"], "distance": 50.0}
    for distance, words in ((3.0, "stribeck from guide_friction, but not from preload."), (40.0, "them.")):
        pairs = [{key: test[key] for key in ("separates", "distance")}, {**near, "distance": distance}, far]
        document["next_test"] = {**test, "pairs": pairs}
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
    assert not page.of("script")
    assert not page.of("b")
    assert 'alert("1")</script> & $title' in page.text
    assert html.element("p", "a < b", title='"') == '<p title="&quot;">a &lt; b</p>'


def without_steady_response(document):
    document["misfit"] |= {"chi2_base": None, "excess_base": None, "p_base": None}
    document |= beside("leaves-more", p=0.002)


def with_one_candidate(document):
    document["not_testable"] = ["ageing"]
    document["candidates"] = [each for each in document["candidates"] if each["effects"] in ([], ["ageing"])]


def far_from_stated(document):
    document["misfit"]["implausible"] = ["bolster_mass", "friction_level"]
    document |= beside("nearly-tolerable", "guide_friction")


def beyond_range(document):
    document["causes"][0]["parameters"]["peak"]["searched"] = [0.0, 0.05]


def with_distortion(document):
    harmonics = {"second": 0.0021, "second_phase_deg": 20.0, "third": 0.0013, "third_phase_deg": -90.0}
    document["uncertain"]["input_distortion"] = harmonics | {"second_std": 0.0003, "third_std": 0.0002}


def lacking_numbers(document):
    """No interval, nothing detectable, fits without numbers."""
    document["detectable"], document["not_testable"], document["uncertain"] = {}, [], {}
    document["misfit"]["tests"][1]["q_base"] = None
    document["causes"][0]["parameters"]["peak"] = {"value": None, "ci95": [None, None]}
    document["causes"][0]["parameters"]["velocity_mm_per_s"]["ci95"] = [None, None]
    document["gain"]["ci95"] = None


PAGES = {
    without_steady_response: (
        ("consistent-with", {}),
        ("it leaves more than noise in the tests that show it, p = 0.002",),
    ),
    with_one_candidate: (
        ("data-insufficient", {"tests": 1}),
        (
            *("but this test cannot show what", "fitted to 1 test, the base model"),
            *("was compared with run-00", "1 single candidate was fitted"),
            "do not show what it would change, or start phases",
        ),
    ),
    far_from_stated: (
        ("data-insufficient", {}),
        (
            "but only with bolster_mass and friction_level far from what is stated)",
            "would leave only noise, but it hardly fits better",
        ),
    ),
    beyond_range: (("named", {}), ("0.070 to 0.090; outside of the searched range, 0 to 0.05",)),
    with_distortion: (
        ("named", {}),
        (
            *("scale of friction_level 1.03", "second harmonic over the first 0.0021"),
            "third harmonic over the first 0.0013",
        ),
    ),
    lacking_numbers: (
        ("named", {"tests": 5, "velocity": False, "known": False}),
        (
            *("peak not determined", "velocity 5.10 mm/s, no interval", "too few tests for an interval"),
            *("These tests would not have shown any effect", "No test gives the energy"),
        ),
    ),
}


@pytest.mark.usefixtures("no_figures")
@pytest.mark.parametrize("change", PAGES, ids=lambda change: change.__name__)
def test_the_page_tells_what_is_unusual(change, tmp_path):
    (verdict, options), expected = PAGES[change]
    document, _ = fixture_diagnosis.write(tmp_path, verdict, **options)
    change(document)
    text = page_of(tmp_path, document).text
    for words in expected:
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
