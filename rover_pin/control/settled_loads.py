"""Loads of wheels where a rover stands still with its driven joints as a configuration has them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

from rover_pin.errors import InputError, nearest
from rover_pin.numerics import Array
from rover_pin.statics.settle import settle

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


def settled_loads(
    rover: Rover, terrain: Terrain, *, locked: Iterable[str] = (), gravity: float = 9.81
) -> Callable[[Array], Mapping[str, float]]:
    """A function from q (nv,) to loads [N] by wheel.

    Taken from q are the base's x, y and yaw, the driven joints but wheels' drives, and the joints in
    `locked`; the statics find the rest. The function raises an InputError where the rover does not settle.

    Args:
        rover: what stands.
        terrain: on what.
        locked: passive joints that an engaged clutch holds.
        gravity: m/s2.

    Raises:
        InputError: a joint in `locked` that cannot be locked.
    """
    clutches = tuple(locked)
    for joint in clutches:
        if joint not in rover.lockable:
            raise InputError(
                "no joint that can be locked", element="locked", value=joint, cure=nearest(joint, rover.lockable)
            )
    drives = {wheel.drive for wheel in rover.wheels}
    given = [name for name in (*rover.actuated, *clutches) if name not in drives]

    def loads_at(q: Array) -> Mapping[str, float]:
        joints = {name: float(q[rover.column[name]]) for name in given}
        x, y, yaw = float(q[0]), float(q[1]), float(q[3])
        stance = settle(rover, terrain, x=x, y=y, yaw=yaw, joints=joints, gravity=gravity)
        if not stance.settled:
            raise InputError(
                f"has no loads there: {stance.status}, {stance.reason}",
                element=stance.limiting or rover.name,
                cure="do not ask for gradients of loads so near to where it does not stand",
            )
        return stance.loads

    return loads_at
