"""The weight's and the contacts' part of the stiffness: dead loads whose points move with the rover."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.contact.slide import slide
from rover_pin.mechanism.bending import add_dead_force, bend_dead_forces, bend_sliding_load
from rover_pin.numerics import Array, formula

Integers = NDArray[np.int64]


@formula
def bend_loads(
    parent: Integers, turn: Array, move: Array, ref: Array, body_columns: Integers, rotations: Array,
    origins: Array, masses: Array, levers: Array, gravity: float, out: Array, kind: int, table: Array,
    params: Array, carriers: Integers, centers: Array, axes: Array, rings: Array, points: Array, loads: Array,
) -> None:  # fmt: skip
    """Take the derivative of the generalised forces of weight and loads off `out` (m, m).

    Args:
        parent: (m,) the tree, see `rover_pin.mechanism.columns`.
        turn: (m, 3) likewise.
        move: (m, 3) likewise.
        ref: (3,) likewise.
        body_columns: (b,) columns of bodies with a mass.
        rotations: (b, 3, 3) of their joints' frames, world.
        origins: (b, 3) m, world.
        masses: (b,) kg.
        levers: (b, 3) m, centres of mass in the joints' frames.
        gravity: m/s2.
        out: (m, m).
        kind: of the ground's surface, smooth at the contacts.
        table: its table.
        params: its parameters.
        carriers: (c,) columns of the contacts' bodies.
        centers: (c, 3) m, the shapes' centres, world.
        axes: (c, 3) their axes.
        rings: (c,) m.
        points: (c, 3) m, contacts.
        loads: (c,) N, upwards.
    """
    count = parent.shape[0]
    pull, spread = np.zeros((count, 3)), np.zeros((count, 3, 3))
    for b in range(body_columns.shape[0]):
        r, o = rotations[b], origins[b]
        u, v, w = levers[b, 0], levers[b, 1], levers[b, 2]
        x = o[0] + r[0, 0] * u + r[0, 1] * v + r[0, 2] * w
        y = o[1] + r[1, 0] * u + r[1, 1] * v + r[1, 2] * w
        z = o[2] + r[2, 0] * u + r[2, 1] * v + r[2, 2] * w
        add_dead_force(ref, body_columns[b], x, y, z, 0.0, 0.0, -masses[b] * gravity, pull, spread)
    sliding = np.empty((2, 6))
    for i in range(carriers.shape[0]):
        load, p = loads[i], points[i]
        if load == 0.0:
            continue
        add_dead_force(ref, carriers[i], p[0], p[1], p[2], 0.0, 0.0, load, pull, spread)
        c, a = centers[i], axes[i]
        slide(kind, table, params, c[0], c[1], c[2], a[0], a[1], a[2], rings[i], p[0], p[1], sliding)
        bend_sliding_load(parent, turn, move, ref, carriers[i], load, sliding, c, a, p, out)
    bend_dead_forces(parent, turn, move, pull, spread, out)
