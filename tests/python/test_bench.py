"""The truth bench: what it measures against motions that are known, and that a run writes its page."""

import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import innersphere

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
TOOL = Path(innersphere.__file__).parents[2] / "bin" / "innersphere"
sys.path.insert(0, str(BENCHMARKS))
pytest.importorskip("trimesh")
pytest.importorskip("scipy")
quantities = pytest.importorskip("bench.quantities")
from bench.recording import GRAVITY, Recording  # noqa: E402

RATE = 240


def recording(positions, turns_about_z=None, friction=0.0, mass=2.0, inertia=(1.0, 1.0, 0.5), bodies=1):
    """Of bodies whose centres of mass are at `positions`, (steps, bodies, 3)."""
    body = {"mass": mass, "inertia": list(inertia), "size": 1.0, "mesh_frame": np.eye(4).tolist()}
    scene = {"friction": friction, "fall": 1.0, "bodies": [body | {"name": f"ring.{i}"} for i in range(bodies)]}
    poses = np.zeros((len(positions), bodies, 7))
    poses[:, :, :3] = positions
    poses[:, :, 6] = 1
    if turns_about_z is not None:
        poses[:, 0, 5], poses[:, 0, 6] = np.sin(turns_about_z / 2), np.cos(turns_about_z / 2)
    return Recording(scene, RATE, poses)


def fall(acceleration, steps=480):
    """Places of a body that falls, with exact velocities between steps."""
    time = np.arange(steps + 1) / RATE
    places = np.zeros((steps + 1, 1, 3))
    places[:, 0, 2] = -acceleration * time**2 / 2
    return time, places


def test_a_free_fall_gains_no_energy_and_a_faster_one_does():
    _, places = fall(GRAVITY)
    assert quantities.energy_gained(recording(places)) < 1e-9
    _, places = fall(1.1 * GRAVITY)
    # It falls 2 s: 21.6 m, and gets a tenth more than that gives.
    assert quantities.energy_gained(recording(places)) == pytest.approx(0.1 * 1.1 * GRAVITY * 2, rel=0.01)


def test_the_law_of_the_screw_is_that_of_energy_without_friction():
    pitch, mass, inertia = 0.125, 2.0, (1.0, 1.0, 0.5)
    k = 2 * math.pi / pitch
    time, places = fall(GRAVITY / (1 + inertia[2] * k * k / mass))
    nut = recording(places, k * places[:, 0, 2], mass=mass, inertia=inertia)
    law = {"pitch": pitch, "radius": 0.27, "flank": 30}
    assert quantities.screw_acceleration(nut, "ring.0", since=0.3, **law) == pytest.approx(1, abs=1e-6)
    assert quantities.turn_over_way(nut, "ring.0") == pytest.approx(k, rel=1e-6)
    # Friction takes work N f along the helix: what it slows down by for a small f, 1 / (cos b tan a) of it at first order.
    slow = recording(places, k * places[:, 0, 2], friction=1e-4, mass=mass, inertia=inertia)
    slope = math.atan(pitch / (2 * math.pi * 0.27))
    flank = math.atan(math.tan(math.radians(30)) * math.cos(slope))
    part = 1e-4 * (1 / math.tan(slope) + math.tan(slope)) / math.cos(flank)
    assert quantities.screw_acceleration(slow, "ring.0", since=0.3, **law) == pytest.approx(1 + part, rel=1e-4)


def test_rings_that_overlap_by_a_centimetre():
    # Two circles about z, side by side: their tubes come nearest on the line between the centres.
    places = np.zeros((2, 2, 3))
    places[:, 1, 0] = 2 * 1 + 2 * 0.25 - 0.01
    assert quantities.ring_overlap(recording(places, bodies=2), ring=1, tube=0.25) == pytest.approx(0.01, abs=1e-9)


def run(folder, *options):
    environment = os.environ | {"PYTHONPATH": f"{BENCHMARKS}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    environment.pop("INNERSPHERE_BENCH_BIN", None)
    return subprocess.run([sys.executable, "-m", "bench", *map(str, options)], env=environment, cwd=folder, capture_output=True, text=True)


@pytest.mark.skipif(not TOOL.exists(), reason="the tool is not built beside the package")
def test_a_run_writes_the_page_and_an_engine_that_is_not_there_is_a_dash(tmp_path):
    pytest.importorskip("mujoco")
    pytest.importorskip("matplotlib")
    done = run(tmp_path, tmp_path, "--tool", TOOL, "--engines", "mujoco-hulls", "bullet-gimpact", "--scenes", "mass-ratios", "--rates", 60,
               "--spheres", 64, "--no-repeat", "--no-queries")
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader((tmp_path / "bench.csv").read_text().splitlines()))
    assert {row["engine"] for row in rows} == {"mujoco-hulls"}
    height = next(row for row in rows if row["quantity"] == "height of heavy-1")
    assert abs(float(height["measured"]) - 0.75) < 0.02  # it stands, whatever its tolerance
    assert json.loads((tmp_path / "versions.json").read_text())["bullet-gimpact"] == ""
    text = (tmp_path / "bench.md").read_text()
    assert "| bullet-gimpact | - | - |" in text and "| bullet-gimpact | not here |" in text
    assert (tmp_path / "bench.png").stat().st_size > 1000

    other = tmp_path / "other.csv"
    assert run(tmp_path, "compare", "bench.csv", "bench.csv").returncode == 0
    holding = next(row for row in rows if row["holds"] == "True")
    other.write_text((tmp_path / "bench.csv").read_text().replace(f",{holding['measured']},True", ",99,False"))
    done = run(tmp_path, "compare", "bench.csv", other)
    assert done.returncode == 1 and "differs" in done.stdout
