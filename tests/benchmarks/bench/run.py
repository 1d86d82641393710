"""Runs one engine over one scene: python -m bench.run ENGINE SCENE.json RATE OUT. Writes OUT.f64 and OUT.json."""

import json
import pathlib
import subprocess
import sys
import time

import numpy as np

from .engines import Program, all_engines
from .recording import read_scene


def _python(engine: type, scene: dict, rate: int, out: str) -> None:
    world = engine(scene, 1 / rate)
    steps = round(scene["seconds"] * rate)
    poses, cpu, wall = [world.poses()], [], []
    for i in range(steps):
        a, b = time.process_time(), time.perf_counter()
        world.step(i / rate)
        cpu.append(time.process_time() - a)
        wall.append(time.perf_counter() - b)
        poses.append(world.poses())
    np.array(poses, dtype=np.float64).tofile(out + ".f64")
    result = {"cpu_ms": 1e3 * float(np.mean(cpu)), "wall_ms": 1e3 * float(np.mean(wall)), "memory_mb": _most_memory()}
    pathlib.Path(out + ".json").write_text(json.dumps(result))


def _most_memory() -> float:
    """That the process ever had [MB], of Python and its modules too."""
    for line in pathlib.Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1024
    return 0.0


def main(name: str, scene_file: str, rate: int, out: str) -> None:
    engine = all_engines()[name]
    if issubclass(engine, Program):
        subprocess.run(engine.command(scene_file, rate, out), check=True, stdout=subprocess.DEVNULL)
    else:
        _python(engine, read_scene(pathlib.Path(scene_file)), rate, out)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4])
