"""Where blocks of a sweep run. All engines give futures of concurrent.futures."""

from __future__ import annotations

import functools
import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from typing import Any, Protocol


class Engine(Protocol):
    """Runs calls on workers."""

    workers: int

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]: ...

    def renew(self) -> bool:
        """Starts workers anew after one has died; False if that is not possible."""

    def close(self) -> None:
        """Gives up what has not begun, and ends the workers that the engine has started."""


class _Serial:
    workers = 1

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        pass


class _Processes:
    """Processes of this machine. They are spawned: threads of TBB and CUDA's contexts do not survive a fork."""

    def __init__(self, workers: int | None) -> None:
        self.workers = workers or os.cpu_count() or 1
        self._start()

    def _start(self) -> None:
        self._pool = ProcessPoolExecutor(self.workers, mp_context=multiprocessing.get_context("spawn"))

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        return self._pool.submit(function, *arguments)

    def renew(self) -> bool:
        self._pool.shutdown()
        self._start()
        return True

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


class _Executor:
    """An executor of the user's, whose workers are the user's matter, or one that is closed in the end."""

    def __init__(self, executor: Executor, workers: int, close: Callable[[], object] | None = None) -> None:
        self.workers = workers
        self._executor = executor
        self._close = close
        self._pending: set[Future[Any]] = set()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        future = self._executor.submit(function, *arguments)
        self._pending.add(future)
        future.add_done_callback(self._pending.discard)
        return future

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        for future in list(self._pending):
            future.cancel()
        if self._close is not None:
            self._close()


class _Ray:
    """The cluster that ray.init() has connected to, or one on this machine. Ray does lost blocks again itself."""

    def __init__(self, workers: int | None, tries: int) -> None:
        import ray

        self._ray = ray
        self._ours = not ray.is_initialized()
        if self._ours:
            ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
        self.workers = workers or int(ray.cluster_resources().get("CPU", 1))
        self._remote = functools.lru_cache(ray.remote(max_retries=tries - 1))
        self._pending: dict[Future[Any], Any] = {}

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        reference = self._remote(function).remote(*arguments)
        future: Future[Any] = reference.future()
        self._pending[future] = reference
        future.add_done_callback(lambda done: self._pending.pop(done, None))
        return future

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        for reference in list(self._pending.values()):
            self._ray.cancel(reference)
        if self._ours:
            self._ray.shutdown()


class _Dask:
    """A cluster of the user's, or one that is closed in the end. Dask does lost blocks again itself. Its own executor
    takes a result whose worker dies just then for an error."""

    def __init__(self, client: Any, workers: int | None, close: Callable[[], object] | None = None) -> None:
        self.workers = workers or sum(client.nthreads().values()) or 1
        self._client = client
        self._close = close
        self._pending: dict[Future[Any], Any] = {}

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        task = self._client.submit(function, *arguments, pure=False)
        future: Future[Any] = Future()
        self._pending[future] = task
        task.add_done_callback(functools.partial(self._settle, future))
        return future

    def _settle(self, future: Future[Any], task: Any) -> None:
        self._pending.pop(future, None)
        try:
            result = task.result()  # if it is lost by now, of another worker
        except BaseException as error:
            future.set_exception(error)
        else:
            future.set_result(result)

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        for task in list(self._pending.values()):
            task.cancel()
        if self._close is not None:
            self._close()


def _local_dask(workers: int | None) -> _Dask:
    from distributed import Client, LocalCluster

    cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")  # any free port
    client = Client(cluster)

    def close() -> None:
        client.close()
        cluster.close()

    return _Dask(client, None, close)


def _mpi(workers: int | None) -> _Executor:
    from mpi4py.futures import MPIPoolExecutor

    executor = MPIPoolExecutor(workers)
    executor.bootup()
    return _Executor(executor, workers or executor.num_workers, executor.shutdown)


def make_engine(engine: Any, workers: int | None, tries: int) -> Engine:
    """Makes the engine of a name, or of an executor or client of the user's."""
    if isinstance(engine, str):
        makers: dict[str, Callable[[], Engine]] = {
            "processes": lambda: _Processes(workers),
            "serial": _Serial,
            "ray": lambda: _Ray(workers, tries),
            "dask": lambda: _local_dask(workers),
            "mpi": lambda: _mpi(workers),
        }
        if engine not in makers:
            raise ValueError(f"engine is {engine!r}; it must be one of {', '.join(map(repr, makers))}, or an executor")
        return makers[engine]()
    if hasattr(engine, "get_executor"):
        return _Dask(engine, workers)
    if hasattr(engine, "submit"):
        return _Executor(engine, workers or getattr(engine, "_max_workers", None) or os.cpu_count() or 1)
    raise TypeError(
        f"engine is of the type {type(engine).__name__}; it must be a name, an executor or a client of Dask"
    )
