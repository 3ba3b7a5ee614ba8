"""Single cases that no sweep holds: settled for longer, or with something changed."""

from dataclasses import replace
from math import nan

from wedgesweep import parameters, simulate
from wedgesweep.reproduce.runs import MM, Run
from wedgesweep.response import NUMBERS
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep.dataset import HARMONICS


def single(
    run: Run,
    law: str,
    beta: float,
    millimetres: float,
    settle_periods: int | None = None,
    rtol: float | None = None,
    suspension: dict[str, float] | None = None,
    friction: dict[str, float] | None = None,
) -> dict[str, float]:
    """Numbers of a case of the run's config with what is given changed (see response.NUMBERS, SI).

    All are NaN if the case fails, so that no criterion holds.
    """
    record = parameters.record(
        law=law,
        amplitude=millimetres / MM,
        omega=beta * run.omega_n,
        suspension=run.config.suspension | (suspension or {}),
        friction=run.config.friction | (friction or {}),
        effects=run.config.effects,
    )
    settings = run.config.solver
    if settle_periods is not None:
        settings = replace(settings, duration=None, settle_periods=settle_periods)
    if rtol is not None:
        settings = replace(settings, rtol=rtol)
    try:
        return simulate.respond(record, settings, HARMONICS)[0].numbers
    except CaseError:
        return dict.fromkeys(NUMBERS, nan)
