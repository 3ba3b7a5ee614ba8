"""The answer of a diagnosis in one sentence, with its numbers and intervals."""

from collections.abc import Mapping, Sequence
from typing import Any

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.effects import alike
from wedgesweep.report import words


def sentence(found: Diagnosed) -> str:
    """Plain text; a template per verdict."""
    return TEMPLATES[found.verdict](found)


def _nothing(found: Diagnosed) -> str:
    misfit = found.document["misfit"]
    tests = words.counted(found.data.sizes["test"], "test")
    return (
        f"Nothing is missing: over {tests} the simulation is off by {_error(found, 'base')}, which is what "
        f"noise alone leaves ({words.p_value(misfit['p_base'])})."
    )


def _named(found: Diagnosed) -> str:
    count = len(found.document["causes"])
    explain = (
        "One cause explains" if count == 1 else f"{COUNTS.get(count, str(count))} causes together explain"
    )
    return f"{explain} the misfit: {_causes(found)}; {_improvement(found)}."


def _consistent(found: Diagnosed) -> str:
    return (
        f"The tests are consistent with {_causes(found)}, but the evidence is weak ({_weakness(found)}); "
        f"{_improvement(found)}."
    )


def _weakness(found: Diagnosed) -> str:
    if rivals := found.document["rivals"]:
        others = words.listing([words.together(each["effects"]) for each in rivals])
        return f"{others} would leave no more than noise, too{_would_tell(found, 'them')}"
    if _unconfirmed(found):
        return "tests left out of the fit do not confirm it"
    misfit, method = found.document["misfit"], found.document["method"]
    # Without a number: none is strong enough, and the base model has no steady response at all.
    strong, excess = method["strong_excess"], misfit["excess_base"]
    if excess is not None and (strong is None or excess < strong):
        return f"excess misfit {digits.number(excess)} over noise"
    if _varies(misfit):
        number, constant = misfit["least_constant"], words.p_value(misfit["p_constant"])
        return f"{number} would have to differ from test to test, {constant} for the same in all"
    p = min(misfit["p_extended"], misfit["p_where_it_shows"])
    return f"it leaves more than noise in the tests that show it, {words.p_value(p)}"


def _varies(misfit: Mapping[str, Any]) -> bool:
    """Whether what speaks against a fit most is that a number would not be the same in all tests."""
    constant = misfit["p_constant"]
    return constant is not None and constant < min(misfit["p_extended"], misfit["p_where_it_shows"])


def _tied(found: Diagnosed) -> str:
    rivals = [_rival(rival) for rival in found.document["rivals"]]
    count = 1 + len(rivals)
    return (
        f"{COUNTS.get(count, str(count))} explanations fit the tests equally well: {_causes(found)}, or "
        f"{words.listing(rivals, 'or')}; {_improvement(found)}{_would_tell(found, 'them')}."
    )


def _rival(rival: Mapping[str, Any]) -> str:
    meanings = words.listing([words.meaning(effect) for effect in rival["effects"]])
    return f"{meanings} ({words.together(rival['effects'])}, behind by {digits.number(rival['gap'], 2)})"


def _insufficient(found: Diagnosed) -> str:
    tests = words.counted(found.data.sizes["test"], "test")
    return (
        f"Something is wrong, the simulation is off by {_error(found, 'base')}, but these {tests} cannot "
        f"show what{_many(found)}{_would_tell(found)}."
    )


def _many(found: Diagnosed) -> str:
    match found.document["rivals"]:
        case []:
            return ""
        case [only]:
            doubt = _doubt(found, only)
            return f": {words.together(only['effects'])} would leave no more than noise, but {doubt}"
        case many:
            return f": {len(many)} explanations will do"


def _doubt(found: Diagnosed, only: Mapping[str, Any]) -> str:
    if alike(only["effects"]):
        return "a number of the model that is no candidate could look like these two"
    if half := _half_that_does(found, only["effects"]):
        return f"{half} alone leaves hardly more, with numbers that differ from test to test"
    who = "tests left out of the fit do not" if _unconfirmed(found) else "so few tests cannot"
    return f"{who} confirm it"


def _half_that_does(found: Diagnosed, pair: Sequence[str]) -> str | None:
    """Effect of a pair that leaves noise only without the other, None if there is none."""
    adequate = found.document["method"]["adequate_p"]
    halves = [
        each for each in found.document["candidates"] if each["effects"] and set(each["effects"]) < set(pair)
    ]
    return next((each["effects"][0] for each in halves if (each["p"] or 0.0) >= adequate), None)


def _none(found: Diagnosed) -> str:
    return (
        f"Something is wrong, the simulation is off by {_error(found, 'base')}, and {_unexplained(found)}"
        f"{_attempt(found)}."
    )


def _unconfirmed(found: Diagnosed) -> bool:
    """Whether the cause may make held-out tests worse."""
    gain = found.gain
    return gain is not None and (gain["ci95"] or [gain["excess_removed"]])[0] < 0.0


def _unexplained(found: Diagnosed) -> str:
    document = found.document
    singles = {each["effects"][0] for each in document["candidates"] if len(each["effects"]) == 1}
    match len(singles.union(document["detectable"], document["not_testable"])):
        case 0:
            return "there is no candidate that would show in these tests"
        case 1:
            return "the one candidate does not explain it"
        case many:
            return f"none of the {many} candidates, alone or in pairs, explains it"


def _attempt(found: Diagnosed) -> str:
    if not found.added:
        return ""
    misfit, left = found.document["misfit"], _error(found, "extended")
    against = [f"is still off by {left}"]
    if _varies(misfit):
        against.append(
            f"takes a {misfit['least_constant']} that differs from test to test "
            f"({words.p_value(misfit['p_constant'])} for the same in all)"
        )
    elif misfit["p_where_it_shows"] < misfit["p_extended"]:
        against[0] += f" ({words.p_value(misfit['p_where_it_shows'])} in the tests that show it)"
    if _unconfirmed(found):
        against.append("may make tests worse that it was not fitted to")
    return f"; the best attempt, {words.together(found.added)}, {words.listing(against)}"


TEMPLATES = {
    "nothing-missing": _nothing,
    "named": _named,
    "consistent-with": _consistent,
    "tied": _tied,
    "data-insufficient": _insufficient,
    "none-of-mine": _none,
}
COUNTS = {2: "Two", 3: "Three", 4: "Four"}


def _causes(found: Diagnosed) -> str:
    return words.listing([_cause(cause) for cause in found.document["causes"]])


def _cause(cause: Mapping[str, Any]) -> str:
    numbers = [words.estimate(key, value) for key, value in cause["parameters"].items()]
    return f"{words.meaning(cause['effect'])} ({'; '.join([cause['effect'], *numbers])})"


def _error(found: Diagnosed, model: str) -> str:
    misfit = found.document["misfit"]
    dof = misfit.get(f"dof_{model}", misfit["dof"])
    return words.times_noise(misfit[f"chi2_{model}"], dof)


def _improvement(found: Diagnosed) -> str:
    """Before and after, on all tests and on held-out ones."""
    before, after = _error(found, "base"), _error(found, "extended")
    it = "the first" if found.verdict == "tied" else "it" if len(found.added) == 1 else "them"
    return (
        f"with {it} the error falls from {before.removesuffix(' times the noise')} to {after}{_gain(found)}"
    )


def _gain(found: Diagnosed) -> str:
    gain = found.gain
    if gain is None:
        return ", not tried on held-out tests"
    interval = (
        f" ({words.INTERVAL} {digits.percent(gain['ci95'][0])} to {digits.percent(gain['ci95'][1])})"
        if gain["ci95"]
        else " (too few tests for an interval)"
    )
    return f", and on held-out tests {digits.percent(gain['excess_removed'])}{interval} of the excess is gone"


def _would_tell(found: Diagnosed, what: str = "") -> str:
    following = found.document["next_test"]
    if following is None:
        return ""
    if not words.tells(found.document):
        return f"; no test would tell for sure, {words.following(following)} still is the best one to make"
    if what:
        return f"; a test at {words.following(following)} would tell {what} apart"
    return (
        f"; next test {words.following(following)}, which would tell {' from '.join(following['separates'])}"
    )
