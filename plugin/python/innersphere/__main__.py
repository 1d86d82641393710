"""python -m innersphere overlap A B: volumes that two solids share, beside exact ones."""

from __future__ import annotations

import argparse
import csv
import os
import sys
import time
from typing import Any

import numpy as np

from . import EmptyInputError, Error, FormatError, Packing, Query, exact_overlap, pack, random_poses, read, solid


def _solid_and_packing(name: str, spheres: int, repair: bool) -> tuple[Any, Packing]:
    if os.path.splitext(name)[1] in (".cbor", ".json"):
        packing = read(name)
        return packing, packing[:spheres] if spheres < len(packing) else packing
    is_path = os.path.exists(name) or os.path.splitext(name)[1] or os.path.dirname(name)
    mesh: Any = name if is_path else solid(name)
    return mesh, pack(mesh, spheres=spheres, repair=repair, overlap_errors=False)


def _read_poses(path: str) -> Any:
    with open(path, encoding="utf-8-sig", newline="") as file:
        # Comments become empty lines, so that the reader counts all lines.
        reader = csv.reader("" if line.startswith("#") or line.isspace() else line for line in file)
        try:
            rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader if cells]
        except csv.Error as error:
            raise FormatError(f"{path}, line {reader.line_num}: {error}") from None
    if len(rows) < 2:
        raise EmptyInputError(f"{path} holds no poses: it needs a header row and data rows")
    names = rows[0][1]
    poses = np.tile(np.eye(4), (len(rows) - 1, 1, 1))
    for i, j in np.ndindex(3, 4):
        name = f"m{i}{j}"
        if name not in names:
            raise FormatError(f"{path} has no column {name}; its header row must name m00 to m23")
        column = names.index(name)
        for pose, (number, cells) in zip(poses, rows[1:]):
            text = cells[column] if column < len(cells) else ""
            try:
                pose[i, j] = float(text)
            except ValueError:
                raise FormatError(f'{path}, line {number}, column {name}: "{text}" is not a number') from None
    return poses


def _poses(path: str | None, a: Packing, b: Packing) -> Any:
    if path is not None:
        return _read_poses(path)
    reach = (np.ptp(a.vertices, axis=0) + np.ptp(b.vertices, axis=0)) / 4
    middle = a.center_of_mass - b.center_of_mass
    return random_poses(100, middle - reach, middle + reach, seed=1)


def overlap(words: argparse.Namespace) -> None:
    """Writes a row for each pose; what it comes to goes to the standard error stream."""
    (mesh_a, a), (mesh_b, b) = (
        _solid_and_packing(name, words.spheres, words.repair) for name in (words.a, words.b)
    )
    poses = _poses(words.poses, a, b)
    query = Query("cpu", threads=1)
    query.overlap(a, b, None, poses, want="volume")  # builds what queries look up
    start = time.process_time()
    found = query.overlap(a, b, None, poses, want="volume")["volume"]
    took = time.process_time() - start
    if not words.exact:
        print("pose,volume")
        for i, volume in enumerate(found):
            print(f"{i},{volume:.9g}")
        return
    start = time.process_time()
    exact = exact_overlap(mesh_a, mesh_b, None, poses, repair=words.repair)["volume"]
    took_exactly = time.process_time() - start
    print("pose,volume,exact")
    for i, (volume, true) in enumerate(zip(found, exact)):
        print(f"{i},{volume:.9g},{true:.9g}")
    deep = exact > 0.01 * min(a.volume, b.volume)
    errors = np.abs(found[deep] / exact[deep] - 1)
    mean = f"{100 * errors.mean():.2f} %, at most {100 * errors.max():.2f} %" if deep.any() else "unknown"
    print(
        f"{len(found)} poses, {deep.sum()} in which more than 1 % of the smaller solid is shared: there the mean error is {mean}.\n"
        f"Processor time of a pose: {1e6 * took / max(len(found), 1):.0f} us; exactly: {1e6 * took_exactly / max(len(found), 1):.0f} us.",
        file=sys.stderr,
    )


def main() -> int:
    """Returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m innersphere", description="Overlaps of solids, and how exact they are.")
    command = parser.add_subparsers(required=True).add_parser("overlap", help="volumes that two solids share in many poses")
    command.add_argument("a", metavar="A", help="mesh, packing (.cbor, .json) or name of a solid; it stands still")
    command.add_argument("b", metavar="B", help="the same for the body that is moved")
    command.add_argument("--poses", metavar="FILE", help="CSV with the columns m00 to m23 of B's 3x4 matrices; else 100 random poses")
    command.add_argument("--spheres", type=int, default=4000, help="of each packing; 4000")
    command.add_argument("--repair", action="store_true", help="close open meshes, as well as can be guessed")
    command.add_argument("--exact", action="store_true", help="the exact volumes, too, by Manifold (pip install manifold3d)")
    command.set_defaults(run=overlap)
    words = parser.parse_args()
    try:
        words.run(words)
    except (Error, OSError, ValueError) as error:
        message = str(error).replace("repair=True", "--repair")  # what is asked for here is an option
        print(f"innersphere: {message}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
