"""Groups of cases that share a design and a posture, made ready for the kernels."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.answers import blank
from rover_pin.compiled.bounds import RINGS
from rover_pin.compiled.ground import GroundArrays
from rover_pin.compiled.kernel import settle_all
from rover_pin.compiled.land import REACH
from rover_pin.compiled.machine import Machine
from rover_pin.compiled.pose import Pose, pose
from rover_pin.compiled.posed import Integers
from rover_pin.compiled.search import contact_search
from rover_pin.compiled.settle import GROUNDED, SETTLED
from rover_pin.compiled.template import Template
from rover_pin.compiled.work import work_dtype
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover


LEVEL_REACH = 3.0
"""Share of the span, or rad: held values and designs may put the rover far from where it stands as loaded."""


class Groups(NamedTuple):
    """What the kernels take of g groups.

    Attributes:
        pose: the machines, with what is held merged.
        scratch: (1,) of `work_dtype`.
        skin: (h, 4) m, points of the underside in the joints' frames, and radii.
    """

    pose: Pose
    scratch: NDArray[np.void]
    skin: Array


def as_loaded(rover: Rover, machine: Machine, template: Template, sizes: Array, reach: float) -> Groups:
    """One group: the rover as loaded in a posture, on the plain path's own level stance.

    Args:
        rover: the rover.
        machine: its arrays, one design.
        template: the posture.
        sizes: (r,) m, sorted sizes of shapes that the ground's bounds are for.
        reach: m, within which the ground's bounds look at outlines.
    """
    made = pose(rover, machine, template.problem, template.held, template.values[None])
    return _ready(made, template, sizes, reach, same=True)


def varied(
    rover: Rover, machine: Machine, template: Template, values: Array, sizes: Array, reach: float,
    flat: GroundArrays,
) -> Groups:  # fmt: skip
    """A group a case: held values or designs of their own, each settled on level ground first.

    Args:
        rover: the rover as loaded.
        machine: one design, or one a group.
        template: the posture as loaded, where Newton starts from.
        values: (g, nv) configuration where it is held.
        sizes: as for `as_loaded`.
        reach: likewise.
        flat: level ground.
    """
    made = pose(rover, machine, template.problem, template.held, values)
    groups = _ready(made, template, sizes, reach, same=len(machine.translations) == 1)
    held = [rover.column[joint] for joint in template.held]
    within = (values[:, held] >= machine.lower[:, held]) & (values[:, held] <= machine.upper[:, held])
    records = groups.pose.records
    records["usable"] &= np.all(within, axis=1)
    count = len(values)
    records["reach"] = LEVEL_REACH
    out = blank(rover, count, False, int(records["n_free"][0]))
    nowhere = np.zeros(count)
    settle_all(
        records, groups.scratch, *flat, groups.skin, contact_search(), np.arange(count), nowhere, nowhere,
        nowhere, out,
    )  # fmt: skip
    records["usable"] &= (out.code == SETTLED) | (out.code == GROUNDED)
    records["start"][:, : out.z.shape[1]] = out.z
    records["reach"] = REACH
    return groups


def filled(machine: Machine, valid: NDArray[np.bool_], spare: Machine) -> Machine:
    """Designs whose invalid rows are those of `spare`, so that no arithmetic meets NaN; they are not used."""
    if np.all(valid):
        return machine
    wide = [name for name in Machine._fields if getattr(spare, name).dtype == np.float64]
    mended = {name: getattr(machine, name).copy() for name in wide}
    for name, values in mended.items():
        values[~valid] = getattr(spare, name)
    return machine._replace(**mended)


def _ready(made: Pose, template: Template, sizes: Array, reach: float, *, same: bool) -> Groups:
    """Supports, reaches and underside written into the machines.

    Args:
        made: the machines.
        template: their posture.
        sizes: (r,) m.
        reach: m.
        same: whether all are of one design, whose underside the template knows.
    """
    records = made.records
    template.support(records)
    shapes = int(records["n_shapes"][0])
    whole = records["rings"][:, :shapes] + records["treads"][:, :shapes]
    # any size will do: bounds that do not reach far enough are not used
    records["reach_of"][:, :shapes] = RINGS * np.minimum(np.searchsorted(sizes, whole), len(sizes) - 1)
    corners = int(records["n_outline"][0])
    away = outline_radii(records["outline_bodies"][0, :corners], records["outline"][:, :corners])
    records["outline_fits"] = np.all(away <= reach, axis=1)
    records["usable"] = made.consistent
    records["reach"] = REACH
    skin = np.zeros((0, 4))
    if same:
        below = template.problem.underside
        records["skin_known"] = 1
        records["n_skin"] = len(below.groups)
        skin = np.zeros((len(below.links), 4))
        first = 0
        for k, (joint, points) in enumerate(below.groups):
            placed = made.placed[joint]
            records["skin_bodies"][:, k] = placed.body
            records["skin_rotations"][:, k], records["skin_origins"][:, k] = placed.rotation, placed.origin
            skin[first : first + len(points), :3] = points
            first += len(points)
            records["skin_starts"][:, k + 1] = first
        skin[:, 3] = below.radii
    tier = records.dtype["parents"].shape[0]
    return Groups(made, np.zeros(1, dtype=work_dtype(tier)), skin)


def outline_radii(owners: Integers, outline: Array) -> Array:
    """(g, o) m: distance of each corner of the outlines from the middle of its owner's corners."""
    away = np.zeros(outline.shape[:2])
    for owner in np.unique(owners):
        mine = np.flatnonzero(owners == owner)
        middle = np.mean(outline[:, mine], axis=1, keepdims=True)
        away[:, mine] = np.sqrt(np.sum((outline[:, mine] - middle) ** 2, axis=-1))
    return away
