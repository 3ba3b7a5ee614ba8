"""Draws what a data set hides, as strong as is needed for the excess chi-squared that is wanted."""

from validation.benches import draw_bench
from validation.draft import Draft
from validation.hiding import HIDE
from validation.sets import DataSet

# Attempts with other laws, tests and numbers.
ATTEMPTS = 60


def draw(one: DataSet) -> Draft:
    """Draw what a set is made from; the same set gives the same draft.

    Raises
    ------
    RuntimeError
        If no system reaches the excess wanted.
    """
    for attempt in range(ATTEMPTS):
        random = one.random(attempt)
        draft = draw_bench(one, random, attempt)
        if draft and HIDE[one.kind](one, draft, random, attempt):
            return draft
    message = f"{one.name}: no system of this kind reaches the excess wanted in {ATTEMPTS} attempts"
    raise RuntimeError(message)
