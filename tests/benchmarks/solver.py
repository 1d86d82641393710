"""MuJoCo in the scenes of solver_scenes.cpp, and a page with plots of both and of solver_benchmark.

    solver.py SCENES.csv COSTS.csv PLOTS.png      prints the table of scenes as Markdown, writes the plots
"""

import csv
import math
import sys
import time

import matplotlib
import mujoco
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STEP, G = 1 / 60, 9.81
INTEGRATORS = {"MuJoCo " + mujoco.__version__: "implicitfast", "MuJoCo, RK4": "RK4"}  # the first is what its guide advises
ENGINE = next(iter(INTEGRATORS))
values: list[tuple[str, str, str, float]] = []
series: dict[str, dict[str, list[tuple[float, float]]]] = {}


def value(scene: str, measure: str, x: float) -> None:
    values.append((scene, measure, ENGINE, x))


def sample(name: str, t: float, x: float) -> None:
    series.setdefault(name, {}).setdefault(ENGINE, []).append((t, x))


class World:
    """MuJoCo with its defaults, but for the integrator of ENGINE."""

    def __init__(self, bodies: str, actuators: str = "") -> None:
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco><compiler angle="radian"/><size memory="512M"/>
<option timestep="{STEP!r}" gravity="0 0 -{G}" integrator="{INTEGRATORS[ENGINE]}"><flag energy="enable"/></option>
<default><geom friction="0.5 0.005 0.0001" condim="3"/></default>
<worldbody>{bodies}</worldbody><actuator>{actuators}</actuator></mujoco>""")
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)

    def step(self) -> None:
        mujoco.mj_step(self.model, self.data)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.step()

    def places(self) -> np.ndarray:
        """Centres of mass of all bodies, but not the world [m]."""
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        return self.data.xipos[1:].copy()

    def energy(self) -> float:
        mujoco.mj_forward(self.model, self.data)
        return float(self.data.energy.sum())


FLOOR = '<geom type="plane" size="50 50 1"/>'


def cube(mass: float, at, more: str = "", geom: str = "") -> str:
    return (f'<body pos="{at[0]} {at[1]} {at[2]}" {more}><freejoint/>'
            f'<geom type="box" size=".25 .25 .25" mass="{mass}" {geom}/></body>')


def box(half, mass: float) -> str:
    return f'<geom type="box" size="{half[0]} {half[1]} {half[2]}" mass="{mass}"/>'


def stack() -> None:
    world = World(FLOOR + "".join(cube(125, (0, 0, 0.25 + 0.5 * i)) for i in range(10)))
    first, farthest = world.places(), 0.0
    for i in range(1800):
        world.step()
        farthest = max(farthest, float(np.linalg.norm(world.places() - first, axis=1).max()))
        if i % 6 == 0:
            sample("stack", i * STEP, farthest)
    value("stack of ten boxes, 30 s", "farthest way [mm]", 1e3 * farthest)


def masses(ratio: float, name: str) -> None:
    world = World(FLOOR + cube(1, (0, 0, 0.25)) + cube(ratio, (0, 0, 0.75)))
    world.run(5)
    value(f"a box on one of a {name} of its mass, 5 s", "sunk in by [% of an edge]", 100 * (0.75 - world.places()[1, 2]) / 0.5)


def pile() -> None:
    walls = "".join(f'<geom type="box" size="1 5 8" pos="{2.3 * s} 0 6"/><geom type="box" size="5 1 8" pos="0 {2.3 * s} 6"/>'
                    for s in (-1, 1))
    boxes = ""
    for i in range(125):
        x, y, z = i % 4, i // 4 % 4, i // 16
        axis = np.array([math.sin(i), math.cos(i), 1]) / math.sqrt(2) * math.sin(0.2)
        boxes += cube(1, (0.64 * (x - 1.5), 0.64 * (y - 1.5), 0.4 + 0.62 * z),
                      f'quat="{math.cos(0.2)} {axis[0]} {axis[1]} {axis[2]}"', 'friction="0.5 0.005 0.0001"')
    world = World(FLOOR + walls + boxes)
    world.run(9.5)
    before, times = world.places(), []
    for _ in range(30):
        start = time.perf_counter()
        world.step()
        times.append(time.perf_counter() - start)
    ways = np.linalg.norm(world.places() - before, axis=1)
    scene = "pile of 125 boxes, last half of 10 s"
    value(scene, "moved by more than 5 mm", int((ways > 0.005).sum()))
    value(scene, "largest motion [mm]", 1e3 * float(ways.max()))
    value(scene, "a whole step [ms]", 1e3 * float(np.median(times)))


def period_of_pendulum(amplitude: float, inertia: float) -> float:
    """By the arithmetic-geometric mean."""
    a, b = 1.0, math.cos(amplitude / 2)
    for _ in range(20):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi / a * math.sqrt(inertia / G)


def pendulum() -> None:
    x, z = math.sin(1), -math.cos(1)
    world = World(f'<body pos="{x} 0 {z}"><joint type="hinge" axis="0 1 0" pos="{-x} 0 {-z}"/>{box((.1, .1, .1), 1)}</body>')
    expected = period_of_pendulum(1, 1 + 0.02 / 3)
    before, crossings, x = world.energy(), [], world.places()[0, 0]
    for i in range(1800):
        world.step()
        if i % 6 == 0:
            sample("pendulum", i * STEP, (world.energy() - before) / G)
        now = world.places()[0, 0]
        if x < 0 <= now and i < 1500:
            crossings.append((i + x / (x - now)) * STEP)
        x = now
    scene = "pendulum from 1 rad, 30 s"
    value(scene, "period off by [%]", 100 * ((crossings[-1] - crossings[0]) / (len(crossings) - 1) / expected - 1))
    value(scene, "energy gained [% of m g l]", 100 * (world.energy() - before) / G)


def double_pendulum() -> None:
    bar, joint = box((.5, .05, .05), 1), '<joint type="hinge" axis="0 1 0" pos="-.5 0 0"/>'
    world = World(f'<body pos=".5 0 0">{joint}{bar}<body pos="1 0 0">{joint}<geom type="box" size=".5 .05 .05" mass="1" '
                  'contype="0" conaffinity="0"/></body></body>')
    before, most = world.energy(), 0.0
    for i in range(1800):
        world.step()
        gained = (world.energy() - before) / (2 * G)
        most = gained if abs(gained) > abs(most) else most
        if i % 6 == 0:
            sample("double pendulum", i * STEP, gained)
    value("double pendulum from level, 30 s", "energy off by at most [% of 2 m g l]", 100 * most)


def chain() -> None:
    links = ""
    for i in reversed(range(20)):
        axis = "0 1 0" if i % 2 == 0 else "1 0 0"
        links = (f'<body pos="0 0 {-0.25 if i == 0 else -0.5}"><joint type="hinge" axis="{axis}" pos="0 0 .25"/>'
                 f'{box((.05, .05, .25), 100 if i == 19 else 1)}{links}</body>')
    world = World(links)
    world.run(5)
    before = world.places()[-1]
    world.step()
    scene = "chain of 20 hinges, its end of 100 times the mass, 5 s"
    value(scene, "longer by [mm]", 1e3 * (-0.25 - 0.5 * 19 - before[2]))
    value(scene, "speed of its end [mm/s]", 1e3 * float(np.linalg.norm(world.places()[-1] - before)) / STEP)


def motor() -> None:
    world = World('<body pos=".5 0 0"><joint name="j" type="hinge" axis="0 -1 0" pos="-.5 0 0"/>' + box((.5, .05, .05), 1) +
                  '<geom type="sphere" size=".1" pos=".5 0 0" mass="10"/></body>',
                  '<velocity joint="j" kv="1e5" ctrlrange="-10 10" forcerange="-300 300"/>')
    world.data.ctrl[0] = 1
    world.run(1)
    scene = "motor lifts 10 kg at 1 m by 1 rad/s for 1 s"
    inertia, weight = 10 * 1.004 + 1.01 / 3, 10.5 * G
    value(scene, "angle off what its torque allows by [mrad]", 1e3 * (float(world.data.qpos[0]) - (1 - inertia / (300 - weight) / 2)))
    world.data.ctrl[0] = 0
    world.run(1)
    held = float(world.data.qpos[0])
    world.run(5)
    value(scene, "sags in 5 s by [mrad]", 1e3 * (held - float(world.data.qpos[0])))
    value(scene, "load off its place by [mm]", 0)  # one body


SWING, BENT = 0.7, 2.0


def part(name: str, half, mass: float, at, parent, joint: str, pivot, axis, children: str) -> str:
    """`at`, `pivot` in the figure's frame; `parent`: where the body is that this one hangs from."""
    place = np.array(at) - (np.array(parent) if parent is not None else np.array((0, 0, -0.5)))
    local = np.array(pivot) - np.array(at)
    limits = f'range="0 {SWING}"' if joint == "ball" else f'range="0 {BENT}"'
    kind = ("<freejoint/>" if parent is None else
            f'<joint type="{joint}" limited="true" {limits} pos="{local[0]} {local[1]} {local[2]}" axis="{axis[0]} {axis[1]} {axis[2]}"/>')
    return f'<body name="{name}" pos="{place[0]} {place[1]} {place[2]}">{kind}{box(half, mass)}{children}</body>'


def figure() -> str:
    pelvis, chest = (0, 0, 1.0), (0, 0, 1.3)
    arms = legs = ""
    for s in (-1, 1):
        upper, thigh = (s * 0.33, 0, 1.42), (s * 0.09, 0, 0.7)
        lower = part(f"lower{s}", (.15, .04, .04), 2, (s * 0.63, 0, 1.42), upper, "hinge", (s * 0.48, 0, 1.42), (0, 0, -s), "")
        shin = part(f"shin{s}", (.05, .05, .20), 4, (s * 0.09, 0, 0.3), thigh, "hinge", (s * 0.09, 0, 0.5), (1, 0, 0), "")
        arms += part(f"upper{s}", (.15, .05, .05), 2.5, upper, chest, "ball", (s * 0.18, 0, 1.42), (0, 0, 1), lower)
        legs += part(f"thigh{s}", (.07, .07, .20), 8, thigh, pelvis, "ball", (s * 0.09, 0, 0.9), (0, 0, 1), shin)
    head = part("head", (.09, .10, .12), 5, (0, 0, 1.62), chest, "ball", (0, 0, 1.5), (0, 0, 1), "")
    trunk = part("chest", (.18, .12, .20), 20, chest, pelvis, "ball", (0, 0, 1.1), (0, 0, 1), head + arms)
    return part("pelvis", (.15, .10, .10), 10, pelvis, None, "", (0, 0, 0), (0, 0, 1), trunk + legs)


def ragdoll() -> None:
    world = World(FLOOR + figure())
    before = energy = world.energy()
    beyond, places, speed = 0.0, world.places(), 0.0
    for i in range(600):
        world.step()
        for j in range(1, world.model.njnt):
            at = world.model.jnt_qposadr[j]
            if world.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_BALL:
                beyond = max(beyond, 2 * math.acos(min(1, abs(world.data.qpos[at]))) - SWING)
            else:
                beyond = max(beyond, world.data.qpos[at] - BENT, -world.data.qpos[at])
        now = world.places()
        speed, places = float(np.linalg.norm(now - places, axis=1).max()) / STEP, now
        energy = max(energy, world.energy())
        if i % 2 == 0:
            sample("ragdoll", i * STEP, speed)
    scene = "ragdoll falls, 10 s"
    value(scene, "joints apart by at most [mm]", 0)  # joints are its coordinates
    value(scene, "beyond its limits by at most [deg]", math.degrees(beyond))
    value(scene, "speed at the end [mm/s]", 1e3 * speed)
    value(scene, "energy from nowhere [%]", 100 * (energy - before) / before)


def read_scenes(path: str) -> None:
    with open(path) as file:
        for row in csv.reader(file):
            if row[0] == "value":
                values.append((row[1], row[2], row[3], float(row[4])))
            else:
                series.setdefault(row[1], {}).setdefault(row[3], []).append((float(row[2]), float(row[4])))


def print_table() -> None:
    engines = list(dict.fromkeys(v[2] for v in values))
    print("| scene | |", " | ".join(engines), "|\n|---|---|" + "---|" * len(engines))
    shown = None
    for scene, measure in dict.fromkeys(v[:2] for v in values):
        cells = []
        for engine in engines:
            x = next((v[3] for v in values if v[:3] == (scene, measure, engine)), None)
            cells.append("-" if x is None else "thrown" if abs(x) > 1e6 else f"{x:.3g}" if abs(x) < 1000 else f"{x:.0f}")
        print(f"| {scene if scene != shown else ''} | {measure} |", " | ".join(cells), "|")
        shown = scene


def plot_costs(axes, all_axes, path: str) -> None:
    """Of 8 substeps, beside Bullet's ten iterations on their one thread; and all numbers of substeps of the last pile."""
    with open(path) as file:
        rows = list(csv.DictReader(file))
    last = [row for row in rows if row["pile"] == rows[-1]["pile"]]
    for solver in dict.fromkeys(row["solver"] for row in last):
        line = [(int(row["threads"]), float(row["ms"])) for row in last if row["solver"] == solver]
        all_axes.plot(*zip(*line), "o-", label=solver + (" substeps" if solver.startswith("Substep") else ""))
    all_axes.set(xscale="log", xticks=[1, 2, 4, 8, 16], xticklabels=[1, 2, 4, 8, 16], xlabel="threads", ylim=(0, None),
                 title=f"{rows[-1]['pile']}: solver's time [ms]")
    for color, pile in enumerate(dict.fromkeys(row["pile"] for row in rows)):
        mine = [row for row in rows if row["pile"] == pile]
        base = next(float(row["ms"]) for row in mine if row["solver"] == "Bullet, 10 iterations")
        eight = [(int(row["threads"]), float(row["ms"]) / base) for row in mine if row["solver"] == "SubstepSolver, 8"]
        axes.plot(*zip(*eight), "o-", color=f"C{color}", label=pile)
    axes.axhline(1, color="k", linewidth=1, linestyle="--", label="Bullet, 10 iterations, 1 thread")
    axes.set(xscale="log", xticks=[1, 2, 4, 8, 16], xticklabels=[1, 2, 4, 8, 16], xlabel="threads", ylim=(0, 1.1),
             title="solver's time, 8 substeps; Bullet = 1")


def plot(costs: str, picture: str) -> None:
    figure, axes = plt.subplots(2, 3, figsize=(15, 8))
    plot_costs(axes[0, 0], axes[1, 2], costs)
    for axis, name, title, scale in ((axes[0, 1], "stack", "ten boxes: farthest way [m]", "log"),
                                     (axes[0, 2], "ragdoll", "ragdoll: fastest part [m/s]", "log"),
                                     (axes[1, 0], "pendulum", "pendulum: energy gained / m g l", "linear"),
                                     (axes[1, 1], "double pendulum", "double pendulum: energy gained / 2 m g l", "linear")):
        for color, (engine, points) in enumerate(series[name].items()):
            t, x = np.array(points).T
            x = np.where(np.abs(x) > 1e3, np.nan, x)
            axis.plot(t, np.maximum(x, 1e-6) if scale == "log" else x, color=f"C{color}", label=engine, linewidth=1)
        axis.set(title=title, yscale=scale, xlabel="time [s]")
    for axis in axes.flat:
        axis.legend(fontsize=8)
        axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


def main() -> None:
    global ENGINE
    scenes, costs, picture = sys.argv[1:]
    read_scenes(scenes)
    for ENGINE in INTEGRATORS:
        stack()
        masses(100, "hundredth")
        masses(1000, "thousandth")
        pile()
        pendulum()
        double_pendulum()
        chain()
        motor()
        ragdoll()
    print_table()
    plot(costs, picture)


if __name__ == "__main__":
    main()
