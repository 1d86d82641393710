"""Where the programs of the bench are."""

import os
import pathlib
import shutil

from .base import Absent


def program(name: str) -> str:
    """Raises Absent."""
    folder = os.environ.get("INNERSPHERE_BENCH_BIN", "")
    path = shutil.which(name, path=folder)
    if not path:
        raise Absent(f"{name} is not in INNERSPHERE_BENCH_BIN ({folder or 'not set'})")
    return str(pathlib.Path(path).resolve())
