"""What a second process costs a Radau sweep: CPU seconds in this process, in one worker and in two.

CPU seconds of a case grow if workers are in each other's way (caches, memory, threads of libraries, system
calls), or if the machine gives two processes less than twice as much: a loop that touches no memory shows how
much less. What a worker spends outside of cases is its start. Wall times of a busy machine say none of this.
Every third case of configs/quick.toml; writes docs/bench_workers.txt.
"""

import os
import resource
import time
from pathlib import Path
from typing import NamedTuple

import joblib
import numpy as np
from joblib.externals.loky import get_reusable_executor

import wedgesweep as ws
from wedgesweep.sweep.backend import SENT_AHEAD
from wedgesweep.sweep.cases import Chunk, compile_once, solve_chunk
from wedgesweep.sweep.run import Sweep

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "docs" / "bench_workers.txt"
STEP = 3


class Solved(NamedTuple):
    """A case: process that solved it, CPU seconds, those in the kernel, page faults, CPU of the process."""

    process: int
    case: int
    cpu: float
    system: float
    faults: int
    process_cpu: float


def solved(chunk):
    before, began = resource.getrusage(resource.RUSAGE_SELF), time.process_time()
    solve_chunk(chunk)
    cpu, after = time.process_time() - began, resource.getrusage(resource.RUSAGE_SELF)
    return Solved(
        os.getpid(),
        int(chunk.indices[0]),
        cpu,
        after.ru_stime - before.ru_stime,
        after.ru_minflt - before.ru_minflt,
        time.process_time(),
    )


def empty_loop(_):
    """CPU seconds of a loop that touches no memory."""
    began = time.process_time()
    for _ in range(LOOP):
        pass
    return time.process_time() - began


def chunks(sweep):
    for case in range(0, sweep.count, STEP):
        index = np.array([case])
        yield Chunk(sweep.config.records(index), index, sweep.settings, 60.0, sweep.dtype)


def line(name, cases, own, loops):
    """One line: what a case takes, what a worker takes before its first one, and what the loop takes."""
    warm = [case for case in cases if case.case in WARM]
    cpu, system, faults = (np.mean([getattr(case, name) for case in warm]) for name in Solved._fields[2:5])
    workers = {case.process for case in cases}
    start = max(
        min(case.process_cpu - case.cpu for case in cases if case.process == each) for each in workers
    )
    loop = np.mean(loops)
    return f"{name:>13} {cpu:13.3f} {system:14.4f} {faults:12.0f} {start:16.2f} {own:13.2f} {loop:11.3f}"


# Cases late enough that every worker has loaded its code before.
WARM = range(12, 1000)
LOOP, LOOPS = 20_000_000, 12


def main():
    sweep = Sweep(ws.load_config(ROOT / "configs" / "quick.toml"), Path("quick.nc"))
    compile_once(sweep.settings)
    lines = [
        "CPU s          a later case  in the kernel  page faults  before a first  this process  empty loop"
    ]
    began = time.process_time()
    cases, own = list(map(solved, chunks(sweep))), time.process_time() - began
    lines.append(line("in itself", cases, own, list(map(empty_loop, range(LOOPS)))))
    for count in (1, 2):
        began = time.process_time()
        # joblib would solve in this process for one job: a pool of two, with one task at a time.
        parallel = joblib.Parallel(2, pre_dispatch=1 if count == 1 else SENT_AHEAD * count, batch_size=1)
        cases = parallel(joblib.delayed(solved)(chunk) for chunk in chunks(sweep))
        own = time.process_time() - began
        loops = parallel(joblib.delayed(empty_loop)(i) for i in range(LOOPS))
        lines.append(line(f"{count} at a time", cases, own, loops))
        get_reusable_executor().shutdown()
    print("\n".join(lines))
    REPORT.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
