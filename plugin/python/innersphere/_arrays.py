"""Arrays as users have them become arrays as the C++ library wants them."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

_CPU, _CUDA, _PINNED = 1, 2, 3  # devices of DLPack
_DEFAULT_STREAM = 1


def as_float64(values: Any, name: str, wanted: str = "") -> NDArray[np.float64]:
    """Makes an array of doubles, also of what lies on a device. Raises TypeError for anything but real numbers, and
    ValueError, with what is `wanted`, for rows of different lengths."""
    try:
        array = np.asarray(_on_host(values))
    except ValueError:
        raise ValueError(f"{name} has rows of different lengths{wanted}") from None
    if array.dtype.kind not in "fiu" and array.size > 0:
        raise TypeError(f"{name} has the dtype {array.dtype}; it must be of real numbers")
    return array.astype(np.float64, copy=False)


def _on_host(values: Any) -> Any:
    """Copies tensors of torch, cupy and others with DLPack from their device, without what is kept for gradients."""
    if hasattr(values, "detach"):
        values = values.detach()
    if not hasattr(values, "__dlpack_device__") or values.__dlpack_device__()[0] in (_CPU, _PINNED):
        return np.from_dlpack(values) if hasattr(values, "__dlpack__") and not hasattr(values, "__array__") else values
    for copy in ("cpu", "get"):  # of torch and jax, of cupy
        if hasattr(values, copy):
            return _on_host(getattr(values, copy)())
    return np.from_dlpack(values, device="cpu")  # numpy 2.1


def on_device(values: Any) -> Any:
    """Returns a capsule of DLPack of what is on a CUDA device, without a copy; None for all else.

    Its numbers are there when the device's default stream has done what it has to do."""
    if not hasattr(values, "__dlpack_device__") or values.__dlpack_device__()[0] != _CUDA:
        return None
    if hasattr(values, "detach"):
        values = values.detach()
    try:
        return values.__dlpack__(stream=_DEFAULT_STREAM)
    except BufferError:  # it is not handed out there: it is copied to the host
        return None


def as_count(value: Any, name: str) -> int:
    """Makes an int of a number of things, also of 1e3. Raises TypeError for anything but whole numbers."""
    if isinstance(value, (float, np.floating)) and value.is_integer():
        return int(value)
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; it must be a whole number") from None


def as_indices(values: Any, name: str) -> NDArray[np.int64]:
    """Makes an array of indices. Raises TypeError for anything but integers."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise TypeError(f"{name} has the dtype {array.dtype}; it must be of integers")
    if array.dtype == np.uint64 and array.size > 0 and array.max() > np.iinfo(np.int64).max:
        raise ValueError(f"{name} holds {array.max()}, which names no vertex")
    return np.ascontiguousarray(array, dtype=np.int64)
