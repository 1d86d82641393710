"""Runs the code that users read, and looks at what it computed."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import BOX_VERTICES, write_obj

import innersphere

SOURCE = Path(__file__).resolve().parents[2]


def run(document, folder, monkeypatch):
    """Runs all blocks of Python of a document, one after the other, beside a mesh of 1 x 1 x 1 m.

    Those that are scripts, whose workers import them, run by themselves."""
    write_obj(folder / "your.obj", BOX_VERTICES / [1, 2, 3])
    monkeypatch.chdir(folder)
    blocks = re.findall(r"```python\n(.*?)```", (SOURCE / document).read_text(), re.DOTALL)
    assert blocks
    names: dict = {}
    for block in blocks:
        if "__main__" in block:
            (folder / "script.py").write_text(block)
            subprocess.run([sys.executable, "script.py"], check=True)
        else:
            exec(compile(block, document, "exec"), names)
    return names


@pytest.mark.skipif(
    importlib.util.find_spec("pybullet") is None or not hasattr(innersphere._core, "pybullet"), reason="needs PyBullet"
)
def test_the_guide(tmp_path, monkeypatch):
    names = run("plugin/python/README.md", tmp_path, monkeypatch)
    assert len(names["packing"]) == len(names["spheres"]) == 1000 and len(names["coarse"]) == 256
    assert names["mass"] == pytest.approx(7800)
    np.testing.assert_allclose(names["inertia"], 7800 / 6 * np.eye(3), atol=1e-6)
    assert names["shared"]["volume"] == pytest.approx(0.5, rel=0.05)
    # Volume-true spheres are right in the mean: half of the way half is shared.
    assert names["volume"].mean() == pytest.approx(0.5, rel=0.1)
    assert names["round_packing"].volume == pytest.approx(4 / 3 * np.pi / 8, rel=0.02)
    assert names["force"].shape == (1000, 3)
    np.testing.assert_allclose(np.loadtxt(tmp_path / "volumes.csv"), names["volume"])
    assert len(names["of_second_pose"]) > 0
    assert names["place"][0] == pytest.approx([3, 0, 0], abs=2e-3)
    assert names["touching"]["force"][:, 2].sum() == pytest.approx(-2 * 9.81, rel=0.05)  # both lie
    assert names["p"].getPhysicsEngineParameters()["fixedTimeStep"] == pytest.approx(1 / 60)
    names["p"].disconnect()
    assert (tmp_path / "spheres.urdf").read_text().count("<sphere") == 32
    assert 0 < names["links"]["base"].overhang < 0.2
    # Over all places, two unit cubes share 1 m^3 times 1 m^3; these poses are spread over 5 x 5 x 5 m.
    assert np.load(tmp_path / "volumes.npy").mean() == pytest.approx(1 / 125, rel=0.05)
    assert names["message"].startswith("query 17: the placement of B")


def test_the_readme(tmp_path, monkeypatch):
    names = run("README.md", tmp_path, monkeypatch)
    np.testing.assert_allclose(names["shared"]["volume"], [0.9, 0.5, 0.1], rtol=0.2)
