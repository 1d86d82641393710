"""Poses and results on a CUDA device, without a copy. Without a device these tests are skipped:

pytest tests/python/test_device.py        (INNERSPHERE_REQUIRE_GPU=1 makes a missing device a failure)
"""

import ctypes
import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from conftest import random_quaternions

import innersphere
from innersphere import Query

if not os.environ.get("INNERSPHERE_REQUIRE_GPU") and not innersphere.cuda_available():
    pytest.skip("needs a CUDA device", allow_module_level=True)

CUDA, FLOAT = 2, 2  # of DLPack


class _Tensor(ctypes.Structure):  # DLManagedTensor
    _fields_ = [
        ("data", ctypes.c_void_p),
        ("device_type", ctypes.c_int32),
        ("device_id", ctypes.c_int32),
        ("ndim", ctypes.c_int32),
        ("code", ctypes.c_uint8),
        ("bits", ctypes.c_uint8),
        ("lanes", ctypes.c_uint16),
        ("shape", ctypes.POINTER(ctypes.c_int64)),
        ("strides", ctypes.POINTER(ctypes.c_int64)),
        ("byte_offset", ctypes.c_uint64),
        ("manager", ctypes.c_void_p),
        ("deleter", ctypes.c_void_p),
    ]


def _runtime():
    for name in ("libcudart.so", "libcudart.so.12", "libcudart.so.13", "/usr/local/cuda/lib64/libcudart.so"):
        try:
            return ctypes.CDLL(name)
        except OSError:
            pass
    pytest.skip("needs the CUDA runtime library")


class DeviceArray:
    """An array on device 0 that hands itself out by DLPack only. It cannot come to the host by itself."""

    def __init__(self, array):
        self._host = np.ascontiguousarray(array)
        self._cuda = _runtime()
        self._pointer = ctypes.c_void_p()
        assert self._cuda.cudaMalloc(ctypes.byref(self._pointer), ctypes.c_size_t(max(self._host.nbytes, 1))) == 0
        self._copy(self._pointer, self._host.ctypes.data_as(ctypes.c_void_p), 1)
        self.streams, self._kept = [], []

    def __del__(self):
        self._cuda.cudaFree(self._pointer)

    def _copy(self, to, source, kind):
        assert self._cuda.cudaMemcpy(to, source, ctypes.c_size_t(self._host.nbytes), kind) == 0

    def numbers(self):
        back = np.empty_like(self._host)
        self._copy(back.ctypes.data_as(ctypes.c_void_p), self._pointer, 2)
        return back

    def __dlpack_device__(self):
        return CUDA, 0

    def __dlpack__(self, stream=None, **_):
        self.streams.append(stream)
        count, bits = self._host.ndim, 8 * self._host.itemsize
        shape = (ctypes.c_int64 * count)(*self._host.shape)
        tensor = _Tensor(self._pointer, CUDA, 0, count, FLOAT, bits, 1, shape, None, 0, None, None)
        self._kept.append((tensor, shape))  # who asked before may still read them
        new = ctypes.pythonapi.PyCapsule_New
        new.restype, new.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
        return new(ctypes.addressof(tensor), b"dltensor", None)


@pytest.fixture(scope="module")
def poses():
    rng = np.random.default_rng(8)
    return rng.uniform(-1.5, 1.5, (3000, 3)), random_quaternions(rng, 3000)


@pytest.mark.parametrize("backend", ["auto", "cuda"])
def test_nothing_comes_to_the_host(box, poses, backend):
    expected = Query("cpu").overlap(box, box, pose_b=poses)
    query = Query(backend)
    on_device = tuple(DeviceArray(part) for part in poses)
    out = DeviceArray(np.zeros((3000, 16)))
    assert query.overlap(box, box, pose_b=on_device, out=out) is out
    assert query.last_backend == "cuda" and out.numbers().tobytes() == expected.tobytes()
    # What fills an array may still run: innersphere waits for the default stream.
    assert 1 in on_device[0].streams and 1 in out.streams
    assert query.overlap(box, box, pose_b=on_device).tobytes() == expected.tobytes()
    out = DeviceArray(np.zeros((3000, 16)))
    query.overlap(box, box, pose_b=poses, out=out)
    assert out.numbers().tobytes() == expected.tobytes()


def test_refusals(box, poses):
    out = DeviceArray(np.zeros((3000, 16)))
    with pytest.raises(innersphere.InvalidArgumentError, match="CPU was asked for"):
        Query("cpu").overlap(box, box, pose_b=poses, out=out)
    with pytest.raises(innersphere.InvalidArgumentError, match="single pose"):
        Query().overlap(box, box, pose_a=poses, pose_b=poses, out=out)
    for wrong, error in ((np.zeros((3000, 15)), ValueError), (np.zeros((3000, 16), np.float32), TypeError)):
        with pytest.raises(error, match="out must"):
            Query().overlap(box, box, pose_b=poses, out=DeviceArray(wrong))
    bad = poses[0].copy()
    bad[17, 1] = np.nan
    with pytest.raises(innersphere.NotFiniteError, match="^query 17: "):
        Query().overlap(box, box, pose_b=(DeviceArray(bad), DeviceArray(poses[1])), out=out)


def test_a_fork_is_an_error_that_says_what_to_do():
    script = """
        import os, innersphere
        packing = innersphere.pack(innersphere.solid("nut"), spheres=100, overlap_errors=False)
        query = innersphere.Query("cuda")
        before = query.overlap(packing, packing)["volume"]
        child = os.fork()
        if child == 0:
            try:
                query.overlap(packing, packing)
                os._exit(1)
            except innersphere.DeviceError as error:
                assert "spawn" in str(error)
                on_host = innersphere.Query("cpu").overlap(packing, packing)["volume"]
                os._exit(0 if on_host == before else 2)
        assert os.waitpid(child, 0)[1] == 0
        assert query.overlap(packing, packing)["volume"] == before
    """
    subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=True, timeout=120)


@pytest.mark.parametrize("library", ["torch", "cupy"])
def test_libraries(box, poses, library):
    module = pytest.importorskip(library)
    if library == "torch":
        given, out = [module.tensor(part, device="cuda") for part in poses], module.zeros((3000, 16)).double().cuda()
        single, back = given[0].float(), lambda x: x.cpu().numpy()
    else:
        given, out = [module.asarray(part) for part in poses], module.zeros((3000, 16))
        single, back = given[0].astype("float32"), lambda x: x.get()
    expected = Query("cpu").overlap(box, box, pose_b=poses)
    Query().overlap(box, box, pose_b=tuple(given), out=out)
    assert back(out).tobytes() == expected.tobytes()
    rounded = poses[0].astype(np.float32), poses[1]
    got = Query().overlap(box, box, pose_b=(single, given[1]))  # of another type: copied to the host
    assert got.tobytes() == Query("cpu").overlap(box, box, pose_b=rounded).tobytes()
