"""Steps of a diagnosis, as those see them who are told of its progress."""


class Step(str):
    """A step in words, which also says how many of how many parts of a stage are finished."""

    __slots__ = ("done", "stage", "total")

    stage: str
    done: int
    total: int

    def __new__(cls, stage: str, done: int, total: int) -> "Step":
        step = super().__new__(cls, f"{stage}: {done} of {total}")
        step.stage, step.done, step.total = stage, done, total
        return step
