"""The backend of a Dask cluster, imported only when requested."""

import importlib.util
import logging
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager, suppress
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wedgesweep import plugins
from wedgesweep.errors import SweepError
from wedgesweep.sweep.backend import SENT_AHEAD, Pool, Solve
from wedgesweep.sweep.fingerprint import differences

if TYPE_CHECKING:
    from distributed import Client, Future

# Time (s) that a scheduler has to answer, and then to have a worker.
TIMEOUT = 10.0


@contextmanager
def dask(
    n_jobs: int, fingerprint: Callable[[], dict[str, str]], scheduler: str | None = None
) -> Iterator[Pool]:
    """Workers of a running cluster, or of a local one with ``n_jobs`` processes that ends with this run.

    Raises SweepError if there is no cluster, or if its workers run another version.
    """
    if importlib.util.find_spec("distributed") is None:
        raise SweepError("the dask backend needs Dask: pip install 'wedgesweep[dask]'")
    from distributed import KilledWorker

    with ExitStack() as opened:
        client = _connected(opened, scheduler) if scheduler else _local(opened, n_jobs)
        client.register_plugin(_plugins())
        _require_same(client, fingerprint)
        try:
            cores = sum(client.ncores().values())
            yield Pool(_solve(client, SENT_AHEAD * cores), cores, (KilledWorker,))
        except CancelledError as error:
            raise SweepError(
                f"the Dask cluster gave up: {error}; rerun the same command to resume"
            ) from error


def _local(opened: ExitStack, n_jobs: int) -> "Client":
    from distributed import Client, LocalCluster

    # Workers that die are told by the sweep; what Dask logs when a run is stopped early reads like faults.
    options = {"threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": logging.CRITICAL}
    cluster = LocalCluster(n_workers=n_jobs, processes=True, **options)

    def leave(*error: Any) -> None:
        # Dask asserts that no worker is just starting; such a worker ends with this process.
        with suppress(AssertionError):
            cluster.__exit__(*error)

    opened.push(leave)
    return opened.enter_context(Client(cluster, set_as_default=False))


def _connected(opened: ExitStack, scheduler: str) -> "Client":
    from distributed import Client

    class Connected(Client):
        """A client that is closed at once if nothing answers.

        If the garbage collector closed it during the start of another client, it would wait forever for the
        lock of that start.
        """

        def start(self, **options: Any) -> None:
            try:
                super().start(**options)
            except BaseException:
                self.close()
                raise

    try:
        client = opened.enter_context(Connected(scheduler, timeout=TIMEOUT, set_as_default=False))
        client.wait_for_workers(1, timeout=TIMEOUT)
    except (
        OSError,
        ValueError,
        AssertionError,
    ) as error:  # TimeoutError is an OSError; an address is asserted
        reason = str(error) or f"no answer within {TIMEOUT:g} s"
        raise SweepError(f"{scheduler}: no Dask scheduler with a worker ({reason})") from error
    return client


def _plugins() -> Any:
    """What lets workers, also those that start later, load the plug-ins of this process."""
    from distributed import WorkerPlugin

    class Plugins(WorkerPlugin):
        def __init__(self, files: tuple[Path, ...]) -> None:
            self.files = files

        def setup(self, worker: Any) -> None:
            plugins.load_all(self.files)

    return Plugins(plugins.loaded())


def _require_same(client: "Client", fingerprint: Callable[[], dict[str, str]]) -> None:
    """Check that each worker has the same wedgesweep and libraries, so that results are the same bits."""
    here = fingerprint()
    for worker, there in client.run(fingerprint, on_error="return").items():
        if isinstance(there, BaseException):
            raise SweepError(f"Dask worker {worker} cannot run wedgesweep: {there}") from there
        if differing := differences(there, here):
            raise SweepError(f"Dask worker {worker} would compute other numbers ({'; '.join(differing)})")


def _solve(client: "Client", ahead: int) -> Solve:
    """Send tasks to the workers, ``ahead`` at a time; what is left of them is cancelled at the end."""
    from distributed import as_completed

    def solve(task: Callable[[Any], Any], items: Iterable[Any]) -> Generator[Any, None, None]:
        left = iter(items)

        def sent(count: int) -> list["Future"]:
            return [client.submit(task, item, pure=False) for item in islice(left, count)]

        running = as_completed(sent(ahead), loop=client.loop)
        try:
            for done in running:
                running.update(sent(1))
                yield done.result()
        finally:
            client.cancel(list(running.futures))

    return solve
