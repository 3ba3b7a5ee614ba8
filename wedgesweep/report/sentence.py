"""The answer of a diagnosis in one sentence, with its numbers and intervals."""

from collections.abc import Mapping
from typing import Any

from wedgesweep import formatting, rotation
from wedgesweep.config.model import NO_FRICTION
from wedgesweep.diagnosis_result import DiagnosisResult, Reason
from wedgesweep.effects import EFFECTS
from wedgesweep.effects.guide_friction import EFFECT as GUIDE_FRICTION
from wedgesweep.report import ladder, phrases

# Tests that a sentence names.
NAMES_LISTED = 3


def sentence(result: DiagnosisResult) -> str:
    """Return the sentence as plain text; each verdict has its template."""
    answer = TEMPLATES[result.verdict](result).removesuffix(".")
    repeats = f"; {parts}" if (parts := ladder.parts(result)) else ""
    not_done = _of_friction(result) + _never_steady(result) + _untried(result) + unfinished(result)
    whole = f"{answer}{repeats}{not_done}."
    return rotation.prose(whole) if phrases.turns(result.document) else whole


def unfinished(result: DiagnosisResult) -> str:
    """Steps of the diagnosis without a result, by the reason; empty for most diagnoses."""
    steps: dict[str, list[str]] = {}
    for each in result.document.get("unfinished", []):
        steps.setdefault(each["reason"], []).append(each["step"])
    for each in result.document.get("failed", []):
        steps.setdefault(each["reason"], []).append(f"fit of {each['effect']}")
    return "".join(f"; unfinished: {phrases.listing(names)} ({why})" for why, names in steps.items())


def _of_friction(result: DiagnosisResult) -> str:
    """Effects that were not tried as the model has no friction, where that is what leads; else empty."""
    leads = any(GUIDE_FRICTION.name in level["effects"] for level in ladder.noteworthy(result))
    excluded = result.document.get("excluded", {}).items()
    names = [name for name, why in excluded if why == NO_FRICTION and EFFECTS[name].family != "parameters"]
    if result.verdict == "named" or not (leads and names):
        return ""
    they = "it changes" if len(names) == 1 else "they change"
    why = f"as {they} friction, and the model has none: state it there to try them"
    return f"; {phrases.listing(names)} {'was' if len(names) == 1 else 'were'} not tried, {why}"


def _never_steady(result: DiagnosisResult) -> str:
    """Tests whose history the records do not tell, and what depends on it; empty for most diagnoses."""
    names = result.document.get("never_steady", [])
    if not names:
        return ""
    which = phrases.listing(names[:NAMES_LISTED]) + (", ..." if len(names) > NAMES_LISTED else "")
    them = "it is" if len(names) == 1 else "they are"
    where = f"{formatting.counted(len(names), 'test')} ({which})"
    return (
        f"; in {where} friction keeps ageing as the faces only creep: "
        f"{them} simulated as after 100 periods, and rate and time of ageing hold only if that is true"
    )


def _untried(result: DiagnosisResult) -> str:
    """What the search left out, the most promising first; empty for most diagnoses."""
    left_out = result.document.get("untried", [])
    if not left_out:
        return ""
    first = "{what} ({left_out} of {of})".format(**left_out[0])
    if len(left_out) > 1:
        first = f"{sum(each['left_out'] for each in left_out)} more fits, first of all {first}"
    over = "had no time left" if left_out[0].get("ended_by") == "time limit" else "had spent its budget"
    said = f"; the search {over} before it tried {first}{_never_tried(result)}"
    if result.reason is Reason.MORE_ACCURATE:
        said += "; the intervals hold if nothing of that is missing as well"
    return said


def _never_tried(result: DiagnosisResult) -> str:
    """The pairs of effects that were left out altogether."""
    never = result.document.get("never_tried", [])
    if not never:
        return ""
    singles = len({each["effects"][0] for each in result.document["candidates"] if len(each["effects"]) == 1})
    possible = singles * (singles - 1) // 2
    which = ", ".join(map(phrases.combination, never[:NAMES_LISTED])) + (
        ", ..." if len(never) > NAMES_LISTED else ""
    )
    return f"; {len(never)} of the {possible} possible pairs of effects were never tried ({which})"


def _nothing_missing(result: DiagnosisResult) -> str:
    tests = phrases.compared(result)
    p = phrases.p_value(result.document["misfit"]["p_base"])
    return (
        f"Nothing is missing: over {tests} the error of the simulation is {_error(result, 'base')}, which "
        f"{'these' if result.document['method'].get('model_error') else 'noise'} alone may leave ({p})."
    )


def _named(result: DiagnosisResult) -> str:
    count = len(result.document["causes"])
    explain = "One cause explains" if count == 1 else f"{_number(count)} causes together explain"
    return f"{explain} the misfit: {_causes(result)}; {_improvement(result)}."


def _consistent(result: DiagnosisResult) -> str:
    if result.reason is Reason.MORE_ACCURATE:
        return _most_accurate(result)
    if result.reason is Reason.AT_LIMIT:
        off = formatting.short(result.document["reason"]["standard_deviations"], 2)
        stated = f"{off} standard deviations from what is stated"
        without = "with it as stated the model does not fit"
        return f"The tests are consistent with {_causes(result)}, {stated}; {without}."
    weak = f"the evidence is weak ({why})" if (why := _reservation(result)) else "the evidence is weak"
    return f"The tests are consistent with {_causes(result)}, but {weak}; {_improvement(result)}."


def _most_accurate(result: DiagnosisResult) -> str:
    """The cause that does not reach the noise, but explains much more than anything else."""
    why = result.document.get("reason", {})
    size, base, held_out = (phrases.accuracy(why[key]) for key in ("accuracy", "base", "held_out"))
    rivals = f"next best: {phrases.accuracy(why['next_best'])}; held-out tests: {held_out}"
    explain = phrases.explain(result.document["causes"])
    tied = "".join(
        f", or {phrases.combination(each['effects'])} to {phrases.accuracy(each['accuracy'])}"
        for each in why.get("rivals", [])
    )
    found = (
        f"To {size} of the response {_causes(result)} {explain} all tests{tied} (without: {base}; {rivals})"
    )
    noise = "" if why.get("larger") else ", though no explanation reaches the noise"
    if why.get("parameter"):
        noise = f", though {why['parameter']} differs a little from test to test"
    return f"{found}{noise}: {_improvement(result)}{_larger(result)}."


def _larger(result: DiagnosisResult) -> str:
    """What else may be missing, where another effect beside the cause leaves much less."""
    causes = {each["effect"] for each in result.document["causes"]}
    others = [
        f"{phrases.combination([name for name in each['effects'] if name not in causes])} "
        f"({phrases.accuracy(each['accuracy'])})"
        for each in result.document["reason"].get("larger", [])
    ]
    if not others:
        return ""
    less = f"more is missing: another effect beside {'it' if len(causes) == 1 else 'them'} leaves much less"
    return f"; {less}, {phrases.listing(others, 'or')}, and the interval holds the value that each leads to"


def _reservation(result: DiagnosisResult) -> str:
    """What speaks against an explanation, by the reason of the verdict."""
    why, rivals = result.document.get("reason", {}), result.document["rivals"]
    match result.reason:
        case Reason.PAIR_LEAVES_LESS:
            pair, larger = phrases.combination(rivals[0]["effects"]), phrases.accuracy(why["model_error"])
            return f"by itself it explains the tests only under a model error of {larger}; {pair} leave less"
        case Reason.OTHERS_ADEQUATE:
            names = phrases.listing([phrases.combination(each["effects"]) for each in rivals])
            return f"{names} would also leave only noise{_next_test(result, 'them')}"
        case Reason.WEAK_EXCESS:
            return f"the misfit exceeds noise by only {formatting.number(why['excess'])}"
        case Reason.UNCHECKED:
            return "not all rivals and held-out tests were tried"
        case Reason.VARIES:
            constant = phrases.p_value(why["p"])
            return f"{why['parameter']} would have to differ from test to test, {constant} for one value"
        case Reason.LEAVES_MORE:
            return f"it leaves more than noise in the tests that show it, {phrases.p_value(why['p'])}"
        case Reason.UNCONFIRMED:
            return "held-out tests do not confirm it"
        case Reason.CONFOUNDED:
            return "an error in a model parameter that is no candidate could look like these two"
        case Reason.NEARLY_TOLERABLE:
            allowed = result.document["method"].get("model_error")
            return "a model error could have its shape" if allowed else "it hardly fits better"
        case Reason.COMPONENT_SUFFICES:
            half = phrases.combination(why["effects"])
            return f"{half} alone leaves hardly more, with parameters that differ from test to test"
        case Reason.FEW_TESTS:
            return "so few tests cannot confirm it"
        case _:
            return ""


def _tied(result: DiagnosisResult) -> str:
    if result.reason is Reason.MORE_ACCURATE:
        return _most_accurate(result)
    rivals = [_rival(rival, result.document) for rival in result.document["rivals"]]
    return (
        f"{_number(1 + len(rivals))} explanations fit the tests equally well: {_causes(result)}, or "
        f"{phrases.listing(rivals, 'or')}; {_improvement(result)}{_next_test(result, 'them')}."
    )


def _rival(rival: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    meanings = phrases.meanings(rival["effects"], document)
    behind = formatting.number(rival["gap"], 2)
    return f"{meanings} ({phrases.combination(rival['effects'])}, behind by {behind})"


def _insufficient(result: DiagnosisResult) -> str:
    tests = phrases.these_tests(result)
    match result.reason:
        case Reason.NO_SIGNAL:
            share = formatting.short(result.document["reason"]["power_over_noise"], 2)
            return f"{tests.capitalize()} hold hardly more than noise: {share} times its power."
        case Reason.UNCHECKED:
            return f"{_wrong(result)}, and not everything was tried that may explain it{_so_far(result)}."
        case Reason.UNSEARCHED:
            return (
                f"The error of the simulation is {_error(result, 'base')}, which noise alone may leave, but "
                "the diagnosis ended before all effects were tried, and one may explain it better."
            )
    return f"{_wrong(result)}, but {tests} cannot show what{_adequate(result)}{_next_test(result)}."


def _so_far(result: DiagnosisResult) -> str:
    """What the best explanations achieve, though nothing is certain."""
    known = ladder.clauses(result)
    return f"; so far, {'; '.join(known)}" if known else ""


def _wrong(result: DiagnosisResult) -> str:
    error = f"the error of the simulation is {_error(result, 'base')}"
    if far := result.document["misfit"].get("implausible"):
        needs = f"with {phrases.listing(far)} far from what is stated"
        return f"Something is wrong ({error}, but only {needs})"
    return f"Something is wrong ({error})"


def _adequate(result: DiagnosisResult) -> str:
    """Explanations that would do, and what speaks against naming one; else what the best ones achieve."""
    match result.document["rivals"]:
        case []:
            return _so_far(result)
        case [only]:
            but = f", but {doubt}" if (doubt := _reservation(result)) else ""
            return f": {phrases.combination(only['effects'])} would leave only noise{but}"
        case many:
            return f": {len(many)} explanations would each leave only noise"


def _none(result: DiagnosisResult) -> str:
    strict = f"{_wrong(result)}, and {_unexplained(result)}{_attempt(result)}"
    return "; ".join([strict, *ladder.clauses(result)]) + "."


def _unexplained(result: DiagnosisResult) -> str:
    document = result.document
    singles = {each["effects"][0] for each in document["candidates"] if len(each["effects"]) == 1}
    match len(singles.union(document["detectable"], document["not_testable"])):
        case 0:
            return "there is no candidate that these tests could show"
        case 1:
            return "the only candidate does not explain it"
        case many:
            return f"none of the {many} candidates explains it, {_combinations(document)}"


def _combinations(document: Mapping[str, Any]) -> str:
    """In what combinations the candidates were tried."""
    if not document.get("never_tried"):
        return "alone or in pairs"
    tried = any(len(each["effects"]) > 1 for each in document["candidates"])
    return "alone or in the pairs that were tried" if tried else "alone; no pair was tried"


def _attempt(result: DiagnosisResult) -> str:
    if not result.added:
        return ""
    against = f" ({doubt})" if (doubt := _reservation(result)) else ""
    left = f"still leaves an error of {_error(result, 'extended')}"
    return f"; the best attempt, {phrases.combination(result.added)}, {left}{against}"


TEMPLATES = {
    "nothing-missing": _nothing_missing,
    "named": _named,
    "consistent-with": _consistent,
    "tied": _tied,
    "data-insufficient": _insufficient,
    "none-of-mine": _none,
}


def _number(count: int) -> str:
    return {2: "Two", 3: "Three", 4: "Four"}.get(count, str(count))


def _causes(result: DiagnosisResult) -> str:
    return phrases.listing([_cause(cause, result.document) for cause in result.document["causes"]])


def _cause(cause: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    parameters = [phrases.estimate(key, value) for key, value in cause["parameters"].items()]
    return f"{phrases.meaning(cause['effect'], document)} ({'; '.join([cause['effect'], *parameters])})"


def _error(result: DiagnosisResult, model: str) -> str:
    error = f"{phrases.error_of(result, model)} times the noise"
    allowed = result.document["method"].get("model_error")
    return f"{error} and a model error of {phrases.accuracy(allowed)}" if allowed else error


def _improvement(result: DiagnosisResult) -> str:
    """Error before and after, on all tests and on held-out ones."""
    before, after = phrases.error_of(result, "base"), _error(result, "extended")
    it = "the first" if result.verdict == "tied" else "it" if len(result.added) == 1 else "they"
    verb = "reduces" if it != "they" else "reduce"
    return f"{it} {verb} the error from {before} to {after}{_gain(result)}"


def _gain(result: DiagnosisResult) -> str:
    gain = result.gain
    if gain is None:
        return " (not checked on held-out tests)"
    return f", and on held-out tests {phrases.excess_removed(gain, result.document, ' is gone')}"


def _next_test(result: DiagnosisResult, rivals: str = "") -> str:
    """The test that would distinguish the ``rivals``, by default those that the recommendation names."""
    test = result.document["next_test"]
    if test is None:
        return ""
    place, found = phrases.next_test(test), phrases.separated(result.document)
    if found is None:
        rivals = rivals or " from ".join(test["separates"])
        return f"; no test would reliably distinguish {rivals}, the best one is {place}"
    distinguished = rivals if rivals and not found.left else found.text
    return f"; {place} would distinguish {distinguished}"
