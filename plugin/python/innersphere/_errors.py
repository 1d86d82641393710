"""The exceptions of innersphere: one for each code of the C++ library, and Python's own where they fit."""


class Error(Exception):
    """Base of all exceptions of innersphere. The message says what is wrong, where, and what to do about it."""

    code: str = ""
    """Name of the error in the C++ library (ErrorCode)."""


class InvalidArgumentError(Error, ValueError):
    """An argument is outside its range."""

    code = "bad_argument"


class NotFiniteError(Error, ValueError):
    """There is nan or infinity where a number is needed."""

    code = "not_finite"


class EmptyInputError(Error, ValueError):
    """There are no triangles or no spheres."""

    code = "empty_input"


class NotASolidError(Error, ValueError):
    """The mesh does not bound a volume: it is open, not orientable, ..."""

    code = "not_a_solid"


class NoSphereFitsError(Error, ValueError):
    """The solid, or the options, leave no room for a single sphere."""

    code = "no_sphere_fits"


class FormatError(Error, ValueError):
    """A file is not what its ending says, or is damaged."""

    code = "bad_format"


class UnsupportedVersionError(FormatError):
    """A packing was written by a newer version of innersphere."""

    code = "unsupported_version"


class FileMissingError(Error, FileNotFoundError):
    """A path does not exist, is a folder or cannot be opened."""

    code = "file_not_found"


class FileThereError(Error, FileExistsError):
    """The file to write exists, and overwriting was not asked for."""

    code = "file_exists"


class WriteError(Error, OSError):
    """The disk is full or the folder is not writable. Nothing was left behind."""

    code = "write_failed"


class CancelledError(Error):
    """The progress callback returned False."""

    code = "cancelled"


class DeviceError(Error, RuntimeError):
    """A CUDA call failed."""

    code = "device_error"


class NoDeviceError(DeviceError):
    """CUDA was asked for by name, but there is no toolkit, driver or device."""

    code = "no_device"


class DeviceMemoryError(DeviceError, MemoryError):
    """The device cannot hold what the query needs."""

    code = "device_out_of_memory"


class MissingLibraryError(Error, ImportError):
    """A library that this call needs is not installed; the message has the command that installs it."""

    code = "missing_library"


class SweepError(Error, RuntimeError):
    """A block of a sweep failed; the message names its rows, and the cause is what its function raised."""

    code = "sweep_failed"


def _all(base: type[Error]) -> list[type[Error]]:
    return [base] + [c for sub in base.__subclasses__() for c in _all(sub)]


_by_code = {c.code: c for c in _all(Error)}


_words = {
    "ask for repair": "ask for repair=True",
    "ask for overwriting": "give overwrite=True",
}


def exception_for(code: str, message: str) -> Error:
    """Makes the exception of a code of the C++ library, in Python's terms."""
    for of_library, of_python in _words.items():
        message = message.replace(of_library, of_python)
    return _by_code.get(code, Error)(message)
