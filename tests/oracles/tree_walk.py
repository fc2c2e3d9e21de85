"""A rover read anew: its tree from the URDF text, its mechanism from the sidecar, walked in plain numpy.

Shares no code with the package: the URDF is read by xml.etree, rover.yaml by PyYAML, and positions come from
4 x 4 matrices along the tree. Derivatives are taken by the complex step, exact to rounding, so no formula for
a Jacobian is needed.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np
import yaml

STEP = 1e-30
BASE = ("base_z", "base_pitch", "base_roll")


@dataclass
class Disc:
    """A wheel in its own link's frame."""

    name: str
    link: str
    center: np.ndarray
    axis: np.ndarray
    ring: float
    tread: float


@dataclass
class Branch:
    """A joint of the URDF."""

    name: str
    sliding: bool
    fixed: bool
    parent: str
    child: str
    origin: np.ndarray
    axis: np.ndarray
    limits: tuple[float, float] = (-np.inf, np.inf)


@dataclass
class Machine:
    """A rover as the oracles know it.

    q of a stance is a dict by joint name; free coordinates are `base_z, base_pitch, base_roll` and the joints
    that are neither driven nor held.
    """

    root: str
    masses: list[tuple[str, float, np.ndarray]]
    branches: list[Branch]
    discs: list[Disc]
    couplings: list[tuple[dict[str, float], float]]
    springs: list[dict]
    balls: list[tuple[dict, dict]]
    driven: set[str]  # and the wheels' own joints: braked

    @property
    def mass(self) -> float:
        return sum(m for _, m, _ in self.masses)

    def free(self, held=()) -> list[str]:
        """Names of the free coordinates, springs and couplings still to be minded."""
        moving = [b.name for b in self.branches if not b.fixed]
        return [*BASE, *(name for name in moving if name not in self.driven and name not in held)]

    def walk(self, place, names, q, fixed) -> dict[str, np.ndarray]:
        """Link -> (B, 4, 4) poses for B rows of q (B, n) of the coordinates `names`.

        `place` is x, y, yaw of the base; `fixed` has the other joints' values, 0 where silent.
        """
        columns = {name: q[:, i] for i, name in enumerate(names)}
        rows, kind = len(q), q.dtype
        x, y, yaw = place
        pose = np.zeros((rows, 4, 4), kind)
        turn = (
            _about_z(np.full(rows, yaw, kind))
            @ _about_y(columns["base_pitch"])
            @ _about_x(columns["base_roll"])
        )
        pose[:, :3, :3] = turn
        pose[:, 0, 3], pose[:, 1, 3], pose[:, 2, 3] = x, y, columns["base_z"]
        pose[:, 3, 3] = 1.0
        found = {self.root: pose}
        for b in self.branches:
            here = found[b.parent] @ b.origin
            if not b.fixed:
                value = columns.get(b.name)
                if value is None:
                    angle = fixed.get(b.name, 0.0)
                    here = here @ _moved(b, np.array([angle])) if angle else here
                else:
                    here = here @ _moved(b, value)
            found[b.child] = here
        return found

    def potential(self, poses, names, q, gravity) -> np.ndarray:
        """(B,) energy of gravity and springs [J]."""
        total = 0.0
        for link, m, com in self.masses:
            total = total + m * gravity * (poses[link][:, 2, :3] @ com + poses[link][:, 2, 3])
        for s in self.springs:
            if "frames" in s:
                short = s["length_max"] - self.length(poses, s)
                total = total + s["preload"] * short + 0.5 * s["stiffness"] * short * short
                continue
            away = q[:, names.index(s["joint"])] - s.get("rest", 0.0)
            total = total + 0.5 * s["stiffness"] * away * away - s.get("preload", 0.0) * away
        return total

    def length(self, poses, spring) -> np.ndarray:
        """(B,) of a spring between frames [m]."""
        first, second = (_spot(poses, _end(end)) for end in spring["frames"])
        return np.sqrt(np.sum((first - second) ** 2, axis=1))

    def coupling_rows(self, names, fixed) -> tuple[np.ndarray, np.ndarray]:
        """A q = b of the couplings with a free joint."""
        rows, right = [], []
        for joints, offset in self.couplings:
            row = np.array([joints.get(name, 0.0) for name in names])
            if np.any(row):
                rows.append(row)
                right.append(offset - sum(c * fixed.get(j, 0.0) for j, c in joints.items() if j not in names))
        return np.array(rows).reshape(-1, len(names)), np.array(right)

    def ball_gaps(self, poses) -> np.ndarray:
        """(B, 3 l) world vectors between the ends of the ball loops."""
        ends = [[_spot(poses, end) for end in pair] for pair in self.balls]
        rows = len(next(iter(poses.values())))
        return np.concatenate([a - b for a, b in ends], axis=1) if ends else np.zeros((rows, 0))


def machine(rover, springs=None) -> Machine:
    """Read a rover's texts again.

    Args:
        rover: for its URDF text and its files' places.
        springs: joint springs instead of the sidecar's.
    """
    sidecar = yaml.safe_load(rover.sidecar_path.read_text())
    top = ET.fromstring(rover.urdf)
    masses = []
    for link in top.iter("link"):
        inertial = link.find("inertial")
        if inertial is not None:
            com = _numbers(inertial.find("origin"), "xyz")
            masses.append((link.get("name"), float(inertial.find("mass").get("value")), com))
    branches = [_branch(e) for e in top.findall("joint")]
    for b in branches:
        if not b.fixed:  # the text is without limits: they are the rover's own
            b.limits = tuple(float(bound[rover.column[b.name]]) for bound in (rover.lower, rover.upper))
    children = {b.child for b in branches}
    root = next(e.get("name") for e in top.findall("link") if e.get("name") not in children)
    ordered, reached = [], {root}
    while len(ordered) < len(branches):
        for b in branches:
            if b.parent in reached and b.child not in reached:
                ordered.append(b)
                reached.add(b.child)
    above = {b.child: b for b in ordered}
    discs = [_disc(w, above) for w in sidecar["wheels"]]
    couplings = [(dict(c["joints"]), float(c.get("offset", 0.0))) for c in sidecar.get("couplings", ())]
    couplings += [(dict(c.joints), c.offset) for c in rover.couplings if c.name.startswith("mimic_")]
    balls = [tuple(map(_end, loop["frames"])) for loop in sidecar.get("loops", ()) if loop["type"] == "ball"]
    assert len(balls) == len(sidecar.get("loops", ())), "only ball loops here"
    given = sidecar.get("springs", []) if springs is None else springs
    braked = {above[d.link].name for d in discs if abs(above[d.link].axis @ d.axis) > 0.999}
    return Machine(root, masses, ordered, discs, couplings, list(given), balls, set(rover.actuated) | braked)


def _branch(e) -> Branch:
    origin = e.find("origin")
    axis = e.find("axis")
    along = _numbers(axis, "xyz") if axis is not None else np.array([1.0, 0.0, 0.0])
    kind = e.get("type")
    place = np.eye(4)
    r, p, y = _numbers(origin, "rpy")
    place[:3, :3] = (_about_z(np.array([y])) @ _about_y(np.array([p])) @ _about_x(np.array([r])))[0]
    place[:3, 3] = _numbers(origin, "xyz")
    return Branch(
        e.get("name"), kind == "prismatic", kind == "fixed", e.find("parent").get("link"),
        e.find("child").get("link"), place, along / (np.linalg.norm(along) or 1.0),
    )  # fmt: skip


def _disc(w, above) -> Disc:
    axis = w.get("axis")
    if axis is None:
        joint = above[w["frame"]]
        axis = joint.axis
    tread = w.get("tread", min(w["radius"], w["width"] / 2))
    axis = np.asarray(axis, float)
    center = np.asarray(w.get("center", (0.0, 0.0, 0.0)), float)
    return Disc(w["name"], w["frame"], center, axis / np.linalg.norm(axis), w["radius"] - tread, tread)


def _end(frame) -> dict:
    return {"link": frame, "xyz": (0.0, 0.0, 0.0)} if isinstance(frame, str) else frame


def _spot(poses, end) -> np.ndarray:
    pose = poses[end["link"]]
    return pose[:, :3, :3] @ np.asarray(end.get("xyz", (0.0, 0.0, 0.0)), float) + pose[:, :3, 3]


def _numbers(e, key) -> np.ndarray:
    text = e.get(key) if e is not None else None
    return np.array([float(v) for v in text.split()]) if text else np.zeros(3)


def _moved(b: Branch, value) -> np.ndarray:
    """(B, 4, 4) of a joint at `value` (B,); rotation by Rodrigues' formula."""
    out = np.zeros((len(value), 4, 4), value.dtype)
    out[:, 3, 3] = 1.0
    if b.sliding:
        out[:, :3, :3] = np.eye(3)
        out[:, :3, 3] = value[:, None] * b.axis
        return out
    x, y, z = b.axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    out[:, :3, :3] = np.eye(3) + np.sin(value)[:, None, None] * cross
    out[:, :3, :3] += (1.0 - np.cos(value))[:, None, None] * (cross @ cross)
    return out


def _turn(i, j, angle) -> np.ndarray:
    out = np.zeros((len(angle), 3, 3), angle.dtype)
    out[:, range(3), range(3)] = 1.0
    c, s = np.cos(angle), np.sin(angle)
    out[:, i, i], out[:, i, j], out[:, j, i], out[:, j, j] = c, -s, s, c
    return out


def _about_x(angle) -> np.ndarray:
    return _turn(1, 2, angle)


def _about_y(angle) -> np.ndarray:
    return _turn(2, 0, angle)


def _about_z(angle) -> np.ndarray:
    return _turn(0, 1, angle)
