"""A rover at one configuration over a terrain: contacts, and velocities of points of its bodies as rows.

Every row is a unit wrench on a body: a direction at a point, or a turn. A row times v = dq/dt is the velocity
along it; columns are named by `Rover.dof_names`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from rover_pin.contact.pack import half_extents, pack
from rover_pin.contact.search import find_all
from rover_pin.errors import InputError
from rover_pin.kinematics.finite import not_finite
from rover_pin.kinematics.kernels import place_shapes, rolling_frame, velocity_rows
from rover_pin.mechanism import Kinematics
from rover_pin.mechanism.frames import find_frame
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

Integers = NDArray[np.int64]

T = TypeVar("T")

ONE_EACH = 1e-10
"""m: a window this small asks the contact search for one contact a shape."""


class Bodies:
    """What does not change from one instant to the next: which columns move a body, where wheels sit.

    Args:
        rover: the rover; it must touch the ground somewhere.
        terrain: what it drives on.

    Raises:
        InputError: the rover has neither wheels nor contacts.
    """

    def __init__(self, rover: Rover, terrain: Terrain) -> None:
        if not rover.shapes:
            raise InputError(
                "nothing of this robot touches the ground: it has no wheels and no contacts",
                file=rover.sidecar_path or rover.source,
                element="wheels",
                cure="declare `wheels` or `contacts` in the sidecar",
            )
        self.rover = rover
        self.terrain = terrain
        self.names = tuple(shape.name for shape in rover.shapes)
        self.model: Any = rover.model
        self.data: Any = rover.model.createData()
        self.packed = pack(rover.shapes)
        self.latest: Instant | None = None
        self._found = np.empty((len(self.names), 8, 7))
        self._counts = np.zeros(len(self.names), dtype=np.int64)
        self._bounded = bool(np.isfinite(terrain.extent).any())
        self._kept: dict[str, Any] = {}

    def once(self, what: str, work_out: Callable[[], T]) -> T:
        """What does not change from instant to instant, worked out once."""
        if what not in self._kept:
            self._kept[what] = work_out()
        found: T = self._kept[what]
        return found

    @cached_property
    def chains(self) -> Array:
        """(joints, nv) 1 where a column moves the body of a joint, else 0; by Pinocchio's joint ids."""
        model = self.model
        chains = np.zeros((model.njoints, model.nv))
        for joint in range(1, model.njoints):
            chains[joint] = chains[model.parents[joint]]
            first = model.idx_vs[joint]
            chains[joint, first : first + model.nvs[joint]] = 1.0
        return chains

    @cached_property
    def rolling_joints(self) -> Integers:
        """(s,) joint whose body touches the ground: a wheel's own turning joint where it has one."""
        turning = [getattr(shape, "drive", None) for shape in self.rover.shapes]
        return np.array(
            [
                shape.joint if drive is None else self.model.getJointId(drive)
                for shape, drive in zip(self.rover.shapes, turning, strict=True)
            ],
            dtype=np.int64,
        )

    @cached_property
    def can_hold(self) -> NDArray[np.bool_]:
        """(s,) whether a shape resists along its rolling direction: feet, wheels with a joint to turn by."""
        wheels = self.rover.wheels
        return np.array([i >= len(wheels) or wheels[i].drive is not None for i in range(len(self.names))])

    def at(self, q: Array) -> Instant:
        """The rover at q (nv,), copied.

        Raises:
            InputError: a wrong shape, or an entry that is not finite, named.
        """
        values = np.array(q, dtype=np.float64)
        if values.shape != (self.model.nv,):
            raise InputError(
                "a configuration has one entry a degree of freedom",
                element="q",
                value=values.shape,
                cure=f"give shape ({self.model.nv},): {', '.join(self.rover.dof_names)}",
            )
        bad = not_finite(values)
        if bad is not None:
            raise InputError(
                "is no finite number", element=self.rover.dof_names[bad], value=float(values[bad])
            )
        return Instant(self, values)

    def off_map(self, at: Instant) -> str | None:
        """A shape with a point that is not over the map, or None."""
        if not self._bounded:
            return None
        low_x, high_x, low_y, high_y = self.terrain.extent
        shapes = self.packed
        reach = half_extents(shapes.forms, at.axes, shapes.rings, shapes.treads)
        low, high = at.centers[:, :2] - reach, at.centers[:, :2] + reach
        off = (low < (low_x, low_y)).any(axis=1) | (high > (high_x, high_y)).any(axis=1)
        return self.names[int(np.argmax(off))] if off.any() else None

    def touching(self, centers: Array, axes: Array) -> Array:
        """(s, 7) gap [m], point [m], unit normal out of the ground of each shape's nearest place, world."""
        ground, shapes = self.terrain, self.packed
        find_all(
            ground.kind, ground.table, ground.params, ground.spacing, shapes.forms, centers, axes,
            shapes.rings, shapes.treads, ONE_EACH, self._found, self._counts,
        )  # fmt: skip
        return self._found[:, 0].copy()


class Instant:
    """The rover at q; made by `Bodies.at`.

    Attributes:
        bodies: what it was made by.
        q: (nv,) configuration, read-only.
        jacobian: (6, nv) of every column: velocity at the world's origin, then axis, world axes.
    """

    def __init__(self, bodies: Bodies, q: Array) -> None:
        q.setflags(write=False)
        self.bodies = bodies
        self.q = q
        pin.computeJointJacobians(bodies.model, bodies.data, q)
        bodies.latest = self
        self.jacobian: Array = bodies.data.J.copy()
        self._kept: dict[str, Any] = {}
        self._mechanism: Kinematics | None = None

    @property
    def rover(self) -> Rover:
        """The rover."""
        return self.bodies.rover

    def once(self, what: str, work_out: Callable[[], T]) -> T:
        """What several ask for at this instant, worked out once."""
        if what not in self._kept:
            self._kept[what] = work_out()
        found: T = self._kept[what]
        return found

    @property
    def placed(self) -> Any:
        """Pinocchio's placements of all joints; worked out again where another instant came between."""
        if self.bodies.latest is not self:
            pin.computeJointJacobians(self.bodies.model, self.bodies.data, self.q)
            self.bodies.latest = self
        return self.bodies.data.oMi

    @property
    def mechanism(self) -> Kinematics:
        """What couplings, loops and tracks ask for; made again where another instant came between."""
        if self._mechanism is None or self.bodies.latest is not self:
            self._mechanism = Kinematics(self.bodies.model, self.bodies.data, self.q)
            self.bodies.latest = self
        return self._mechanism

    @cached_property
    def _shapes(self) -> tuple[Array, Array]:
        packed, placed = self.bodies.packed, self.placed
        frames = np.array([placed[joint].homogeneous for joint in packed.joints.tolist()])
        centers, axes = np.empty_like(packed.centers), np.empty_like(packed.axes)
        place_shapes(frames, packed.centers, packed.axes, centers, axes)
        return centers, axes

    @property
    def centers(self) -> Array:
        """(s, 3) m, world: centres of wheels, then feet."""
        return self._shapes[0]

    @property
    def axes(self) -> Array:
        """(s, 3) unit, world: axes of wheels; of feet whatever they have."""
        return self._shapes[1]

    @cached_property
    def contacts(self) -> Array:
        """(s, 7) gap [m], point on the ground [m], unit normal, of each shape's nearest place, world."""
        return self.bodies.touching(self.centers, self.axes)

    @property
    def rolling(self) -> Array:
        """(s, 3) unit, world: where each wheel rolls to, in the ground's tangent plane: axis x normal."""
        rolling: Array = self._rolling_frame[0][1]
        return rolling

    @property
    def sideways(self) -> Array:
        """(s, 3) unit, world: across the rolling direction, to the left of it, in the tangent plane."""
        sideways: Array = self._rolling_frame[0][2]
        return sideways

    @property
    def contact_rows(self) -> Array:
        """(3, s, nv) velocities [m/s] where shapes touch: along the normal, rolling, and sideways."""
        return self._rolling_frame[1]

    @cached_property
    def _rolling_frame(self) -> tuple[Array, Array]:
        contacts, bodies = self.contacts, self.bodies
        along = np.empty((3, len(contacts), 3))
        rows = np.empty((3, len(contacts), self.jacobian.shape[1]))
        rolling_frame(
            self.jacobian, bodies.chains, bodies.rolling_joints, contacts, self.axes, along, rows
        )  # fmt: skip
        return along, rows

    @property
    def normal_rows(self) -> Array:
        """(s, nv) rates of the gaps [m/s]."""
        normal: Array = self.contact_rows[0]
        return normal

    def rows(self, joints: Integers, points: Array, directions: Array) -> Array:
        """(k, nv) velocities of points of bodies along directions.

        Args:
            joints: (k,) Pinocchio's ids of the joints whose bodies the points belong to.
            points: (k, 3) m, world.
            directions: (k, 3), world.
        """
        rows = np.empty((len(joints), self.jacobian.shape[1]))
        velocity_rows(self.jacobian, self.bodies.chains, joints, points, directions, rows)
        return rows

    def turns(self, joints: Integers, directions: Array) -> Array:
        """(k, nv) angular velocities [rad/s] of bodies about directions (k, 3), world."""
        rows: Array = directions @ self.jacobian[3:]
        rows *= self.bodies.chains[joints]
        return rows

    def frame(self, name: str) -> tuple[int, Array, Array]:
        """Joint, origin (3,) m and rotation (3, 3) in the world of a link's or joint's frame.

        Raises:
            SidecarError: no link or joint of that name; names the nearest.
        """
        found = find_frame(self.bodies.model, name, element="frame")
        joint = int(found.parentJoint)
        placement = self.placed[joint] * found.placement
        return joint, np.array(placement.translation), np.array(placement.rotation)

    @cached_property
    def com(self) -> Array:
        """(3,) m, world: centre of mass."""
        _ = self.placed
        return frozen(pin.centerOfMass(self.bodies.model, self.bodies.data, self.q))

    @cached_property
    def com_rows(self) -> Array:
        """(3, nv) velocity of the centre of mass."""
        _ = self.placed
        return frozen(pin.jacobianCenterOfMass(self.bodies.model, self.bodies.data, self.q))

    @property
    def heading(self) -> float:
        """Yaw of the root link [rad]."""
        return float(self.q[3])

    def index(self, wheels: Sequence[str]) -> Integers:
        """(k,) where wheels or feet stand in the order of shapes.

        Raises:
            InputError: an unknown one, with the nearest names.
        """
        return index_of(self.bodies.names, wheels)


def index_of(names: Sequence[str], wanted: Sequence[str]) -> Integers:
    """(k,) places of `wanted` in `names`.

    Raises:
        InputError: an unknown one, with the nearest names.
    """
    from rover_pin.errors import nearest

    for name in wanted:
        if name not in names:
            raise InputError(
                "no wheel or foot of that name", element=str(name), cure=nearest(str(name), names)
            )
    return np.array([names.index(name) for name in wanted], dtype=np.int64)
