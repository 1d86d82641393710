"""Runs the examples, and looks at what they computed and at the size of their pictures."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

import innersphere

EXAMPLES = Path(__file__).resolve().parents[2] / "plugin" / "python" / "examples"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Runs an example in an empty folder; returns its variables."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(EXAMPLES)
    yield lambda name: runpy.run_path(str(EXAMPLES / f"{name}.py"))
    if "pybullet" in sys.modules:
        p = sys.modules["pybullet"]
        for client in filter(p.isConnected, range(4)):
            p.disconnect(client)


@pytest.fixture
def run_in_pybullet(run):
    pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    pytest.importorskip("PIL", reason="pillow is not installed")
    if not hasattr(innersphere._core, "pybullet"):
        pytest.skip("innersphere was built without Bullet")
    return run


def picture(name):
    """The pixels of a picture, which shows more than its background."""
    from PIL import Image

    pixels = np.asarray(Image.open(name))
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 10
    return pixels


def test_chain(run_in_pybullet):
    hangs, hulls = run_in_pybullet("chain")["ends"]
    assert hangs == pytest.approx(-4.7, abs=0.003) and hulls < -10
    picture("chain.png")


def test_nut_on_bolt(run_in_pybullet):
    found = run_in_pybullet("nut_on_bolt")
    assert found["turns"] == pytest.approx(1, abs=0.01)
    assert -found["speed"] == pytest.approx(2 * found["law"], rel=0.03)
    assert found["sank"][0] == pytest.approx(2 * found["law"], abs=0.01)  # and the play of the threads
    assert found["sank"][1] > 1
    picture("nut_on_bolt.png")


def test_peg_in_hole(run_in_pybullet):
    fills, stands = run_in_pybullet("peg_in_hole")["heights"]
    assert fills == pytest.approx(0.2, abs=0.01) and stands == pytest.approx(0.6, abs=0.01)
    picture("peg_in_hole.png")


def test_mug_on_hook(run_in_pybullet):
    hangs, hull = run_in_pybullet("mug_on_hook")["places"]
    # The bar is 0.05 thick at 0.52, the hole in the handle ends at 0.4 + 0.19.
    assert hangs[2] == pytest.approx(0.52 + 0.05 - 0.59, abs=0.01) and hull[2] < -1
    picture("mug_on_hook.png")


def test_gripper(run_in_pybullet):
    found = run_in_pybullet("gripper")
    held, hull = found["lifted"]
    assert held == pytest.approx(0.2, abs=0.003) and np.abs(found["tilt"]).max() < 0.02
    assert hull < 0.05
    picture("gripper.png")


def test_nesting(run):
    pytest.importorskip("PIL", reason="pillow is not installed")
    found = run("nesting")
    part, query = found["part"], innersphere.Query()
    # Every pair one by one, and the tray: what is left is far less than a sphere.
    poses = [(found["place"][k], found["turn"][k]) for k in range(12)]
    pairs = [query.overlap(part, part, poses[k], poses[m])["volume"] for k in range(12) for m in range(k)]
    walls = [query.overlap(found["tray"], part, None, pose)["volume"] for pose in poses]
    assert len(pairs) == 66 and max(pairs + walls) < 2e-3 * part.volume
    assert (np.abs(found["place"][:, :2]) < 0.8).all()
    assert len(np.unique(picture("nesting.png").reshape(-1, 3), axis=0)) == 12 + 2  # each bracket has a colour


def test_heat_map(run):
    pytest.importorskip("PIL", reason="pillow is not installed")
    found = run("heat_map")
    gear, volume = found["gear"], found["volume"]
    assert volume.size == 10**6 and picture("heat_map.png").shape == (1000, 1000, 3)
    # Over all places in their plane, two parts of one thickness share the product of their areas, times that thickness.
    height = np.ptp(gear.vertices[:, 2])
    assert volume.mean() * 2.4**2 == pytest.approx(gear.volume**2 / height, rel=0.05)


def test_mujoco_forces(run):
    pytest.importorskip("mujoco")
    assert run("mujoco_forces")["data"].xpos[-1, 2] == pytest.approx(-3 * 0.94, abs=0.05)


def test_autograd(run):
    pytest.importorskip("torch")
    found = run("autograd")
    # Teeth in gaps: nearer than tip to tip, and no nearer than tip to root, the smallest radius of the rim.
    radius = np.linalg.norm(found["gear"].vertices[:, :2], axis=1)
    assert radius.max() + radius[radius > 0.3].min() - 0.02 < found["apart"] < 2 * radius.max() - 0.05
    assert found["share"] < 1e-3
