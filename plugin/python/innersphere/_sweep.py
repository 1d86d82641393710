"""One function over many rows, on many processes and machines."""

from __future__ import annotations

import atexit
import os
import threading
import uuid
from collections import Counter, deque
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from typing import Any, Literal

from ._engines import Engine, make_engine
from ._errors import CancelledError, InvalidArgumentError, SweepError
from ._progress import ProgressBar
from ._sinks import FileSink, MemorySink, ReducingSink

_opened: tuple[str, Any] = ("", None)
_opening = threading.Lock()


def sweep(
    function: Callable[..., Any],
    count: int,
    *,
    setup: Callable[[], Any] | None = None,
    block: int = 10_000,
    engine: Literal["processes", "serial", "ray", "dask", "mpi"] | Any = "processes",
    workers: int | None = None,
    out: str | os.PathLike[str] | None = None,
    reduce: Callable[[Any, Any], Any] | None = None,
    resume: bool = False,
    overwrite: bool = False,
    tries: int = 3,
    progress: bool | Callable[[str, float], object] = False,
) -> Any:
    """Computes `count` rows, a block at a time, on many workers. The result does not depend on which worker did what.

    function: gets the first row of a block and its number of rows, and returns that many rows: an array, or with
        `reduce` anything. With `setup` it gets what that returned before these. It must give the same rows for the same
        numbers, wherever it runs: read poses from a mapped file, or make them by random_poses(first=...).
    setup: opens what a worker needs, once in each: read(packing), Query("cpu", threads=1). Worker processes call both
        by their names, so they must be functions of a module or script, which then needs ``if __name__ ==
        "__main__":``. They travel with every block; so name files in them rather than holding packings.
    block: rows that are computed at once, at least 1. A worker should have some tenths of a second to do.
    engine: "processes" (of this machine), "serial" (here), "ray" (the cluster of ray.init(), or this machine), "dask"
        (this machine), "mpi" (``mpiexec -n 9 python -m mpi4py.futures script.py`` has 8 workers); or an executor of
        concurrent.futures, or a Client of dask.distributed. Each needs its own package.
    workers: None: as many as the engine has, or cores there are. Each runs one block at a time.

    out: a .npy file for the rows; None: they are returned in memory. It has the same bytes for any engine, any number of
        workers and any block. It appears when it is complete; until then it is ``out + ".part"``.
    reduce: makes one value of two, ``reduce(value, part)``, from the first to the last block. Needs no out.
    resume: whether a sweep that ended early leaves its rows, and one that finds such rows goes on with them. It is for
        you to see that both are of the same function.
    overwrite: whether an `out` that is there is replaced.
    tries: how many times a block may be on a worker that dies, at least 1. With "mpi" all ends with any worker: resume.
    progress: True shows a bar; a function gets "sweeping" and the fraction done, and ends the sweep if it returns False.

    Returns the rows (with out, mapped into memory), or the reduced value; None if count is 0 and there is a reduce.
    Raises SweepError, which names the rows, for what a function raises and for workers that keep dying;
    FileThereError, FormatError, WriteError, CancelledError, ValueError, TypeError, ImportError without the engine.
    """
    for name, value, least in (("count", count, 0), ("block", block, 1), ("tries", tries, 1)):
        if value < least:
            raise InvalidArgumentError(f"{name} is {value}; it must be at least {least}")
    if workers is not None and workers < 1:
        raise InvalidArgumentError(f"workers is {workers}; it must be at least 1")
    if out is not None and reduce is not None:
        raise ValueError("out keeps all rows, reduce makes one value of them: give one of the two")
    sink: Any
    if out is not None:
        sink = FileSink(os.fspath(out), count, block, resume, overwrite)
    else:
        sink = MemorySink(count) if reduce is None else ReducingSink(reduce)
    bar = ProgressBar() if progress is True else None
    report = bar or progress or (lambda stage, fraction: None)
    blocks = [(first, min(block, count - first)) for first in range(0, count, block)]
    try:
        todo = [one for one in blocks if not sink.is_done(one[0])]
        if todo:
            pool = make_engine(engine, workers, tries)
            try:
                _Run(pool, (uuid.uuid4().hex, setup, function), sink, tries, report, count).all(todo)
            finally:
                pool.close()
                _forget()
        return sink.finish()
    except BaseException:
        sink.abandon()
        raise
    finally:
        if bar is not None:
            bar.close()


class _Run:
    """Hands blocks to an engine, and what comes back to a sink."""

    blocks_per_worker = 4  # that are under way: enough to keep workers busy, few enough to bound memory

    def __init__(self, engine: Engine, work: tuple[Any, ...], sink: Any, tries: int, report: Any, count: int) -> None:
        self._engine, self._work, self._sink = engine, work, sink
        self._tries, self._report, self._count = tries, report, count
        self._running: dict[Future[Any], tuple[int, int]] = {}
        self._deaths: Counter[tuple[int, int]] = Counter()

    def all(self, blocks: list[tuple[int, int]]) -> None:
        waiting = deque(blocks)
        lost: list[tuple[int, int]] = []
        rows_left = sum(n for _, n in blocks)
        self._tell(rows_left)
        while waiting or self._running:
            if not lost:
                self._submit(waiting, lost)
            done = wait(self._running, return_when=FIRST_COMPLETED).done
            for future in sorted(done, key=self._running.__getitem__):
                one = self._running.pop(future)
                if self._take(future, one):
                    rows_left -= one[1]
                else:
                    lost.append(one)
            self._tell(rows_left)
            if lost and not self._running:  # a pool that is broken has ended all that it had
                self._renew(lost)
                waiting.extendleft(sorted(lost, reverse=True))
                lost = []

    def _tell(self, rows_left: int) -> None:
        if self._report("sweeping", 1 - rows_left / self._count) is False:
            raise CancelledError("the sweep was cancelled")

    def _submit(self, waiting: deque[tuple[int, int]], lost: list[tuple[int, int]]) -> None:
        most = self.blocks_per_worker * self._engine.workers
        while waiting and len(self._running) + self._sink.held < most:
            one = waiting.popleft()
            try:
                self._running[self._engine.submit(_work, *self._work, *one)] = one
            except BrokenExecutor:
                lost.append(one)
                return

    def _take(self, future: Future[Any], one: tuple[int, int]) -> bool:
        """Gives the rows of a block to the sink; returns False if its worker died."""
        try:
            part = future.result()
        except BrokenExecutor:
            return False
        except Exception as error:
            raise SweepError(f"rows {one[0]} to {sum(one) - 1}: {type(error).__name__}: {error}") from error
        self._sink.put(*one, part)
        return True

    def _renew(self, lost: list[tuple[int, int]]) -> None:
        self._deaths.update(lost)
        first, count = max(sorted(lost), key=self._deaths.__getitem__)  # the first of those that were there most often
        died = self._deaths[first, count]
        if died >= self._tries or not self._engine.renew():
            times = "" if died == 1 else f" {died} times"
            raise SweepError(f"a worker died{times} while rows {first} to {first + count - 1} were under way")


@atexit.register
def _forget() -> None:
    """Drops what setup() opened in this process."""
    global _opened
    _opened = ("", None)


def _work(token: str, setup: Callable[[], Any] | None, function: Callable[..., Any], first: int, count: int) -> Any:
    """Computes a block, in a worker."""
    if setup is None:
        return function(first, count)
    global _opened
    with _opening:
        if _opened[0] != token:
            _opened = (token, setup())
        state = _opened[1]
    return function(state, first, count)
