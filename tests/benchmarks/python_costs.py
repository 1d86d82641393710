"""What Python costs, beside the tool, and how long the first steps take.

PYTHONPATH=build/python build/python-env/bin/python tests/benchmarks/python_costs.py build/bin/innersphere > costs.md

The tool is asked for the forces that its query sums by itself, as in Python. By default it collects what each sphere has to do with
them, which takes it several times as long.
"""

import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import innersphere

POSES, RUNS = 100_000, 5

FIRST_BODY = """
import pybullet as p, innersphere.pybullet
p.connect(p.DIRECT); p.setGravity(0, 0, -9.81)
p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
body = p.loadURDF("torus.urdf", [0, 0, 1])
innersphere.pybullet.attach().pack_all(body)
"""
THEN = """
for _ in range(480): p.stepSimulation()
print(p.getBasePositionAndOrientation(body)[0][2])
"""
URDF = """<robot name="torus"><link name="base"><inertial><mass value="1"/>
<inertia ixx=".1" ixy="0" ixz="0" iyy=".1" iyz="0" izz=".2"/></inertial>
<collision><geometry><mesh filename="torus.obj"/></geometry></collision></link></robot>"""


def used(command, **options):
    """Processor and clock time of a process [s], and what it printed."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    out = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, **options).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.perf_counter() - start, out


def one_core(command):
    return ["taskset", "-c", str(min(os.sched_getaffinity(0))), *command]


def sweep(tool, folder):
    """Processor time of 1e5 poses in Python and in the tool, the least of some runs in turn, and of the tool's files [s]."""
    torus = innersphere.pack(innersphere.solid("torus"), spheres=4000, overlap_errors=False)
    torus.save(folder / "torus.cbor")
    size = np.ptp(torus.vertices, axis=0).max() / 2
    positions, quaternions = innersphere.random_poses(POSES, -size, size, seed=1)
    x, y, z, w = quaternions.T
    matrices = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), positions[:, 0]],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), positions[:, 1]],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), positions[:, 2]]])  # fmt: skip
    table = np.moveaxis(matrices, 2, 0).reshape(POSES, 12)
    header = ",".join(f"m{i}{k}" for i in range(3) for k in range(4))
    for name, far in (("near", 0), ("far", 100)):
        moved = table + far * np.array([0, 0, 0, size] + 8 * [0])
        np.savetxt(folder / f"{name}.csv", moved, fmt="%.17g", delimiter=",", header=header, comments="")
    query = innersphere.Query("cpu", threads=1)
    query.overlap(torus, torus)  # builds its grids, as the tool does before its sweep
    in_python, in_tool, files = [], [], []
    for _ in range(RUNS):
        start = time.process_time()
        found = query.overlap(torus, torus, None, (positions, quaternions))
        in_python.append(time.process_time() - start)
        for name, times in (("near", in_tool), ("far", files)):
            words = [tool, "overlap", "torus.cbor", "torus.cbor", "--backend", "cpu", "--force-law", "volume", "--quiet", "--force"]
            times.append(used(one_core([*words, "--poses", f"{name}.csv", "-o", f"{name}.out"]), cwd=folder)[0])
    from_tool = np.genfromtxt(folder / "near.out", delimiter=",", names=True, comments="#")["volume"]
    np.testing.assert_allclose(found["volume"], from_tool, rtol=1e-4, atol=1e-9)
    return min(in_python), min(in_tool), min(files), (found["volume"] > 0).mean()


def far_pair():
    """Processor time of a call for one pair that is far apart [s]."""
    ball = innersphere.pack(innersphere.solid("torus"), spheres=4000, overlap_errors=False)
    query, pose, out = innersphere.Query("cpu"), np.eye(4), np.zeros(16)
    pose[0, 3] = 100
    times = {}
    for name, words in (("a result of its own", {}), ("out=", {"out": out})):
        runs = []
        for _ in range(10):
            start = time.process_time()
            for _ in range(5000):
                query.overlap(ball, ball, pose_b=pose, **words)
            runs.append((time.process_time() - start) / 5000)
        times[name] = min(runs)
    return times


def imports():
    """The least processor and clock time of a start of Python with these imports [s]."""
    found = {}
    for code in ("pass", "import numpy", "import innersphere"):
        runs = [used([sys.executable, "-c", code])[:2] for _ in range(15)]
        found[code] = tuple(min(run[k] for run in runs) for k in range(2))
    return found


def chain():
    """The largest distance of a link from where a taut chain has it, from 1 s to 10 s [m]."""
    import pybullet as p

    import innersphere.pybullet

    ring, tube = 0.1, 0.02
    u, v = np.meshgrid(2 * np.pi * np.arange(64) / 64, 2 * np.pi * np.arange(24) / 24, indexing="ij")
    vertices = np.stack([(ring + tube * np.cos(v)) * np.cos(u), (ring + tube * np.cos(v)) * np.sin(u), tube * np.sin(v)], -1)
    i, k = np.meshgrid(np.arange(64), np.arange(24), indexing="ij")
    a, b, c, d = i * 24 + k, (i + 1) % 64 * 24 + k, (i + 1) % 64 * 24 + (k + 1) % 24, i * 24 + (k + 1) % 24
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    packing = innersphere.pack((vertices.reshape(-1, 3), faces), spheres=1000, overlap_errors=False)
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    sim = innersphere.pybullet.attach()
    turns = [p.getQuaternionFromEuler([np.pi / 2, 0, turn]) for turn in (0, np.pi / 2)]
    links = [sim.create_body(packing, 0.2 * (i > 0), [0, 0, -0.156 * i], turns[i % 2]) for i in range(6)]
    taut, worst, last = np.array([[0, 0, -2 * (ring - tube) * i] for i in range(6)]), 0.0, 0.0
    for step in range(2400):
        p.stepSimulation()
        last = np.linalg.norm([p.getBasePositionAndOrientation(body)[0] for body in links] - taut, axis=1).max()
        worst = max(worst, last) if step >= 240 else 0
    p.disconnect()
    return worst, last


def first_body(folder):
    vertices, faces = innersphere.solid("torus")
    with open(folder / "torus.obj", "w") as file:
        file.writelines("v {} {} {}\n".format(*row) for row in vertices)
        file.writelines("f {} {} {}\n".format(*row) for row in np.asarray(faces) + 1)
    (folder / "torus.urdf").write_text(URDF)
    processor, clock, out = used([sys.executable, "-c", FIRST_BODY + THEN], cwd=folder)
    return processor, clock, float(out.split()[-1]), np.ptp(vertices, axis=0).min() / 2


def main():
    tool = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name:
        python, whole, files, share = sweep(tool, Path(name))
        processor, clock, rests, half = first_body(Path(name))
    far, starts, (worst, last) = far_pair(), imports(), chain()
    alone, own = starts["pass"], starts["import innersphere"]
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    print(f"`tests/benchmarks/python_costs.py build/bin/innersphere`, {time.strftime('%Y-%m-%d')}, {commit}, {platform.machine()}, Python "
          f"{platform.python_version()}, numpy {np.__version__}, load {os.getloadavg()[0]:.1f}. Times are of the processor, the least of "
          "some runs in turn, where it does not say clock.\n")  # fmt: skip
    rows = [
        (f"1e5 poses, torus of 4,000 spheres twice, {100 * share:.0f} % touch, one core", f"{python:.3f} s",
         f"{100 * (python / (whole - files) - 1):+.1f} % of the tool's sweep ({whole - files:.3f} s); with its tables the tool takes {whole:.2f} s", "at most +5 %"),
        ("`import innersphere`", f"{own[0] - alone[0]:.3f} s (clock: {own[1] - alone[1]:.3f} s)",
         f"of which numpy {starts['import numpy'][0] - alone[0]:.3f} s", "0.3 s"),
        ("a call for one far pair", f"{1e6 * far['out=']:.2f} us with `out=`", f"{1e6 * far['a result of its own']:.2f} us without", "5 us"),
        ("chain of six links, 240 steps/s, 10 s", f"{1000 * worst:.2f} mm off at most after the first second",
         f"{1000 * last:.2f} mm at the end", "1 mm"),
        ("first concave body from a URDF, five lines, packing included", f"clock: {clock:.1f} s",
         f"{processor:.1f} s of the processor; then its middle lies {1000 * abs(rests - half):.1f} mm from where it should, of {1000 * half:.0f} mm", "60 s"),
    ]  # fmt: skip
    print("| | measured | | must reach |\n|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
