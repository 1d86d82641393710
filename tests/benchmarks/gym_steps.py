"""Steps a second of the environment for learners, by number of processes.

PYTHONPATH=build/python build/python-env/bin/python tests/benchmarks/gym_steps.py > tests/benchmarks/results/gym.md
"""

import os
import platform
import subprocess
import tempfile
import time

import gymnasium
import numpy as np

import innersphere.gym  # noqa: F401  registers it

STEPS = 150


def measure(count, cache):
    """Steps a second of `count` processes, by the clock, and processor time of a step in all of them [s]."""
    envs = gymnasium.make_vec(
        "innersphere/NutOnBolt-v0", count, vectorization_mode="async", vector_kwargs={"context": "spawn"}, cache=cache
    )
    envs.reset(seed=1)
    action = np.tile(np.array([0, 0, 0, 0, 0, -0.5], np.float32), (count, 1))
    envs.step(action)
    start = time.perf_counter()
    for _ in range(STEPS):
        envs.step(action)
    took = time.perf_counter() - start
    before = os.times()
    envs.close()
    after = os.times()  # of children that have ended
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return count * STEPS / took, used / (count * STEPS)


def main():
    with tempfile.TemporaryDirectory() as cache:
        measure(1, cache)  # packs
        rows = [(count, *measure(count, cache)) for count in (1, 2, 4)]
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    print("# The environment for learners\n")
    print(
        f"**{rows[0][1]:.0f} steps a second in one process, {rows[1][1]:.0f} in two**, on {os.cpu_count()} cores that others used, "
        "too. A step is 12 steps of PyBullet at 240 Hz: a nut of 1,000 spheres on its bolt.\n"
    )
    print(f"`tests/benchmarks/gym_steps.py`, {time.strftime('%Y-%m-%d')}, {commit}, {platform.machine()}, Python "
          f"{platform.python_version()}, load {os.getloadavg()[0]:.1f}\n")  # fmt: skip
    print("| processes | steps a second | processor time of a step, start-up included |\n|---|---|---|")
    for count, rate, used in rows:
        print(f"| {count} | {rate:.0f} | {1e3 * used:.1f} ms |")


if __name__ == "__main__":
    main()
