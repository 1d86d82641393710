"""What is measured in a recording, the same for all engines. Each takes the recording and what the truth says besides."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from .recording import GRAVITY, Recording


def height(r: Recording, body: str, above: str | None = None, time: float | None = None) -> float:
    """Of the mesh's origin at the end, or at a time, over z = 0 or over that of another body [m]."""
    step = r.steps if time is None else r.step_at(time)
    low = r.mesh_position(r.index(above))[step, 2] if above else 0
    return r.mesh_position(r.index(body))[step, 2] - low


def way_down(r: Recording, body: str, time: float | None = None) -> float:
    """From the start to the end, or to a time [m]."""
    step = r.steps if time is None else r.step_at(time)
    z = r.position[:, r.index(body), 2]
    return z[0] - z[step]


def off_axis(r: Recording, body: str) -> float:
    """Distance of the centre of mass from the z axis at the end [m]."""
    return math.hypot(*r.position[-1, r.index(body), :2])


def farthest(r: Recording, bodies: str | None = None, since: float = 0) -> float:
    """The farthest that a centre of mass ever came from where it was then [m]."""
    indices, a = r.all_of(bodies), r.step_at(since)
    return float(np.linalg.norm(r.position[a:, indices] - r.position[a, indices], axis=2).max())


def sideways(r: Recording, body: str, since: float) -> float:
    """The farthest along x or y that a centre of mass came from where it was then [m]."""
    x = r.position[r.step_at(since):, r.index(body), :2]
    return float(np.abs(x - x[0]).max())


def largest_turn(r: Recording, bodies: str | None = None, since: float = 0) -> float:
    """The largest angle between a rotation then and at the end [rad]."""
    return max(r.turn(i, r.step_at(since), r.steps) for i in r.all_of(bodies))


def screw_acceleration(r: Recording, body: str, pitch: float, radius: float, flank: float, since: float) -> float:
    """Acceleration down a thread, over that of the law of the screw; `radius` is the thread's mean, `flank` half the
    angle between its flanks [degrees].

    The flank presses with N, square to a face of slope a = atan(p / 2 pi r) whose normal leans outwards: along the helix
    acts the friction f N, so that m z'' = m g - N (cos a cos b + f sin a), I k z'' = r N (sin a cos b - f cos a),
    k = 2 pi / p, tan b = tan(flank) cos a.
    """
    index = r.index(body)
    mass, inertia = r.scene["bodies"][index]["mass"], r.scene["bodies"][index]["inertia"][2]
    friction, k = r.scene["friction"], 2 * math.pi / pitch
    slope = math.atan(pitch / (2 * math.pi * radius))
    normal = math.cos(math.atan(math.tan(math.radians(flank)) * math.cos(slope)))
    across = math.cos(slope) * normal + friction * math.sin(slope)
    along = math.sin(slope) * normal - friction * math.cos(slope)
    law = GRAVITY / (1 + k * inertia / (mass * radius) * across / along)
    step = r.step_at(since)
    velocity = np.diff(r.position[:, index, 2]) / r.dt
    return float((velocity[step] - velocity[-1]) / ((r.steps - 1 - step) * r.dt) / law)


def turn_over_way(r: Recording, body: str) -> float:
    """The angle about z over the way down [rad/m]."""
    index = r.index(body)
    way = r.position[-1, index, 2] - r.position[0, index, 2]
    turned = r.spin(index)[:, 2].sum() * r.dt
    return float(turned / way) if abs(way) > 1e-4 else 0.0


def spin_z(r: Recording, body: str, since: float) -> float:
    """The mean angular velocity about z [rad/s]."""
    return float(r.spin(r.index(body))[r.step_at(since):, 2].mean())


def spin_ratio(r: Recording, body: str, other: str, since: float) -> float:
    driving = spin_z(r, other, since)
    return spin_z(r, body, since) / driving if abs(driving) > 1e-6 else 0.0


def _to_circle(points: np.ndarray, radius: float) -> np.ndarray:
    """Distances of points to the circle about z through the origin's plane."""
    return np.hypot(points[..., 2], np.hypot(points[..., 0], points[..., 1]) - radius)


def ring_overlap(r: Recording, ring: float, tube: float) -> float:
    """The deepest overlap of tubes of consecutive rings at any step [m]; their axis is z, and there is nothing else."""
    angles = np.linspace(0, 2 * math.pi, 720, endpoint=False)
    circle = ring * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    nearest = math.inf
    for a, b in zip(range(len(r.names)), range(1, len(r.names))):
        between = r.rotations(b).inv()
        matrices = (between * r.rotations(a)).as_matrix()
        shift = between.apply(r.position[:, a] - r.position[:, b])
        for step in range(0, r.steps + 1, max(1, r.steps // 600)):
            nearest = min(nearest, _to_circle(circle @ matrices[step].T + shift[step], ring).min())
    return 2 * tube - nearest


def _swing(r: Recording, body: str) -> np.ndarray:
    x = r.position[:, r.index(body)]
    return np.arctan2(x[:, 0], -x[:, 2])


def period(r: Recording, body: str) -> float:
    """Of the swing of a centre of mass about the y axis, by its passages through the lowest place [s]; 0 if there are few."""
    angle = _swing(r, body)
    i = np.flatnonzero((angle[1:] < 0) != (angle[:-1] < 0))
    if len(i) < 3:
        return 0.0
    passages = (i + angle[i] / (angle[i] - angle[i + 1])) * r.dt
    return float(2 * (passages[-1] - passages[0]) / (len(i) - 1))


def amplitude_left(r: Recording, body: str, time: float, swing: float) -> float:
    """The largest angle in the half period before a time, over that at the start."""
    angle = np.abs(_swing(r, body))
    return float(angle[r.step_at(time - swing / 2): r.step_at(time) + 1].max() / angle[0])


def load_borne(r: Recording, body: str, hold: float, lip: float, loads: int) -> float:
    """The last of the weights 1, 2, 4, ..., each for `hold` seconds, under which it has not come down by `lip`."""
    z = r.position[:, r.index(body), 2]
    borne = 0
    for load in range(loads):
        if z[0] - z[r.step_at((load + 1) * hold)] >= lip:
            break
        borne = 2**load
    return borne


def slip(r: Recording, body: str, holder: str, since: float) -> float:
    """How far a body sank against what holds it since then [m]."""
    z = r.position[:, r.index(body), 2] - r.position[:, r.index(holder), 2]
    return float(abs(z[-1] - z[r.step_at(since)]))


def motion_at_the_end(r: Recording, bodies: str | None = None) -> float:
    """The largest way in the last half second over the body's size; a turn counts as half its angle."""
    a, most = r.step_at(r.seconds - 0.5), 0.0
    for i in r.all_of(bodies):
        way = np.linalg.norm(r.position[-1, i] - r.position[a, i]) / r.scene["bodies"][i]["size"]
        most = max(most, float(way) + r.turn(i, a, r.steps) / 2)
    return most


def below_ground(r: Recording, bodies: str | None = None, ground: float = 0) -> float:
    """How deep the lowest vertex of any body is under a height at the end, over the body's size."""
    import trimesh

    deepest = 0.0
    for i in r.all_of(bodies):
        body = r.scene["bodies"][i]
        vertices = np.asarray(trimesh.load(body["mesh"], process=False).vertices)
        low = (r.rotations(i)[r.steps].apply(vertices) + r.position[-1, i])[:, 2].min()
        deepest = max(deepest, float(ground - low) / body["size"])
    return deepest


def energy_gained(r: Recording) -> float:
    """All increments of the total energy, over that of all moving bodies falling by the scene's `fall`."""
    increments = np.diff(r.energy())
    mass = sum(body["mass"] for body in r.scene["bodies"])
    return float(increments[increments > 0].sum() / (mass * GRAVITY * r.scene["fall"]))


def measure(truth: dict, recording: Recording) -> float:
    """What the truth is about."""
    known = {f.__name__: f for f in (height, way_down, off_axis, farthest, sideways, largest_turn, screw_acceleration,
                                     turn_over_way, spin_z, spin_ratio, ring_overlap, period, amplitude_left, load_borne, slip,
                                     motion_at_the_end, below_ground)}
    said = {"quantity", "expected", "tolerance", "at_most", "source", "unit"}
    return float(known[truth["quantity"]](recording, **{k: v for k, v in truth.items() if k not in said}))


def holds(truth: dict, measured: float) -> bool:
    if "at_most" in truth:
        return measured <= truth["at_most"]
    return abs(measured - truth["expected"]) <= truth["tolerance"]
