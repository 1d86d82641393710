"""Progress of long work."""

from __future__ import annotations

import sys
from typing import TextIO


class ProgressBar:
    """Shows the progress of pack() in one line of a terminal: pack(..., progress=ProgressBar()).

    file: where it is written; None: the standard error stream as it is then.
    """

    width = 40

    def __init__(self, file: TextIO | None = None) -> None:
        self._file = sys.stderr if file is None else file
        self._shown = ""

    def __call__(self, stage: str, fraction: float) -> None:
        """Shows that the fraction (0 to 1) of a stage is done."""
        done = round(self.width * fraction)
        line = f"{stage:10} [{'#' * done}{' ' * (self.width - done)}] {100 * fraction:3.0f} %"
        if line != self._shown:
            self._file.write("\r" + line)
            self._file.flush()
            self._shown = line

    def close(self) -> None:
        """Removes the line."""
        if self._shown:
            self._file.write("\r" + " " * len(self._shown) + "\r")
            self._file.flush()
            self._shown = ""
