"""From a traced description to the machines of many designs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rover_pin.compiled.design_bodies import outline, weigh
from rover_pin.compiled.design_couplings import Coupled, coupling_rows, read_couplings
from rover_pin.compiled.design_parts import belly, loops, struts, touching, wheel_links
from rover_pin.compiled.design_plan import Plan, Reader
from rover_pin.compiled.design_rows import Flags, Sheet, Stated, refs
from rover_pin.compiled.design_scan import Scanned, finite_nodes, scan
from rover_pin.compiled.design_sidecar import check_numbers, read_formulas, sizes, springs
from rover_pin.compiled.design_tracks import tracks
from rover_pin.compiled.design_tree import Walked, walk_tree
from rover_pin.compiled.machine import Machine
from rover_pin.description.notes import Notes
from rover_pin.description.prepare import prepare
from rover_pin.description.sidecar import Sidecar, read_sidecar
from rover_pin.description.trace import Trace
from rover_pin.description.trace_expand import TracedText
from rover_pin.description.trace_values import evaluate
from rover_pin.description.tree import parse
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover


class Made(NamedTuple):
    """Machines of n designs, and which of them hold.

    Attributes:
        machine: arrays with n rows; NaN in those that do not hold.
        valid: (n,) False: the loader has to make this one, or to say why it cannot.
    """

    machine: Machine
    valid: Flags


@dataclass(frozen=True)
class Blueprint:
    """All that the designs of a rover share.

    Attributes:
        rover: the nominal one.
        nominal: its machine.
        sidecar: its sidecar.
        trace: how numbers follow from parameters.
        plan: the tree.
        couplings: before the loader drops any.
        scanned: what else the loader looks at.
        stated: the sidecar's formulas.
    """

    rover: Rover
    nominal: Machine
    sidecar: Sidecar
    trace: Trace
    plan: Plan
    couplings: tuple[Coupled, ...]
    scanned: Scanned
    stated: Stated

    def make(self, parameters: Mapping[str, Array]) -> Made:
        """Machines from (n,) values of every varied parameter, n > 0."""
        inside = np.ones(len(next(iter(parameters.values()))), dtype=bool)
        for name, array in parameters.items():
            low, high = self.sidecar.parameters[name].bounds or (-np.inf, np.inf)
            inside &= np.isfinite(array) & (low <= array) & (array <= high)
        usable = {
            name: np.where(inside, array, self.rover.parameters[name]) for name, array in parameters.items()
        }
        with np.errstate(all="ignore"):
            formulas = refs([tuple(self.stated.values())])
            finite = finite_nodes(self.scanned) | formulas
            sheet = Sheet(evaluate(self.trace, usable, self._wanted() | formulas, finite), self.stated)
            check_numbers(self.stated, sheet)
            sheet.require(inside)
            self.scanned.check(sheet)
            machine = self._machine(walk_tree(self.plan, sheet), sheet)
        arrays: dict[str, Any] = machine._asdict()
        numbers = {name: array for name, array in arrays.items() if array.dtype == np.float64}
        for name in numbers.keys() - {"lower", "upper"}:
            sheet.require(np.isfinite(numbers[name]).reshape(len(inside), -1).all(axis=1))
        for array in () if sheet.valid.all() else numbers.values():
            array[~sheet.valid] = np.nan
        return Made(machine, sheet.valid)

    def _wanted(self) -> set[int]:
        coupled = [row for c in self.couplings for row in (*c.joints.values(), c.offset, c.ratio or ())]
        return refs([*self.plan.rows(), *coupled, *(row for row, _ in self.scanned.positive)])

    def _machine(self, walked: Walked, sheet: Sheet) -> Machine:
        """Arrays of n rows."""
        self._check_postures(walked, sheet)
        masses, moments = weigh(
            self.plan,
            walked,
            self.rover.recipe.payload,
            self.rover.root,
            len(self.nominal.parents),
            sheet,
        )
        centers, shape_axes = touching(self.rover, self.sidecar, walked, sheet)
        belly_joints, points = belly(self.sidecar, walked, sheet)
        wheels = wheel_links(self.rover, self.sidecar, walked, sheet)
        outline_joints, corners = outline(self.plan, walked, wheels, (belly_joints, points), sheet)
        rows, offsets = coupling_rows(self.couplings, self.rover, walked, sheet)
        made = self.nominal._replace(
            **self._joints(walked, sheet),
            outline_joints=outline_joints,
            belly_joints=belly_joints,
            masses=masses,
            moments=moments,
            centers=centers,
            shape_axes=shape_axes,
            coupling_rows=rows,
            coupling_offsets=offsets,
            belly=points,
            outline=corners,
            **springs(self.sidecar, sheet),
            **sizes(self.sidecar, sheet),
            **loops(self.sidecar, walked, sheet),
            strut_translations=struts(self.sidecar, walked, sheet),
        )
        return made._replace(**tracks(self.rover, self.sidecar, made, walked, sheet))

    def _joints(self, walked: Walked, sheet: Sheet) -> dict[str, Any]:
        """The arrays over joints and degrees of freedom."""
        count, joints = sheet.values.count, len(self.nominal.parents)
        axes, translations = np.zeros((count, joints, 3)), np.zeros((count, joints, 3))
        rotations = np.tile(np.eye(3), (count, joints, 1, 1))
        lower, upper = (np.tile(array, (count, 1)) for array in (self.rover.lower, self.rover.upper))
        for i, joint in walked.joints.items():
            axes[:, i] = joint.axis
            rotations[:, i], translations[:, i] = joint.place
            column = self.rover.column[joint.name]
            lower[:, column], upper[:, column] = joint.lower, joint.upper
        return {
            "axes": axes,
            "rotations": rotations,
            "translations": translations,
            "lower": lower,
            "upper": upper,
        }

    def _check_postures(self, walked: Walked, sheet: Sheet) -> None:
        """Leave to the loader designs whose limits a posture of the sidecar leaves."""
        moving = {joint.name: joint for joint in walked.joints.values()}
        for posture in self.sidecar.postures.values():
            for name, value in posture.items():
                if name in moving:
                    joint = moving[name]
                    sheet.require((joint.lower - 1e-9 <= value) & (value <= joint.upper + 1e-9))
                elif name in walked.held:
                    sheet.require(np.abs(value - walked.held[name]) <= 1e-6)


def read_blueprint(rover: Rover, nominal: Machine, traced: TracedText) -> Blueprint:
    """What the designs of a rover share.

    Raises:
        UntraceableError: a parameter where no number is read, or in a number that cannot be followed.
    """
    recipe, trace = rover.recipe, traced.trace
    sidecar = (
        Sidecar()
        if recipe.sidecar_text is None
        else read_sidecar(recipe.sidecar_text, recipe.sidecar_path, recipe.parameters)
    )
    made = prepare(recipe, sidecar, Notes())
    tree = parse(traced.text, str(recipe.source))
    scanned = scan(tree, trace)
    stated = read_formulas(recipe, trace)
    plan = Reader(rover, made, tree, sidecar, trace, stated).plan()
    couplings = read_couplings(made, tree, sidecar, trace, stated)
    return Blueprint(rover, nominal, sidecar, trace, plan, couplings, scanned, stated)
