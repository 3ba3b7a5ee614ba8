"""Chunks of cases on the workers of a backend; workers that die are replaced.

All tasks end when a worker dies, and nothing tells which one that worker had. Any task that was
sent out may be the reason, so these are solved alone, one after the other, and the rest in parallel again.
A case whose worker dies every time is a failed case.
"""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from wedgesweep.errors import SweepError
from wedgesweep.outcome import Outcome
from wedgesweep.sweep import variables
from wedgesweep.sweep.backend import SENT_AHEAD, Pool
from wedgesweep.sweep.cases import Chunk, solve_chunk

# Times that a case is tried alone, and number of losses after which a run ends if no case is to blame for
# them.
TRIES, MOST_LOSSES = 2, 10
TOLD = "a worker died, killed or out of memory; another one takes its place"
MESSAGE = f"its worker died in each of {TRIES} tries, killed or out of memory"

Records = Generator[np.ndarray, None, None]
RowNumbers = Sequence[int] | np.ndarray


@dataclass
class Workers:
    """Solves numbered rows of cases, where the cases of a row depend on each other.

    ``divide`` parts rows into chunks of rows, ``chunk`` makes a task of some rows, and ``task`` solves it;
    ``row_of`` tells the rows of some cases. ``tell`` gets a remark when a worker dies for the first time.
    """

    pool: Pool
    divide: Callable[[RowNumbers], Iterable[np.ndarray]]
    chunk: Callable[[np.ndarray], Chunk]
    row_of: Callable[[np.ndarray], np.ndarray]
    tell: Callable[[str], None]
    task: Callable[[Chunk], np.ndarray] = solve_chunk
    _losses: int = field(default=0, init=False)

    def solve(self, rows: RowNumbers) -> Records:
        """Records of all cases, by chunks, as they finish; raises SweepError if workers keep dying."""
        while len(rows):
            done = [np.zeros(0, int)]
            try:
                with closing(self._parallel(self.divide(rows))) as parts:
                    for records in parts:
                        done.append(self.row_of(records["index"]))
                        yield records
                return
            except self.pool.lost as error:
                self._count(error)
            sent = islice(_without(done, self.divide(rows)), SENT_AHEAD * self.pool.n_jobs)
            failed = False
            for part in list(sent):
                for records in self._alone(part):
                    failed |= bool((records["status"] == Outcome.WORKER_LOST).any())
                    done.append(self.row_of(records["index"]))
                    yield records
            self._losses -= failed
            rows = np.concatenate([np.zeros(0, int), *_without(done, [np.array(rows)])])

    def _count(self, error: BaseException) -> None:
        if not self._losses:
            self.tell(TOLD)
        self._losses += 1
        if self._losses > MOST_LOSSES:
            raise SweepError(
                "workers keep dying, killed or out of memory; rerun the same command to resume"
            ) from error

    def _alone(self, rows: np.ndarray) -> Records:
        """Records of a chunk that is solved while nothing else runs, halved until one case is to blame."""
        for _ in range(TRIES):
            try:
                with closing(self._parallel([rows])) as parts:
                    found = list(parts)
            except self.pool.lost:
                continue
            yield from found
            return
        if len(rows) > 1:
            for half in np.array_split(rows, 2):
                yield from self._alone(half)
            return
        task = self.chunk(rows)
        records = variables.blank(task.dtype, task.indices)
        records["status"], records["message"] = Outcome.WORKER_LOST, MESSAGE.encode()
        yield records

    def _parallel(self, parts: Iterable[np.ndarray]) -> Records:
        return self.pool.solve(self.task, map(self.chunk, parts))


def _without(done: list[np.ndarray], parts: Iterable[np.ndarray]) -> Iterator[np.ndarray]:
    """The parts without the rows that are done; parts of which nothing is left are omitted."""
    rows = np.concatenate(done)
    left = (part[~np.isin(part, rows)] for part in parts)
    return (part for part in left if len(part))
