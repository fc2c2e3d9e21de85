"""Batch: many cases of one rover on one terrain, answered by compiled loops."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.answers import COMPILED_MEASURES, Answers, answers_of, blank
from rover_pin.compiled.bounds import SHARES
from rover_pin.compiled.design_machine import Made
from rover_pin.compiled.designs import Designs
from rover_pin.compiled.ground import MOST_SIZES, GroundArrays, ground_of
from rover_pin.compiled.groups import Groups, as_loaded, filled, outline_radii, varied
from rover_pin.compiled.kernel import Out, settle_all
from rover_pin.compiled.machine import Machine, machine_of
from rover_pin.compiled.posed import Integers
from rover_pin.compiled.search import contact_search
from rover_pin.compiled.template import Posture, Template, template_of
from rover_pin.description.trace import UntraceableError
from rover_pin.errors import InputError, nearest
from rover_pin.numerics import Array
from rover_pin.terrain import Terrain
from rover_pin.terrain.surface import CALLABLE
from rover_pin.weighing import Changes, weigh_anew

if TYPE_CHECKING:
    from rover_pin.rover import Rover

MOST_MACHINES = 1024
"""Machines that are made ready at a time: some kilobytes each."""

BLOCK = 2.0
"""m: squares of the map that are gone through one after the other."""

BLOCK_WORTH = 500
"""Cases below which their order is left alone."""

ROOM = 1.5
"""Outlines that the ground's bounds are for, over that of the rover as loaded: designs may be larger."""


class Batch:
    """Many cases of one rover on one terrain.

    The same answers as `rover_pin.settle`, to 1e-8 m, 1e-8 rad and 1e-5 N; a case that the kernels cannot
    finish is left open for it. An answer depends on its case alone: not on the others, their number or order.

    Args:
        rover: what stands.
        terrain: what it stands on.
        gravity: m/s2.
        locks: passive joints that are locked.
        measures: of COMPILED_MEASURES.
        designs: of the rover, for parameters that vary; made from its files where silent.

    Attributes:
        refusal: why the kernels cannot serve this rover or terrain, so that every case is left open; else "".

    Raises:
        InputError: a measure that the kernels do not have.
    """

    def __init__(
        self,
        rover: Rover,
        terrain: Terrain,
        *,
        gravity: float = 9.81,
        locks: Sequence[str] = (),
        measures: Sequence[str] = (),
        designs: Designs | None = None,
    ) -> None:
        for name in measures:
            if name not in COMPILED_MEASURES:
                cure = nearest(name, COMPILED_MEASURES)
                raise InputError("is no compiled measure", element="measures", value=name, cure=cure)
        self.rover = rover
        self.terrain = terrain
        self.gravity = gravity
        self.locks = tuple(locks)
        self.measures = tuple(measures)
        self.refusal = _refusal(rover, terrain)
        self._templates: dict[object, Template | None] = {}
        self._single: dict[object, Groups] = {}
        self._designs = {} if designs is None else {designs.names: designs}

    def answer(
        self,
        x: Array,
        y: Array,
        yaw: Array,
        *,
        postures: Sequence[Posture] = (None,),
        posture: Integers | None = None,
        joints: Mapping[str, Array] | None = None,
        parameters: Mapping[str, Array] | None = None,
        changes: Changes | None = None,
    ) -> Answers:
        """Answer n cases.

        Args:
            x: (n,) m.
            y: (n,) m.
            yaw: (n,) rad.
            postures: what `settle` takes.
            posture: (n,) index into `postures`; 0 where silent.
            joints: (n,) values of further joints, rad or m; a passive joint given here is locked there.
            parameters: (n,) values of declared parameters.
            changes: other masses of n rovers; where links' own masses are changed and parameters vary too,
                every case is left open.
        """
        x, y, yaw = (np.ascontiguousarray(values, dtype=np.float64) for values in (x, y, yaw))
        given = [
            {name: np.asarray(values, dtype=np.float64) for name, values in (each or {}).items()}
            for each in (joints, parameters)
        ]
        out = blank(self.rover, len(x), bool(self.measures))
        joint_rad = np.full((len(x), len(self.rover.joints)), np.nan)
        which = np.zeros(len(x), dtype=np.int64) if posture is None else np.asarray(posture)
        links: tuple[str, ...] = ()
        alone = bool(given[0] or given[1] or changes)
        for k, each in enumerate(postures if not self.refusal else ()):
            template = self._template(each, tuple(given[0]), bool(given[1] or changes))
            if template is None:
                continue
            links = tuple(template.problem.underside.links)
            cases = _near_each_other(np.flatnonzero(which == k), x, y)
            for mine in _blocks(cases, MOST_MACHINES if alone else max(len(cases), 1)):
                held, designs = ({name: v[mine] for name, v in part.items()} for part in given)
                some = changes.pick(mine) if changes else None
                groups, index = self._groups(each, template, held, designs, some, len(mine))
                part = self._settle(groups, index, x[mine], y[mine], yaw[mine])
                joint_rad[mine] = groups.pose.joints(index, part.z)
                _put(out, mine, part)
        return answers_of(self.rover, self.measures, out, joint_rad, links)

    def _settle(self, groups: Groups, index: Integers, x: Array, y: Array, yaw: Array) -> Out:
        free = int(groups.pose.records["n_free"][0])
        out = blank(self.rover, len(x), bool(self.measures), free)
        settle_all(
            groups.pose.records, groups.scratch, *self._ground, groups.skin, contact_search(), index,
            x, y, yaw, out,
        )  # fmt: skip
        return out

    def _template(self, posture: Posture, joints: tuple[str, ...], designs: bool) -> Template | None:
        key = (_name(posture), joints, designs)
        if key not in self._templates:
            self._templates[key] = template_of(
                self.rover, posture, joints, self.locks, self.gravity, designs=designs
            )
        return self._templates[key]

    def _groups(
        self,
        posture: Posture,
        template: Template,
        joints: Mapping[str, Array],
        parameters: Mapping[str, Array],
        changes: Changes | None,
        count: int,
    ) -> tuple[Groups, Integers]:
        """Groups, and the group of each case."""
        sizes = np.array(self._sizes)
        if not joints and not parameters and not changes:
            key = _name(posture)
            if key not in self._single:
                self._single[key] = as_loaded(self.rover, self._machine, template, sizes, self._outline_reach)
            return self._single[key], np.zeros(count, dtype=np.int64)
        machine, valid = self._machine, np.ones(count, dtype=np.bool_)
        if parameters:
            made = self._made(parameters)
            if made is None:
                valid[:] = False
            else:
                machine, valid = filled(made.machine, made.valid, self._machine), made.valid
        if changes:
            machine, heavy = self._weighed(machine, changes)
            valid = valid & heavy
            if parameters and changes.links:
                valid = np.zeros(count, dtype=np.bool_)  # a link's own mass may hang on the parameters
        values = np.tile(template.values, (count, 1))
        for name, column in joints.items():
            values[:, self.rover.column[name]] = column
        groups = varied(self.rover, machine, template, values, sizes, self._outline_reach, self._flat)
        groups.pose.records["usable"] &= valid
        return groups, np.arange(count)

    def _made(self, parameters: Mapping[str, Array]) -> Made | None:
        """Designs made without their files, or None where they cannot be."""
        names = tuple(parameters)
        if names not in self._designs:
            self._designs[names] = Designs(self.rover, names)
        designs = self._designs[names]
        try:
            return None if designs.refusal else designs.machines(parameters)
        except UntraceableError:
            return None

    def _weighed(self, machine: Machine, changes: Changes) -> tuple[Machine, NDArray[np.bool_]]:
        """The machine with other masses, and which groups can have them."""
        rover = self.rover
        kg, moments, valid = weigh_anew(
            machine.masses, machine.moments, rover.bodies, rover.root, rover.recipe.payload, changes
        )
        kg[~valid], moments[~valid] = self._machine.masses, self._machine.moments
        return machine._replace(masses=kg, moments=moments), valid

    @cached_property
    def _machine(self) -> Machine:
        return machine_of(self.rover)

    @cached_property
    def _sizes(self) -> tuple[float, ...]:
        """Distinct sizes of the shapes, m, ascending."""
        return tuple(sorted({shape.ring + shape.tread for shape in self.rover.shapes}))

    @cached_property
    def _outline_reach(self) -> float:
        radii = outline_radii(self._machine.outline_joints, self._machine.outline)
        return ROOM * float(np.max(radii, initial=1e-3))

    @cached_property
    def _ground(self) -> GroundArrays:
        return ground_of(self.terrain, self._reaches)

    @cached_property
    def _flat(self) -> GroundArrays:
        return ground_of(Terrain.flat(), self._reaches)

    @cached_property
    def _reaches(self) -> tuple[float, ...]:
        return (*(share * size for size in self._sizes for share in SHARES), self._outline_reach)


def _name(posture: Posture) -> object:
    """A posture as a key."""
    return posture if posture is None or isinstance(posture, str) else tuple(sorted(posture.items()))


def _put(out: Out, cases: Integers, part: Out) -> None:
    """Write the answers of some cases among those of all; of free coordinates the base's three."""
    for name in Out._fields:
        whole, some = getattr(out, name), getattr(part, name)
        if len(whole):
            whole[cases] = some[:, :3] if name == "z" else some


def _blocks(cases: Integers, most: int) -> Iterator[Integers]:
    """Cases, at most so many at a time."""
    for start in range(0, len(cases), most):
        yield cases[start : start + most]


def _near_each_other(cases: Integers, x: Array, y: Array) -> Integers:
    """Cases in an order in which the map under one is still at hand for the next; no answer hangs on it."""
    if len(cases) < BLOCK_WORTH:
        return cases
    rows, columns = np.floor(y[cases] / BLOCK), np.floor(x[cases] / BLOCK)
    return cases[np.lexsort((columns, rows))]


def _refusal(rover: Rover, terrain: Terrain) -> str:
    if terrain.kind == CALLABLE:
        return "the terrain is a Python function"
    if not rover.shapes:
        return "nothing of this robot touches the ground"
    if len({shape.ring + shape.tread for shape in rover.shapes}) > MOST_SIZES:
        return f"its shapes have more than {MOST_SIZES} sizes"
    xmin, xmax, ymin, ymax = terrain.extent
    if min(xmax - xmin, ymax - ymin) < rover.wheel_span:
        return "the map is smaller than the rover"
    return ""
