"""Where the results of a sweep go: an array in memory, a file that can be mapped into memory, or one value."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ._errors import FileThereError, FormatError, WriteError


class Rows:
    """Checks that all blocks have rows of one kind."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.dtype: np.dtype[Any] | None = None
        self.shape: tuple[int, ...] = ()

    def check(self, part: Any, first: int, count: int) -> NDArray[Any]:
        rows = np.asarray(part)
        what = f"the block of rows {first} to {first + count - 1}"
        if rows.dtype.hasobject:
            raise TypeError(f"{what} has the dtype {rows.dtype}; it must be of numbers")
        if rows.ndim == 0 or len(rows) != count:
            raise ValueError(f"{what} has the shape {rows.shape}; it must have {count} rows")
        if self.dtype is None:
            self.dtype, self.shape = rows.dtype, (self.count, *rows.shape[1:])
        if (rows.dtype, rows.shape[1:]) != (self.dtype, self.shape[1:]):
            raise ValueError(
                f"{what} has rows of {rows.dtype} {rows.shape[1:]}, others have {self.dtype} {self.shape[1:]}"
            )
        return rows


class MemorySink:
    """An array."""

    def __init__(self, count: int) -> None:
        self._rows = Rows(count)
        self._array: NDArray[Any] | None = None

    held = 0

    def is_done(self, first: int) -> bool:
        return False

    def put(self, first: int, count: int, part: Any) -> None:
        rows = self._rows.check(part, first, count)
        if self._array is None:
            self._array = np.empty(self._rows.shape, self._rows.dtype)
        self._array[first : first + count] = rows

    def finish(self) -> NDArray[Any]:
        return np.empty(0) if self._array is None else self._array

    def abandon(self) -> None:
        pass


class ReducingSink:
    """One value. Blocks are taken in their order, whichever is ready first: sums have the same bits."""

    def __init__(self, reduce: Callable[[Any, Any], Any]) -> None:
        self._reduce = reduce
        self._early: dict[int, tuple[int, Any]] = {}
        self._next = 0
        self._value: Any = None

    @property
    def held(self) -> int:
        """Number of blocks that wait for an earlier one."""
        return len(self._early)

    def is_done(self, first: int) -> bool:
        return False

    def put(self, first: int, count: int, part: Any) -> None:
        self._early[first] = count, part
        while self._next in self._early:
            first = self._next
            count, part = self._early.pop(first)
            self._value = part if first == 0 else self._reduce(self._value, part)
            self._next = first + count

    def finish(self) -> Any:
        return self._value

    def abandon(self) -> None:
        pass


class FileSink:
    """A .npy file. Until it is complete it is PATH.part, with PATH.part.done, which has a byte for each block."""

    held = 0

    def __init__(self, path: str, count: int, block: int, resume: bool, overwrite: bool) -> None:
        if not path.endswith(".npy"):
            raise ValueError(f"out is {path}; it must end in .npy")
        if os.path.exists(path) and not overwrite:
            raise FileThereError(f"{path} exists; give overwrite=True to replace it")
        self._path, self._part, self._done_path = path, path + ".part", path + ".part.done"
        self._block, self._resume = block, resume
        self._rows = Rows(count)
        self._title = b"%d rows in blocks of %d\n" % (count, block)
        self._done = bytearray(-(-count // block))
        self._files: list[IO[bytes]] = []
        self._start = 0
        if os.path.exists(self._part):
            if not resume:
                raise FileThereError(
                    f"{self._part} is that of a sweep that did not end; give resume=True to go on with it, or remove it"
                )
            self._reopen()

    def _reopen(self) -> None:
        if not os.path.exists(self._done_path) or os.path.getsize(self._done_path) == 0:
            os.remove(self._part)  # the sweep was ended before its first row
            return
        self._files = [open(self._part, "r+b"), open(self._done_path, "r+b")]
        title, done = self._files[1].readline(), self._files[1].read()
        if title != self._title or len(done) != len(self._done):
            self._close()
            raise FormatError(f"{self._part} has {title.decode(errors='replace').strip() or 'no title'}; the sweep has "
                              f"{self._title.decode().strip()}")  # fmt: skip
        self._done[:] = done
        np.lib.format.read_magic(self._files[0])
        shape, _, dtype = np.lib.format.read_array_header_1_0(self._files[0])
        self._rows.shape, self._rows.dtype = shape, dtype
        self._start = self._files[0].tell()

    def _create(self) -> None:
        dtype, shape = self._rows.dtype, self._rows.shape
        assert dtype is not None
        _remove(self._done_path)  # of a sweep that was ended just as it was complete
        table = open(self._part, "xb")
        self._files = [table]
        descr = np.lib.format.dtype_to_descr(dtype)
        np.lib.format.write_array_header_1_0(table, {"descr": descr, "fortran_order": False, "shape": shape})
        self._start = table.tell()
        table.flush()
        size = int(np.prod(shape)) * dtype.itemsize
        if size > 0:  # all of the disk that it needs, now: a full one shows at once
            os.posix_fallocate(table.fileno(), self._start, size)
        self._files.append(open(self._done_path, "wb"))
        self._files[1].write(self._title + bytes(self._done))
        self._files[1].flush()

    def _row_size(self) -> int:
        assert self._rows.dtype is not None
        return int(np.prod(self._rows.shape[1:])) * self._rows.dtype.itemsize

    def is_done(self, first: int) -> bool:
        return self._done[first // self._block] != 0

    def put(self, first: int, count: int, part: Any) -> None:
        rows = self._rows.check(part, first, count)
        try:
            if not self._files:
                self._create()
            table, done = self._files
            table.seek(self._start + first * self._row_size())
            table.write(np.ascontiguousarray(rows).tobytes())
            table.flush()
            self._done[first // self._block] = 1
            done.seek(len(self._title) + first // self._block)
            done.write(b"\1")
            done.flush()
        except OSError as error:
            raise WriteError(f"cannot write {self._part}: {error.strerror}") from error

    def finish(self) -> NDArray[Any]:
        try:
            if not self._files:  # without a row
                self._rows.check(np.empty(0), 0, 0)
                self._create()
            os.fsync(self._files[0].fileno())
            self._close()
            os.replace(self._part, self._path)
            os.remove(self._done_path)
        except OSError as error:
            raise WriteError(f"cannot write {self._path}: {error.strerror}") from error
        rows: NDArray[Any] = np.load(self._path, mmap_mode="r" if self._rows.count > 0 else None)
        return rows

    def abandon(self) -> None:
        """What is there stays only for one who goes on with it."""
        made, whole = bool(self._files), len(self._files) == 2
        self._close()
        if made and not (whole and self._resume):
            _remove(self._part)
            _remove(self._done_path)

    def _close(self) -> None:
        for file in self._files:
            file.close()
        self._files = []


def _remove(path: str) -> None:
    if os.path.exists(path):
        os.remove(path)
