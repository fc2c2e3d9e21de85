"""The kinematic model of a rover that rolls: what follows from some of its rates, either way.

Forward: drives, steering and rockers are known, the base follows. Inverse: the base's motion and lift are
known, drives and rockers follow. Both are the same rows with other columns known: couplings, loops, clutches,
and no sliding where wheels stand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError, MechanismError, nearest
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.limits import Clutch, ContactKept, CouplingsKept, LoopsClosed
from rover_pin.kinematics.rolling import DIRECTIONS
from rover_pin.kinematics.rows import Limit, number
from rover_pin.kinematics.tasks.base_twist import ANGULAR, LINEAR, twist_row
from rover_pin.kinematics.tasks.clearance import clearance_row
from rover_pin.numerics import RANK, Array, frozen

BODY = (*LINEAR, *ANGULAR, "clearance")
"""Rates besides coordinates: of the root link along its heading, of its angles, of the belly's clearance."""


@dataclass(frozen=True)
class Motion:
    """A velocity that agrees with known rates.

    Attributes:
        velocity: (nv,) dq/dt, columns named by `Rover.dof_names`.
        sliding: the largest speed that no velocity could take away [m/s or rad/s]: 0 where rates agree.
        where: the row of that.
        undetermined: coordinates that the known rates leave open; they have the least rates.
    """

    velocity: Array
    sliding: float
    where: str
    undetermined: tuple[str, ...]


def structure(
    at: Instant,
    lifted: Sequence[str] = (),
    clutches: Mapping[str, float] | None = None,
    directions: Sequence[str] = DIRECTIONS,
) -> tuple[tuple[str, ...], Array]:
    """Names (m,) and rows (m, nv) of what holds: couplings, loops, clutches, contacts in `directions`.

    Raises:
        InputError: a wheel or clutch that the rover does not have.
    """
    levels = _levels(at, lifted, clutches, directions)
    return tuple(name for names, _ in levels for name in names), np.vstack([rows for _, rows in levels])


def _levels(
    at: Instant, lifted: Sequence[str], clutches: Mapping[str, float] | None, directions: Sequence[str]
) -> list[tuple[tuple[str, ...], Array]]:
    """Names and rows of what holds, what gives way last first: mechanism, contacts, sliding."""
    levels: list[list[Limit]] = [[CouplingsKept(), LoopsClosed(), Clutch(dict(clutches or {}))]]
    for on_ground in (True, False):
        words = tuple(word for word in directions if (word == "normal") is on_ground)
        levels.append([ContactKept(tuple(lifted), words)] if words else [])
    found = []
    for limits in levels:
        blocks = [block for limit in limits if (block := limit.rows(at, 1.0)).names]
        if blocks:
            names = tuple(name for block in blocks for name in block.names)
            found.append((names, np.vstack([block.matrix for block in blocks])))
    return found or [((), np.zeros((0, at.rover.model.nv)))]


def complete(
    at: Instant,
    known: Mapping[str, float],
    *,
    lifted: Sequence[str] = (),
    clutches: Mapping[str, float] | None = None,
    directions: Sequence[str] = DIRECTIONS,
) -> Motion:
    """The velocity that has the known rates, and slides least where they do not agree.

    Known rates come first, then couplings, loops and clutches, then that wheels neither leave the ground nor
    enter it, then that they do not slide; each as near as what comes before lets it, by least squares.

    Args:
        at: the instant.
        known: rates by name: `Rover.dof_names` [m/s or rad/s], or of BODY: `forward`, `left`, `up` of the
            root link along its heading, `clearance` of the belly [m/s], `yaw`, `pitch`, `roll` [rad/s].
        lifted: wheels that do not stand.
        clutches: passive joints that are held, at their values.
        directions: of the contacts' rows that count; `normal` alone lets wheels slide.

    Raises:
        InputError: an unknown name, or a rate that is no finite number.
        MechanismError: known rates that contradict one another by themselves.
    """
    levels = _levels(at, lifted, clutches, directions)
    velocity, rest = _null(*_known_rows(at, known))
    for _, rows in levels:
        velocity, rest = _nearer(rows, velocity, rest)
    loose = np.flatnonzero(np.linalg.norm(rest, axis=1) > 1e-6)
    undetermined = tuple(at.rover.dof_names[i] for i in loose)
    missed = {
        name: abs(rate) for names, rows in levels for name, rate in zip(names, rows @ velocity, strict=True)
    }
    worst = max(missed, key=lambda name: missed[name], default="")
    return Motion(frozen(velocity), float(missed.get(worst, 0.0)), worst, undetermined)


def forward(
    at: Instant,
    rates: Mapping[str, float],
    *,
    lifted: Sequence[str] = (),
    clutches: Mapping[str, float] | None = None,
) -> Motion:
    """The rover's motion from the rates of its driven joints; those not named stand still.

    Args:
        at: the instant.
        rates: of driven joints [rad/s or m/s].
        lifted: wheels that do not stand.
        clutches: passive joints that are held, at their values.

    Raises:
        InputError: a name that is no driven joint, or a rate that is no finite number.
    """
    for name in rates:
        if name not in at.rover.actuated:
            raise InputError("is no driven joint", element=name, cure=nearest(name, at.rover.actuated))
    return complete(at, dict.fromkeys(at.rover.actuated, 0.0) | dict(rates), lifted=lifted, clutches=clutches)


def _known_rows(at: Instant, known: Mapping[str, float]) -> tuple[Array, Array]:
    rows, sides = [], []
    known_names = [*BODY, *at.rover.column]
    for name, value in known.items():
        number(name, value, "give a rate in m/s or rad/s")
        if name == "clearance":
            row = clearance_row(at)
        elif name in BODY:
            row = twist_row(at, name)
        elif name in at.rover.column:
            row = np.zeros(at.rover.model.nv)
            row[at.rover.column[name]] = 1.0
        else:
            raise InputError("no rate of that name", element=name, cure=nearest(name, known_names))
        rows.append(row)
        sides.append(value)
    return np.array(rows).reshape(-1, at.rover.model.nv), np.array(sides)


def _null(rows: Array, sides: Array) -> tuple[Array, Array]:
    """A velocity with rows v = sides, and a basis of what may be added to it."""
    nv = rows.shape[1]
    if not len(rows):
        return np.zeros(nv), np.eye(nv)
    left, values, right = np.linalg.svd(rows, full_matrices=True)
    rank = int(np.count_nonzero(values > RANK * float(values[0])))
    held = right[:rank].T @ ((left[:, :rank].T @ sides) / values[:rank])
    if float(np.max(np.abs(rows @ held - sides))) > 1e-9 * max(1.0, float(np.max(np.abs(sides)))):
        raise MechanismError(
            "known rates contradict one another", element="known", cure="leave some of them out"
        )
    return held, right[rank:].T


def _nearer(rows: Array, velocity: Array, rest: Array) -> tuple[Array, Array]:
    """The velocity moved within `rest` (nv, f) to the least |rows v|, and a basis of what stays free."""
    if not (rest.shape[1] and len(rows)):
        return velocity, rest
    left, values, right = np.linalg.svd(rows @ rest, full_matrices=True)
    rank = int(np.count_nonzero(values > RANK * float(np.linalg.norm(rows))))
    push = left[:, :rank].T @ (-rows @ velocity)
    return velocity + rest @ (right[:rank].T @ (push / values[:rank])), rest @ right[rank:].T
