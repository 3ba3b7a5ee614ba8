"""Parts of sentences in plain text: parameters with units and intervals, p-values, effects, counts."""

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any, NamedTuple

from wedgesweep import formatting, rotation
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.effects import EFFECTS
from wedgesweep.formatting import LARGE, NO_BREAK, NONE, SMALL, decimals, fixed, number, percent, short
from wedgesweep.quantity import Quantity

NOISE = "noise"
INTERVAL = f"95{NO_BREAK}% interval"
# What a record is compared in, by the kind of the tests; a steady test is compared as a whole.
PARTS = {"transient": "window", "loop": "block", "mixed": "record part"}


class Rounded(NamedTuple):
    """A fitted value and the ends of its interval, as text; the ends are empty where it has none."""

    value: str
    low: str
    high: str


def probability(p: float | None) -> str:
    """A p-value; a tiny one only as a bound."""
    return NONE if p is None else "< 0.001" if p < 1e-3 else f"{p:.2g}"


def p_value(p: float | None) -> str:
    """A p-value with its symbol: p = 0.02, p < 0.001."""
    text = probability(p)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def listing(words: Sequence[str], last: str = "and") -> str:
    """Words in a row: a, b and c."""
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def split_key(key: str) -> tuple[str, str]:
    """Name and unit of a config key."""
    quantity = Quantity(key, 0.0, "")
    return quantity.name.replace("_", " "), quantity.symbol


def with_unit(text: str, unit: str) -> str:
    """A number with its unit."""
    return f"{text}{unit}" if unit == "°" or not unit else f"{text}{NO_BREAK}{unit}"


def estimate(key: str, fitted: Mapping[str, Any]) -> str:
    """A fitted parameter with its interval, for a sentence."""
    name, unit = split_key(key)
    if fitted["value"] is None:
        return f"{name} not determined"
    value, low, high = rounded(fitted)
    interval = f"{INTERVAL} {low} to {with_unit(high, unit)}" if low else "no interval"
    return f"{name} {with_unit(value, unit)}, {interval}"


def numbers(key: str, values: Sequence[float | None]) -> str:
    """Numbers of several records in a row."""
    name, unit = split_key(key)
    return f"{name} {with_unit(', '.join(formatting.short(value, 3) for value in values), unit)}"


def compact(key: str, fitted: Mapping[str, Any]) -> str:
    """A fitted parameter with its interval in brackets, for a table whose head says so."""
    name, unit = split_key(key)
    value, low, high = rounded(fitted)
    return f"{name} {with_unit(value, unit)}" + (f" ({low} to {high})" if low else "")


def rounded(fitted: Mapping[str, Any]) -> Rounded:
    """A fitted parameter to two digits of the width of its interval, if it has one."""
    ends = fitted["ci95"]
    if fitted["value"] is None or ends is None or None in ends:
        return Rounded(number(fitted["value"]), "", "")
    values = (fitted["value"], *ends)
    width, largest = abs(ends[1] - ends[0]), max(map(abs, values))
    if width == 0.0 or not SMALL <= largest < LARGE:
        return Rounded(*map(number, values))
    return Rounded(*(_to_places(each, decimals(width, 2)) for each in values))


def _to_places(value: float, places: int) -> str:
    """A number with ``places`` decimals; one that they would round to 0 keeps one digit instead."""
    vanishes = value != 0.0 and round(value, places) == 0.0
    return number(value, 1) if vanishes else fixed(value, places)


def allowed(document: Mapping[str, Any]) -> str:
    """What may be left where a model is right: noise, and the model error where one is allowed."""
    return "noise and model error" if document["method"].get("model_error") else "noise"


def excess_removed(gain: Mapping[str, Any], document: Mapping[str, Any], verb: str = "") -> str:
    """The gain on held-out tests with its interval; ``verb`` comes before the interval."""
    between = "too few tests for an interval"
    if gain["ci95"]:
        low, high = gain["ci95"]
        between = f"{INTERVAL} {percent(low)} to {percent(high)}"
    return f"{percent(gain['excess_removed'])} of the excess over {allowed(document)}{verb} ({between})"


def system(document: Mapping[str, Any]) -> str:
    """The mechanical system of a diagnosis."""
    return document["model"].get("system", "suspension")


def turns(document: Mapping[str, Any]) -> bool:
    """Whether a diagnosis is of an oscillator that turns."""
    return document["model"].get("motion") == rotation.ROTATION


def meaning(effect: str, document: Mapping[str, Any]) -> str:
    """What an effect is, in words, on the system of a diagnosis."""
    if effect not in EFFECTS:
        return effect.replace("_", " ")
    return EFFECTS[effect].described(system(document))


def meanings(effects: Sequence[str], document: Mapping[str, Any]) -> str:
    """What the effects of one explanation are, in words."""
    return listing([meaning(effect, document) for effect in effects])


def combination(effects: Sequence[str]) -> str:
    """The effects of one explanation, by name."""
    return " + ".join(effects) or "base model"


def explain(effects: Sequence[Any]) -> str:
    """What these effects do with tests: the verb."""
    return "explains" if len(effects) == 1 else "explain"


def accuracy(size: float | None) -> str:
    """A relative model error as a share of the response; 0 is noise alone."""
    if size is None:
        return "none"
    return NOISE if size == 0.0 else formatting.error(size)


def error_of(result: DiagnosisResult, model: str) -> str:
    """The error of a model, "base" or "extended", in standard deviations of the noise."""
    misfit = result.document["misfit"]
    q, dof = misfit[f"chi2_{model}"], misfit.get(f"dof_{model}", misfit["dof"])
    return number(None if q is None or dof <= 0 else sqrt(q / dof))


def _compared(result: DiagnosisResult) -> tuple[int, str]:
    """How many parts of the records a diagnosis compares, and what one of them is called."""
    return result.data.sizes["test"], PARTS.get(result.document.get("kind", "steady"), "test")


def compared(result: DiagnosisResult) -> str:
    """What a diagnosis compares: 1 test, 12 tests, 12 windows."""
    return formatting.counted(*_compared(result))


def these_tests(result: DiagnosisResult) -> str:
    """What a diagnosis compares, at the beginning of a clause: this test, these 12 tests."""
    count, name = _compared(result)
    return f"this {name}" if count == 1 else f"these {count} {name}s"


class Separated(NamedTuple):
    """What the recommended test distinguishes from the ``first`` explanation, and what it does not."""

    first: str
    others: list[str]
    left: list[str]

    @property
    def text(self) -> str:
        """As the end of a sentence."""
        but = f", but not from {listing(self.left, 'or')}" if self.left else ""
        return f"{self.first} from {listing(self.others)}{but}"


def separated(document: Mapping[str, Any]) -> Separated | None:
    """What the recommended test distinguishes; None if it is only the best that there is."""
    test, enough = document["next_test"], document["method"]["enough_distance"]
    if test["distance"] < enough:
        return None
    first = test["separates"][0]
    # Results of older versions have no list of pairs.
    pairs = [each for each in test.get("pairs", [test]) if first in each["separates"]]
    found = Separated(first, [], [])
    for each in pairs:
        (other,) = set(each["separates"]) - {first}
        (found.others if each["distance"] >= enough else found.left).append(other)
    return found


def next_test(test: Mapping[str, Any]) -> str:
    """The recommended test: a test at 20 Hz and 0.1 mm, a release from 2 mm, a sine-sweep, a loop."""
    if test.get("motion") == "release":
        return f"a release from {_start(test)}"
    if test.get("motion") == "sweep":
        return f"a sine-sweep from {_band(test)} with {_amplitude(test)}"
    name = "the force under a sine of" if test.get("kind") == "loop" else "a test at"
    return f"{name} {size(test, 'frequency_hz')} and {_amplitude(test)}"


def instruction(test: Mapping[str, Any]) -> str:
    """What to do for the recommended test, as an order."""
    if test.get("motion") == "release":
        seconds = size(test, "duration_s", 2)
        return f"Release the mass at rest from {_start(test)} and record its motion for {seconds}"
    seconds = size(test, "duration_s", 2)
    if test.get("motion") == "sweep":
        return f"Sweep a sine of {_amplitude(test)} from {_band(test)} in {seconds}; record input and motion"
    sine = f"a sine of {size(test, 'frequency_hz')} and {_amplitude(test)}"
    return f"Impose {sine} for {seconds}; record displacement and force"


def columns(named: Mapping[str, str], document: Mapping[str, Any]) -> dict[str, str]:
    """Headings and keys of a table, in the units of the diagnosis."""
    if not turns(document):
        return dict(named)
    turned = {key: rotation.turned_key(key)[0] for key in named.values()}
    return {
        f"{name.partition('[')[0]}[{split_key(turned[key])[1]}]" if turned[key] != key else name: turned[key]
        for name, key in named.items()
    }


def _start(test: Mapping[str, Any]) -> str:
    return size(test, "start_rad" if "start_rad" in test else "start_mm")


def size(test: Mapping[str, Any], key: str, digits: int = 3) -> str:
    """A number of a table with its unit, which ends its key."""
    return f"{short(test[key], digits)}{NO_BREAK}{split_key(key)[1]}"


def _amplitude(test: Mapping[str, Any]) -> str:
    return size(test, f"amplitude_{amplitude_unit(test)}")


def _band(test: Mapping[str, Any]) -> str:
    return f"{short(test['frequency_hz'], 3)} to {size(test, 'to_hz')}"


def amplitude_unit(test: Mapping[str, Any]) -> str:
    """Ending of the key of a test's input amplitude: mm, N of a force, rad and N_m of a rotation."""
    return next(unit for unit in ("N", "N_m", "rad", "mm") if f"amplitude_{unit}" in test)
