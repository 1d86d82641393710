"""Sweeps: the same bytes from all engines and splits, workers that die, files that do not fit, and what else goes wrong."""

import functools
import gc
import importlib.util
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import BOX_FACES, BOX_VERTICES, matrix

import innersphere

COUNT = 1000


def installed(*modules):
    return all(importlib.util.find_spec(name) for name in modules)


ENGINES = [
    "processes",
    pytest.param(
        "dask", marks=pytest.mark.skipif(not installed("distributed"), reason="dask.distributed is not installed")
    ),
    pytest.param("ray", marks=pytest.mark.skipif(not installed("ray"), reason="ray is not installed")),
]


def open_models(folder, path):
    """What each worker opens; a line in a file tells of it."""
    with open(Path(folder) / "opened", "a") as log:
        log.write(f"{os.getpid()}\n")
    return innersphere.Query("cpu", threads=1), innersphere.read(path)


def volumes(state, first, count):
    query, packing = state
    poses = innersphere.random_poses(count, -1, 1, seed=7, first=first)
    return query.overlap(packing, packing, pose_b=poses, want="volume")["volume"]


def killed_once(flag, state, first, count):
    """The worker that has row 500 dies, at the first time."""
    if first <= 500 < first + count and not os.path.exists(flag):
        Path(flag).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return volumes(state, first, count)


def squares(first, count):
    return np.arange(first, first + count) ** 2


def deadly(first, count):
    if first == 30:
        os.kill(os.getpid(), signal.SIGKILL)
    return squares(first, count)


def fails_without(folder, first, count):
    with open(Path(folder) / "done", "a") as log:
        log.write(f"{first}\n")
    if first == 60 and not (Path(folder) / "flag").exists():
        raise OSError("the sensor is off")
    return squares(first, count)


def part_of(rows, first, count):
    return rows(first, count)


@pytest.fixture(scope="module")
def packing(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "box.cbor"
    innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=100, overlap_errors=False).save(path)
    return str(path)


@pytest.fixture(scope="module")
def whole(packing):
    """The truth, without a sweep: all poses in one query."""
    box = innersphere.read(packing)
    poses = innersphere.random_poses(COUNT, -1, 1, seed=7)
    return innersphere.Query("cpu").overlap(box, box, pose_b=poses, want="volume")["volume"]


def saved(folder, array):
    np.save(folder / "expected.npy", array)
    return (folder / "expected.npy").read_bytes()


@pytest.mark.filterwarnings("default")  # those of the engines are not ours
@pytest.mark.parametrize("engine", ENGINES)
def test_a_worker_is_killed_and_the_file_has_the_same_bytes(engine, packing, whole, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(Path(__file__).parent)
    monkeypatch.setenv(
        "PYTHONPATH", os.pathsep.join(sys.path)
    )  # Ray's workers look only beside the script, which is pytest
    out = tmp_path / "volumes.npy"
    got = innersphere.sweep(
        functools.partial(killed_once, str(tmp_path / "flag")),
        COUNT,
        setup=functools.partial(open_models, str(tmp_path), packing),
        block=70,
        engine=engine,
        workers=2,
        out=out,
    )
    gc.collect()  # what engines leave open is warned of here, not in the tests that follow
    assert (tmp_path / "flag").exists()
    assert isinstance(got, np.memmap) and not got.flags.writeable
    assert out.read_bytes() == saved(tmp_path, whole)
    opened = (tmp_path / "opened").read_text().split()
    assert 2 <= len(set(opened)) == len(opened) <= 5  # once in each, and in those that took the place of the dead
    assert sorted(p.name for p in tmp_path.iterdir()) == ["expected.npy", "flag", "opened", "volumes.npy"]


@pytest.mark.parametrize("block", [1, 333, 1000, 5000])
def test_any_split_gives_the_same_bytes(block, packing, whole, tmp_path):
    out = tmp_path / "volumes.npy"
    setup = functools.partial(open_models, str(tmp_path), packing)
    innersphere.sweep(volumes, COUNT, setup=setup, block=block, engine="serial", out=out)
    assert out.read_bytes() == saved(tmp_path, whole)
    in_memory = innersphere.sweep(volumes, COUNT, setup=setup, block=block, engine="serial")
    np.testing.assert_array_equal(in_memory, whole)


def test_executors_of_the_user(tmp_path):
    with ThreadPoolExecutor(2) as pool:
        np.testing.assert_array_equal(innersphere.sweep(squares, 100, block=7, engine=pool), np.arange(100) ** 2)
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn) as pool, pytest.raises(innersphere.SweepError, match="a worker died while rows"):
        innersphere.sweep(deadly, 100, block=30, engine=pool)


def killed_after_a_row(folder, state, first, count):
    """As killed_once(), but not before a block is in the file: with MPI all ends with a worker."""
    done = Path(folder) / "volumes.npy.part.done"
    while first <= 500 < first + count and not (done.exists() and b"\1" in done.read_bytes()):
        time.sleep(0.01)
    return killed_once(folder + "/flag", state, first, count)


MPI_SCRIPT = """
    import functools, sys
    sys.path.insert(0, {tests!r})
    from test_sweep import COUNT, killed_after_a_row, open_models, volumes
    import innersphere

    if __name__ == "__main__":
        folder, packing, kill = sys.argv[1:]
        innersphere.sweep(
            functools.partial(killed_after_a_row, folder) if kill == "kill" else volumes,
            COUNT,
            setup=functools.partial(open_models, folder, packing),
            block=70,
            engine="mpi",
            out=folder + "/volumes.npy",
            resume=True,
        )
"""


def mpiexec():
    """That of the MPI beside mpi4py, or of the system."""
    beside = Path(sys.executable).parent / "mpiexec"
    return str(beside) if beside.exists() else shutil.which("mpiexec")


@pytest.mark.skipif(not installed("mpi4py") or mpiexec() is None, reason="mpi4py and an MPI are not installed")
def test_mpi_ends_with_a_worker_and_goes_on_where_it_was(packing, whole, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(textwrap.dedent(MPI_SCRIPT.format(tests=str(Path(__file__).parent))))

    def run(kill):
        command = [mpiexec(), "-n", "3"] + ["--oversubscribe", "--allow-run-as-root"] * ("openmpi" in help_text)
        return subprocess.run(
            [*command, sys.executable, "-m", "mpi4py.futures", script, tmp_path, packing, kill],
            capture_output=True,
            text=True,
            timeout=120,
        )

    help_text = subprocess.run([mpiexec(), "--version"], capture_output=True, text=True).stdout.lower().replace(" ", "")
    assert run("kill").returncode != 0
    assert (tmp_path / "volumes.npy.part").exists() and not (tmp_path / "volumes.npy").exists()
    again = run("live")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "volumes.npy").read_bytes() == saved(tmp_path, whole)


def test_a_block_that_always_kills_is_named(tmp_path):
    with pytest.raises(innersphere.SweepError, match="a worker died 2 times while rows 30 to 39"):
        innersphere.sweep(deadly, 100, block=10, workers=1, tries=2, out=tmp_path / "squares.npy")
    assert list(tmp_path.iterdir()) == []


def test_resume_does_only_what_is_missing(tmp_path):
    out, work = tmp_path / "squares.npy", functools.partial(fails_without, str(tmp_path))
    run = functools.partial(innersphere.sweep, work, 100, block=20, engine="serial", out=out, resume=True)
    with pytest.raises(innersphere.SweepError, match="rows 60 to 79: OSError: the sensor is off") as caught:
        run()
    assert isinstance(caught.value.__cause__, OSError)
    assert not out.exists()
    with pytest.raises(innersphere.FileThereError, match="resume=True"):
        run(resume=False)
    with pytest.raises(innersphere.FormatError, match="blocks of 20"):
        run(block=25)
    (tmp_path / "flag").touch()
    (tmp_path / "done").unlink()
    run()
    assert (tmp_path / "done").read_text().split() == ["60", "80"]
    assert out.read_bytes() == saved(tmp_path, np.arange(100) ** 2)
    assert not (tmp_path / "squares.npy.part").exists() and not (tmp_path / "squares.npy.part.done").exists()


@pytest.mark.parametrize("part, done", [(b"", None), (b"\x93NUMPY", b""), (None, b"100 rows in blocks of 20\n\1\1\1\1\1")])
def test_resume_of_a_sweep_that_was_ended_as_it_began_or_as_it_was_complete(part, done, tmp_path):
    out = tmp_path / "squares.npy"
    for name, content in (("squares.npy.part", part), ("squares.npy.part.done", done)):
        if content is not None:
            (tmp_path / name).write_bytes(content)
    innersphere.sweep(squares, 100, block=20, engine="serial", out=out, resume=True)
    assert [p.name for p in tmp_path.iterdir()] == ["squares.npy"]
    assert out.read_bytes() == saved(tmp_path, np.arange(100) ** 2)


def test_without_resume_nothing_is_left(tmp_path):
    with pytest.raises(innersphere.SweepError):
        innersphere.sweep(
            functools.partial(fails_without, str(tmp_path)), 100, block=20, engine="serial", out=tmp_path / "a.npy"
        )
    assert [p.name for p in tmp_path.iterdir()] == ["done"]


def test_reduce_goes_from_the_first_block_to_the_last():
    def joined(value, part):
        return value + part

    got = innersphere.sweep(squares_as_list, 100, block=9, workers=2, reduce=joined)
    assert got == [n * n for n in range(100)]
    assert innersphere.sweep(squares, 0, reduce=joined) is None


def squares_as_list(first, count):
    return [n * n for n in range(first, first + count)]


def test_structured_rows_and_no_rows(tmp_path):
    kind = np.dtype([("n", "<i4"), ("x", "<f8", (3,))])

    def rows(first, count):
        part = np.zeros(count, kind)
        part["n"] = np.arange(first, first + count)
        return part

    got = innersphere.sweep(rows, 50, block=7, engine="serial", out=tmp_path / "rows.npy")
    assert got.dtype == kind and got["n"].tolist() == list(range(50))
    assert len(innersphere.sweep(rows, 0, engine="serial", out=tmp_path / "none.npy")) == 0
    assert len(innersphere.sweep(rows, 0, engine="serial")) == 0


@pytest.mark.parametrize(
    "rows, message",
    [
        (lambda first, count: np.zeros(count + 1), "must have 10 rows"),
        (lambda first, count: 7, r"has the shape \(\); it must have 10 rows"),
        (lambda first, count: np.zeros(count, "f4" if first else "f8"), "rows 10 to 19 has rows of float32"),
        (lambda first, count: np.zeros((count, 1 + first)), "others have float64"),
        (lambda first, count: np.full(count, None), "object"),
    ],
)
def test_wrong_rows(rows, message, tmp_path):
    for out in (None, tmp_path / "rows.npy"):
        with pytest.raises((TypeError, ValueError), match=message):
            innersphere.sweep(rows, 100, block=10, engine="serial", out=out)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words, error, message",
    [
        (dict(count=-1), innersphere.InvalidArgumentError, "count"),
        (dict(block=0), innersphere.InvalidArgumentError, "block"),
        (dict(tries=0), innersphere.InvalidArgumentError, "tries"),
        (dict(workers=0), innersphere.InvalidArgumentError, "workers"),
        (dict(engine="slurm"), ValueError, "'processes'"),
        (dict(engine=7), TypeError, "int"),
        (dict(out="rows.csv"), ValueError, "npy"),
        (dict(out="there.npy"), innersphere.FileThereError, "there.npy exists"),
        (dict(out="nowhere/rows.npy"), innersphere.WriteError, "No such file"),
        (dict(out="rows.npy", reduce=max), ValueError, "one of the two"),
        (dict(progress=lambda stage, fraction: fraction < 0.5), innersphere.CancelledError, "cancelled"),
        (dict(setup=lambda: 1 / 0), innersphere.SweepError, "ZeroDivisionError"),
    ],
)
def test_bad_arguments(words, error, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.npy").touch()
    with pytest.raises(error, match=message):
        innersphere.sweep(**{**dict(function=squares, count=100, block=10, engine="serial"), **words})
    assert [p.name for p in tmp_path.iterdir()] == ["there.npy"]


def test_functions_that_cannot_travel_are_an_error():
    with pytest.raises(innersphere.SweepError, match="(?i)pickle|local object"):
        innersphere.sweep(lambda first, count: squares(first, count), 10, workers=1)


def test_overwrite(tmp_path):
    out = tmp_path / "squares.npy"
    for count in (10, 20):
        got = innersphere.sweep(squares, count, engine="serial", out=out, overwrite=True)
        assert len(got) == count


def test_a_full_disk_is_an_error_and_nothing_is_left(tmp_path):
    """A limit of the size of files does what a full disk does."""
    script = f"""
        import numpy as np, resource, innersphere
        resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
        try:
            innersphere.sweep(lambda first, count: np.zeros(count), 10_000, engine="serial", out={str(tmp_path / "a.npy")!r})
        except innersphere.WriteError as error:
            print(error)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True)
    assert "cannot write" in done.stdout, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_progress_of_all_blocks():
    told = []
    innersphere.sweep(squares, 100, block=30, engine="serial", progress=lambda *one: told.append(one))
    assert {stage for stage, _ in told} == {"sweeping"}
    fractions = [fraction for _, fraction in told]
    assert fractions == sorted(fractions) and fractions[0] == 0 and fractions[-1] == 1


def test_random_poses_do_not_depend_on_the_block():
    positions, quaternions = innersphere.random_poses(1000, [-1, 0, 2], [1, 5, 2], seed=3)
    for first, count in ((0, 1), (1, 10), (500, 500)):
        p, q = innersphere.random_poses(count, [-1, 0, 2], [1, 5, 2], seed=3, first=first)
        np.testing.assert_array_equal(p, positions[first : first + count])
        np.testing.assert_array_equal(q, quaternions[first : first + count])
    assert not np.array_equal(innersphere.random_poses(1000, 0, 1, seed=4)[1], quaternions)
    with pytest.raises(innersphere.InvalidArgumentError):
        innersphere.random_poses(-1, 0, 1)
    with pytest.raises(innersphere.NotFiniteError, match="high"):
        innersphere.random_poses(1, 0, [1, np.nan, 1])


def test_random_poses_are_spread_evenly():
    n = 20000
    positions, quaternions = innersphere.random_poses(n, [-1, 0, 2], [1, 5, 2])
    np.testing.assert_allclose(positions.mean(0), [0, 2.5, 2], atol=5 * 5 / np.sqrt(12 * n))
    assert (positions >= [-1, 0, 2]).all() and (positions <= [1, 5, 2]).all()
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1)
    # Of even turns, each axis goes everywhere on the sphere alike, and the angle has the density (1 - cos t) / pi.
    turns = np.array([matrix([0, 0, 0], q)[:3, :3] for q in quaternions[:5000]])
    np.testing.assert_allclose(turns.mean(0), 0, atol=5 / np.sqrt(3 * 5000))
    np.testing.assert_allclose((turns**2).mean(0), 1 / 3, atol=0.025)
    cosine = (np.trace(turns, axis1=1, axis2=2) - 1) / 2
    assert cosine.mean() == pytest.approx(-0.5, abs=5 * 0.5 / np.sqrt(5000))
