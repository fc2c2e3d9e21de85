"""Stances and equilibria made by hand: rigid bodies on contacts, with bogies where asked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from rover_pin.statics.friction_problem import FrictionProblem, make_problem
from rover_pin.statics.stance import Contact, Stance, Status

SIX = ("fl", "fr", "ml", "mr", "rl", "rr")
HEXAGON = np.array([[x, y, 0.0] for x in (1.0, 0.0, -1.0) for y in (0.5, -0.5)])
UP = np.array([0.0, 0.0, 1.0])


@dataclass
class Rows:
    """A balance made by hand."""

    gravity: np.ndarray
    contact: np.ndarray
    internal: np.ndarray
    internal_lower: np.ndarray
    lean: np.ndarray = None
    torque: np.ndarray = None


def turn(axis: int, angle: float) -> np.ndarray:
    """Rotation about a coordinate axis."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i], R[i, j], R[j, i], R[j, j] = c, -s, s, c
    return R


def contacts_at(
    points: Any,
    normals: Any = None,
    *,
    wheels: Sequence[str] = SIX,
    loads: Any = None,
    heading: Any = (1.0, 0.0, 0.0),
    friction: Any = 0.6,
    radius: float = 0.1,
    free: Sequence[str] = (),
) -> list[Contact]:
    """Contacts with one heading; loads default to equal ones of 1 N."""
    points = np.asarray(points, dtype=float)
    normals = np.broadcast_to(UP if normals is None else np.asarray(normals, dtype=float), points.shape)
    loads = np.ones(len(points)) if loads is None else np.asarray(loads)
    frictions = np.broadcast_to(np.asarray(friction, dtype=float), len(points))
    out = []
    for name, p, n, load, mu in zip(wheels, points, normals, loads, frictions, strict=True):
        n = n / np.linalg.norm(n)
        r = np.asarray(heading, dtype=float) - np.dot(heading, n) * n
        rolling = r / np.linalg.norm(r) if np.linalg.norm(r) > 0 else r
        out.append(
            Contact(name, 1, np.array(p), n, rolling, radius, 0.0, float(load), float(mu), name in free)
        )
    return out


def rigid_rows(points: Any, com: Any, weight: float) -> Rows:
    """Force and moment about the origin: the six rows of one body."""
    contact = np.hstack([np.vstack([np.eye(3), _cross(p)]) for p in np.asarray(points, dtype=float)])
    gravity = np.r_[0.0, 0.0, weight, np.cross(com, [0.0, 0.0, weight])]
    lean = np.column_stack([np.r_[np.zeros(3), np.cross(e, [0.0, 0.0, weight])] for e in np.eye(3)[:2]])
    return Rows(gravity, contact, np.zeros((6, 0)), np.zeros(0), lean, np.zeros((6, 0)))


def _cross(p: np.ndarray) -> np.ndarray:
    return np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])


def with_pivot(rows: Rows, points: Any, members: Sequence[int], pivot: Any, axis: Any = (0, 1, 0)) -> Rows:
    """The rows with one more: no moment about a passive joint of a massless arm that carries `members`."""
    points = np.asarray(points, dtype=float)
    extra = np.zeros(rows.contact.shape[1])
    for i in members:
        extra[3 * i : 3 * i + 3] = np.cross(axis, points[i] - np.asarray(pivot, dtype=float))
    return Rows(
        np.append(rows.gravity, 0.0),
        np.vstack([rows.contact, extra]),
        np.vstack([rows.internal, np.zeros((1, rows.internal.shape[1]))]),
        rows.internal_lower,
        np.vstack([rows.lean, np.zeros((1, 2))]),
        np.zeros((len(rows.gravity) + 1, 0)),
    )


def vertical_loads(rows: Rows) -> np.ndarray:
    """Loads of least squares with every force vertical."""
    return np.asarray(np.linalg.lstsq(rows.contact[:, 2::3], rows.gravity, rcond=None)[0])


def rigid(
    points: Any, normals: Any, com: Any, weight: float = 500.0, mu: float | None = 0.6, **options: Any
) -> FrictionProblem:
    """A rigid rover on contacts."""
    rows = rigid_rows(points, com, weight)
    contacts = contacts_at(points, normals, loads=vertical_loads(rows), **options)
    return make_problem(contacts, rows, weight, mu, frozenset(c.wheel for c in contacts if not c.free))


def on_slope(alpha: float, com: Any = (0.1, 0.05, 0.1), **options: Any) -> FrictionProblem:
    """Six wheels on a plane that rises by alpha along x; `com` is given before the tilt."""
    R = turn(1, -alpha)
    return rigid(HEXAGON @ R.T, np.tile(R @ UP, (6, 1)), R @ np.asarray(com), **options)


def rough(seed: int, slant: float = 0.25, com: Any = (0.1, 0.05, 0.4), **options: Any) -> FrictionProblem:
    """Six wheels on rough ground: points and normals off by chance."""
    rng = np.random.default_rng(seed)
    points = HEXAGON + rng.normal(size=(6, 3)) * 0.05
    normals = UP + rng.normal(size=(6, 3)) * slant
    return rigid(points, normals / np.linalg.norm(normals, axis=1)[:, None], com, **options)


def stance_of(
    contacts: Sequence[Contact],
    com: Any,
    weight: float = 500.0,
    *,
    status: Status = Status.SETTLED,
    reason: str = "",
    belly: Any = (),
    auxiliary: Sequence[str] = (),
) -> Stance:
    """A stance with these contacts."""
    loads: dict[str, float] = {}
    for c in contacts:
        loads[c.wheel] = loads.get(c.wheel, 0.0) + c.load
    wheels = tuple(
        SimpleNamespace(
            name=name,
            drive=f"drive_{name}",
            free=any(c.free for c in contacts if c.wheel == name),
            auxiliary=name in auxiliary,
        )
        for name in loads
    )
    bearing = tuple(i for i, wheel in enumerate(wheels) if not wheel.auxiliary)
    rover: Any = SimpleNamespace(
        name="hand_made",
        mass=weight / 9.81,
        wheels=wheels,
        bearing=bearing,
        belly=belly,
        actuated=(),
        loops=(),
        effort=np.zeros(0),
        column={},
    )
    terrain: Any = SimpleNamespace(label="nowhere")
    return Stance(
        rover=rover,
        terrain=terrain,
        status=status,
        reason=reason,
        limiting=None,
        position=np.zeros(3),
        rpy=np.zeros(3),
        joints={},
        contacts=tuple(contacts),
        loads=loads,
        gaps={},
        com=np.asarray(com, dtype=float),
        gravity=9.81,
        configuration=np.zeros(6),
    )
