"""Time the event-driven solver against ODE libraries and both Radaus, at equal accuracy, on one core.

44 cases a law of 1.5 s from rest (workload.py). Each contender goes down a ladder of tolerances to the
loosest one that keeps the amplitude ratio of every case within the accuracy asked for: absolute where the
ratio is below 1, relative above. The reference is the event-driven solver at rtol 1e-10, checked by Radau
at 1e-9 on some cases. Where Coulomb is smoothed to tanh(v / 0.02 mm/s) it is that law's own limit, and
what smoothing changes is printed beside. Compile time is not in the figures.

Optional: pip install '.[bench]'; numbalsoda in it is compiled by gfortran and cmake.
"""

import os
from time import perf_counter, process_time
from typing import NamedTuple

import contenders
import libraries
import numpy as np
import workload

ACCURACIES = (1e-3, 1e-5)
LEAST_SECONDS = 0.3  # a short run is repeated for so long, and the fastest one counts
# Law and accuracy: goals as multiples of plain Radau and of the fastest library.
GOALS = {
    ("coulomb", 1e-5): (15_000, 50),
    ("static-dynamic", 1e-3): (1_500, 8),
    ("static-dynamic", 1e-5): (1_500, 5),
}
LIBRARY = "the fastest library"


class Timed(NamedTuple):
    """Error and speed of a contender at one tolerance."""

    rtol: float
    error: float
    rate: float  # cases per second


def errors(ratios, exact):
    """Absolute below a ratio of 1, relative above; a case that failed is infinitely wrong."""
    return np.nan_to_num(np.abs(ratios - exact) / np.maximum(exact, 1.0), nan=np.inf)


def measure(contender, records, rtol, exact):
    """Largest error and speed at a tolerance."""
    several, took, began = np.tile(records, contender.copies), np.inf, perf_counter()
    while perf_counter() - began < LEAST_SECONDS:
        # Processor time: on one core it is the wall time of an otherwise idle machine.
        started = process_time()
        ratios = contender.ratios(several, rtol)
        took = min(took, process_time() - started)
    return Timed(rtol, errors(ratios[: len(records)], exact).max(), len(several) / took)


def down_to_accuracy(contender, records, exact):
    """Tolerances down to the first that meets the finest accuracy."""
    found = []
    for rtol in contender.ladder:
        found.append(measure(contender, records, rtol, exact))
        if found[-1].error <= min(ACCURACIES):
            break
    return found


def compiled(law, records):
    """Call everything once; what that takes is printed, as it is not in the figures."""
    seconds = {}
    for name, contender in contenders.contenders(law).items():
        started = perf_counter()
        contender.ratios(records[:1], 1e-2)
        seconds[name] = perf_counter() - started
    slow = [f"{name} {took:.1f} s" for name, took in seconds.items() if took > 0.2]
    print(f"first calls, compile time included: {', '.join(slow) or 'each below 0.2 s'}")


def limits(law, records):
    """Exact ratios, and those of the law as the libraries see it; says how well they are known."""
    exact = contenders.to_records(records, 1e-10)
    few = contenders.FEWEST
    difference = errors(contenders.our_radau(records[few], 1e-9), exact[few])
    print(f"reference against Radau at 1e-9 on {difference.size} cases: {difference.max():.1e}")
    own = contenders.one_by_one(libraries.scipy_lsoda)(records, 1e-10)
    shift = errors(own, exact)
    what = "what smoothing changes" if law == "coulomb" else "reference against LSODA at 1e-10"
    print(f"{what}, {len(records)} cases: median {np.median(shift):.1e}, largest {shift.max():.1e}")
    return exact, own


def compare_few(records, loop, exact):
    """Say whether the few cases of the slow contenders cost what all of them do."""
    few = contenders.FEW
    share = measure(loop, records[few], 1e-6, exact[few]).rate / measure(loop, records, 1e-6, exact).rate
    print(f"event-driven loop on the few cases that Radau runs: {share:.2f} x its cases/s on all")


def number(value):
    """Three digits at least; a dash where there is none."""
    if np.isnan(value):
        return "-"
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def table(law, accuracy, results, cases):
    """Print who meets an accuracy and how fast; rates over that of plain Radau and of the fastest library."""
    chosen = {}
    for name, found in results.items():
        met = [one for one in found if one.error <= accuracy]
        chosen[name] = met[0] if met else min(found, key=lambda one: one.error)
    fits = {name: one.rate for name, one in chosen.items() if one.error <= accuracy}
    plain = fits.get(contenders.PLAIN, np.nan)
    rivals = [fits[name] for name in libraries.installed()[0] if name in fits]
    library = max(rivals, default=np.nan)
    print(f"\n{law}, accuracy {accuracy:.0e}")
    print(f"{'':26}cases  rtol    error  cases/s   x plain x library")
    for name, one in chosen.items():
        line = f"{name:26}{cases[name]:5} {one.rtol:.0e} {one.error:8.1e}"
        if name in fits:
            line += f" {number(one.rate):>8} {number(one.rate / plain):>9} {number(one.rate / library):>9}"
        else:
            line += " never this accurate"
        print(line)
    return {name: (rate / plain, rate / library) for name, rate in fits.items()}


def verdicts(law, accuracy, ratios):
    """Sentences on the goals of a law and an accuracy."""
    rivals = ("plain Radau", LIBRARY)
    for place, (what, goal) in enumerate(zip(rivals, GOALS[law, accuracy], strict=True)):
        reached = [ratios.get(name, (np.nan, np.nan))[place] for name in (contenders.LOOP, contenders.BATCH)]
        yield (
            f"{law}, {accuracy:.0e}: {number(reached[0])} x {what} (to records {number(reached[1])}),"
            f" goal {goal:,}: {judgement(what, reached[0] / goal)}"
        )


def judgement(rival, share):
    """Whether a goal is met; against the fastest library only if all libraries have taken part."""
    if np.isnan(share) or (rival == LIBRARY and libraries.installed()[1]):
        return "not judged"
    return "met" if share >= 1.0 else f"missed by a factor of {1.0 / share:.1f}"


def bench(law):
    """All tables of a law; the sentences on its goals."""
    print(f"\n== {law} ==")
    records, taking_part = np.concatenate(workload.records(law)), contenders.contenders(law)
    compiled(law, records)
    exact, own = limits(law, records)
    results, cases = {}, {}
    for name, contender in taking_part.items():
        some = contender.cases
        reference = (own if contender.smoothed else exact)[some]
        results[name] = down_to_accuracy(contender, records[some], reference)
        cases[name] = reference.size
    compare_few(records, taking_part[contenders.LOOP], exact)
    ratios = {accuracy: table(law, accuracy, results, cases) for accuracy in ACCURACIES}
    return [
        line
        for accuracy in ACCURACIES
        if (law, accuracy) in GOALS
        for line in verdicts(law, accuracy, ratios[accuracy])
    ]


def cost_of_effects(law):
    """Print what effects cost: time of the event-driven loop over that without, at both accuracies."""
    rates = {}
    for name, effects in ({"none": {}} | workload.EFFECTS).items():
        records = np.concatenate(workload.records(law, effects=effects))
        exact = contenders.loop_alone(records, 1e-10)
        loop = contenders.contenders(law)[contenders.LOOP]
        found = down_to_accuracy(loop, records, exact)
        rates[name] = [next((one.rate for one in found if one.error <= each), np.nan) for each in ACCURACIES]
    print(f"\n{law}, cases/s of the loop alone with an effect, and its cost")
    for name, reached in rates.items():
        costs = [number(base / rate) for base, rate in zip(rates["none"], reached, strict=True)]
        print(
            f"{name:20}"
            + "".join(f"{number(rate):>10} {cost:>6}" for rate, cost in zip(reached, costs, strict=True))
        )


def main():
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print(__doc__.split("\n\n")[1])
    absent = libraries.installed()[1]
    print(f"\nabsent: {', '.join(absent) or 'none'}")
    goals = [line for law in ("coulomb", "static-dynamic", "exponential") for line in bench(law)]
    for law in ("coulomb", "static-dynamic", "exponential"):
        cost_of_effects(law)
    print("\nGoals (loop alone):")
    print("\n".join(goals))


if __name__ == "__main__":
    main()
