"""Steps of a diagnosis, as its progress is reported."""


class Step(str):
    """A step in words that also holds the stage, and how many of its parts are done."""

    __slots__ = ("done", "stage", "total")

    stage: str
    done: int
    total: int

    def __new__(cls, stage: str, done: int, total: int) -> "Step":
        step = super().__new__(cls, f"{stage}: {done} of {total}")
        step.stage, step.done, step.total = stage, done, total
        return step
