"""Overlaps of solids of any shape, by inner-sphere packings.

A packing fills a solid with spheres that do not overlap. Two packings tell in microseconds which volume their solids
share, and which force drives them apart. Lengths are in metres.

    import innersphere

    ring = innersphere.pack("ring.obj", spheres=1000)
    query = innersphere.Query()
    shared = query.overlap(ring, ring, pose_b=([0.1, 0, 0], [0, 0, 0, 1]))
    print(shared["volume"], shared["force"])
"""

from ._core import (
    Packing,
    Query,
    __version__,
    cuda_available,
    coverage_dtype,
    cuda_device_count,
    expected_error,
    expected_error_dtype,
    overlap_dtype,
    pair_dtype,
    solid,
    sphere_contact_dtype,
)
from ._distances import surface_of
from ._errors import (
    CancelledError,
    DeviceError,
    DeviceMemoryError,
    EmptyInputError,
    Error,
    FileMissingError,
    FileThereError,
    FormatError,
    InvalidArgumentError,
    MissingLibraryError,
    NoDeviceError,
    NoSphereFitsError,
    NotASolidError,
    NotFiniteError,
    SweepError,
    UnsupportedVersionError,
    WriteError,
)
from ._exact import exact_dtype, exact_overlap
from ._pack import pack, read
from ._poses import random_poses
from ._progress import ProgressBar
from ._sweep import sweep

__all__ = [
    "CancelledError",
    "DeviceError",
    "DeviceMemoryError",
    "EmptyInputError",
    "Error",
    "FileMissingError",
    "FileThereError",
    "FormatError",
    "InvalidArgumentError",
    "MissingLibraryError",
    "NoDeviceError",
    "NoSphereFitsError",
    "NotASolidError",
    "NotFiniteError",
    "Packing",
    "ProgressBar",
    "Query",
    "SweepError",
    "UnsupportedVersionError",
    "WriteError",
    "__version__",
    "coverage_dtype",
    "cuda_available",
    "cuda_device_count",
    "exact_dtype",
    "exact_overlap",
    "expected_error",
    "expected_error_dtype",
    "overlap_dtype",
    "pack",
    "pair_dtype",
    "random_poses",
    "read",
    "solid",
    "sphere_contact_dtype",
    "surface_of",
    "sweep",
]
