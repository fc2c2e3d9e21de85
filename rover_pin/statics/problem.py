"""The equations of standing: loads, gaps, stops, springs and loops of one rover at free coordinates z."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from rover_pin.contact.pack import pack
from rover_pin.contact.place import RING
from rover_pin.contact.rows import contact_rows
from rover_pin.contact.search import find_all
from rover_pin.mechanism import Elastic, Kinematics, OneSided, Reduction
from rover_pin.mechanism.kinematics import column_of
from rover_pin.numerics import Array
from rover_pin.statics.bending import bend_loads
from rover_pin.statics.differences import stiffness_by_differences
from rover_pin.terrain.surface import CALLABLE, LINEAR

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.resistance import Resistance
    from rover_pin.terrain import Terrain

Integers = NDArray[np.int64]

CONTACTS_PER_SHAPE = 8

THOROUGH = 1e-10
"""m: a window this small asks for one contact a shape, and for the closer look of `find_contacts`."""


@dataclass(frozen=True)
class State:
    """Everything the equations need at one z; m one-sided rows: contacts, then stops, then elements.

    Equilibrium is load = force' N + loops' multipliers; standing asks slack >= 0, N >= 0, slack . N = 0.

    Attributes:
        z: (n,) free coordinates.
        q: (nv,) configuration.
        at: kinematics at q; valid until the next state of the same problem is made.
        load: (n,) gravity minus springs, as generalised forces the supports must give.
        slack: (m,) gaps and distances to stops [m or rad].
        motion: (m, n) gradient of the slack.
        force: (m, n) generalised force of a unit multiplier: for contacts the world-vertical row, which is
            not the gap's gradient where the ground is inclined; for the rest the gradient.
        owners: (c,) shape of each of the first c rows.
        contacts: (c, 7) gap, point, normal of each.
        closure: (k,) loops' residual.
        closing: (k, n) its Jacobian.
    """

    z: Array
    q: Array
    at: Kinematics
    load: Array
    slack: Array
    motion: Array
    force: Array
    owners: Integers
    contacts: Array
    closure: Array
    closing: Array


class Underside(NamedTuple):
    """Points of the rover that must not be in the ground.

    Attributes:
        groups: joint and its points (p, 3) m in the joint's frame.
        links: the link of each point, in order of the groups.
        radii: m, of each point (a collision sphere's, else 0).
    """

    groups: list[tuple[int, Array]]
    links: list[str]
    radii: Array


class Problem:
    """One rover with what is held, under a gravity; terrains and places are given case by case.

    Args:
        rover: the rover (with its payload).
        reduction: free coordinates.
        gravity: m/s2.
    """

    def __init__(self, rover: Rover, reduction: Reduction, gravity: float) -> None:
        self.rover = rover
        self.reduction = reduction
        self.gravity = gravity
        self.model: Any = rover.model
        self.data: Any = rover.model.createData()
        self._latest: Kinematics | None = None
        self.resistance: Resistance | None = None
        self.n = reduction.basis.shape[1]
        self.weight = rover.mass * gravity
        self.span = max(rover.wheel_span, 1e-3)
        self.shapes = pack(rover.shapes)
        self.reach = float(np.max(self.shapes.rings + self.shapes.treads, initial=0.0))
        self._found = np.empty((len(rover.shapes), CONTACTS_PER_SHAPE, 7))
        self._counts = np.zeros(len(rover.shapes), dtype=np.int64)
        self.elastics: list[Elastic] = list(rover.springs)
        self.one_sided: tuple[OneSided, ...] = rover.one_sided
        self._index_stops()
        self.lengths: NDArray[np.bool_] = ~np.array(rover.turning)[list(reduction.columns)]
        self.checking: Any = rover.model.createData()  # for residuals: nothing of the solver's own

    def _index_stops(self) -> None:
        """Limits of joints that move: rows s (limit - q) >= 0."""
        basis = self.reduction.basis
        stops = []
        for joint in self.rover.joints:
            column = self.rover.column[joint]
            if not np.any(basis[column]):
                continue
            if np.isfinite(self.rover.lower[column]):
                stops.append((column, -1.0, float(self.rover.lower[column]), joint))
            if np.isfinite(self.rover.upper[column]):
                stops.append((column, 1.0, float(self.rover.upper[column]), joint))
        self.stop_joints = [stop[3] for stop in stops]
        self._stop_columns = np.array([stop[0] for stop in stops], dtype=np.int64)
        self._stop_signs = np.array([stop[1] for stop in stops])
        self._stop_limits = np.array([stop[2] for stop in stops])
        self._stop_rows = -self._stop_signs[:, None] * basis[self._stop_columns].reshape(len(stops), self.n)

    def stop_sign(self, row: int) -> float:
        """1 for an upper limit, -1 for a lower one."""
        return float(self._stop_signs[row])

    @property
    def size_of_closure(self) -> int:
        """Number of loop rows."""
        return sum(loop.size for loop in self.rover.loops)

    @cached_property
    def unit(self) -> Array:
        """(n,) size of each coordinate's motion: the wheels' span for lengths, 1 for angles."""
        return np.where(self.lengths, self.span, 1.0)

    def resisted(self, resistance: Resistance) -> Problem:
        """The same problem against a motion resistance."""
        twin = object.__new__(Problem)
        twin.__dict__.update(self.__dict__)
        twin.resistance = resistance
        return twin

    def moved(self, x: float, y: float, yaw: float) -> Problem:
        """The same problem with the base held elsewhere; shares everything that does not depend on it."""
        _ = self.unit, self.underside, self._lumps, self._carrier_columns  # what is worked out once is shared
        twin = object.__new__(Problem)
        twin.__dict__.update(self.__dict__)
        offset = self.reduction.offset.copy()
        offset[0], offset[1], offset[3] = x, y, yaw
        twin.reduction = Reduction(self.reduction.basis, offset, self.reduction.columns)
        return twin

    def locate(self, z: Array) -> Kinematics:
        """Kinematics at z."""
        self._latest = Kinematics(self.model, self.data, self.reduction.expand(z))
        return self._latest

    def place_shapes(self, at: Kinematics) -> tuple[Array, Array]:
        """Centres (s, 3) m and axes (s, 3) of all shapes, world."""
        return at.once(self.shapes, lambda: self._place_shapes(at))

    def _place_shapes(self, at: Kinematics) -> tuple[Array, Array]:
        rotations, origins = (found[self.shapes.joints] for found in at.placements)
        centers = np.einsum("sij,sj->si", rotations, self.shapes.centers) + origins
        return centers, np.einsum("sij,sj->si", rotations, self.shapes.axes)

    @cached_property
    def underside(self) -> Underside:
        """Belly and collision points, by the joint that carries them."""
        points = (*self.rover.belly, *self.rover.hull)
        joints = sorted({int(point.joint) for point in points})
        groups = [[point for point in points if point.joint == joint] for joint in joints]
        ordered = [point for group in groups for point in group]
        return Underside(
            [(j, np.array([p.point for p in group])) for j, group in zip(joints, groups, strict=True)],
            [point.link for point in ordered],
            np.array([getattr(point, "radius", 0.0) for point in ordered]),
        )

    def search(
        self, at: Kinematics, terrain: Terrain, window: float, only: Integers | None = None
    ) -> tuple[Integers, Array]:
        """Contacts of every shape: owners (c,) and rows (c, 7), each shape's least first.

        With `only` and one contact a shape, those alone are looked for; the others' gap is infinite.
        """
        found, counts = self._found, self._counts
        count = len(counts)
        if only is not None and window <= THOROUGH and len(only) < count:
            rows = np.empty((count, 7))
            rows[:] = (np.inf, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
            self._look(at, terrain, window, only)
            rows[only] = found[: len(only), 0]
            return np.arange(count), rows
        self._look(at, terrain, window, slice(None))
        if window <= THOROUGH:
            return np.arange(count), found[:, 0].copy()
        owners = np.repeat(np.arange(count), counts)
        rows = np.concatenate([found[i, : counts[i]] for i in range(count)])
        return owners, rows

    def _look(self, at: Kinematics, terrain: Terrain, window: float, which: Integers | slice) -> None:
        """Contacts of some shapes, in the first rows of `_found`."""
        shapes = self.shapes
        centers, axes = self.place_shapes(at)
        find_all(
            terrain.kind, terrain.table, terrain.params, terrain.spacing, shapes.forms[which],
            centers[which], axes[which], shapes.rings[which], shapes.treads[which], window, self._found,
            self._counts,
        )  # fmt: skip

    def look_at_others(self, state: State, terrain: Terrain, window: float) -> None:
        """Fill in the gaps that a state made with `only` has left infinite."""
        missing: Integers = np.flatnonzero(np.isinf(state.contacts[:, 0]))
        if len(missing):
            _, rows = self.search(state.at, terrain, window, missing)
            state.contacts[missing] = rows[missing]
            state.slack[missing] = rows[missing, 0]

    def state(
        self,
        z: Array,
        terrain: Terrain,
        window: float = 0.0,
        at: Kinematics | None = None,
        only: Integers | None = None,
    ) -> State:
        """The equations at z.

        Args:
            z: (n,) free coordinates.
            terrain: what it stands on.
            window: m; contacts of a shape within this of its least gap are rows too; 0: one row a shape.
            at: kinematics at z, where they are known.
            only: shapes that are looked at, see `search`.
        """
        at = at or self.locate(z)
        basis = self.reduction.basis
        owners, contacts = self.search(at, terrain, window, only)
        owned = len(contacts)
        size = owned + len(self._stop_columns) + len(self.one_sided)
        slack, motion, force = np.empty(size), np.empty((size, self.n)), np.empty((size, self.n))
        slack[:owned] = contacts[:, 0]
        tree = at.columns
        contact_rows(
            tree.parent, tree.turn, tree.move, tree.ref, self._carrier_columns[owners], contacts[:, 1:4],
            contacts[:, 4:7], basis, motion, force,
        )  # fmt: skip
        self._other_rows(at, slack[owned:], motion[owned:])
        force[owned:] = motion[owned:]
        if self.resistance is not None:
            force[:owned] += self.resistance.ratio * self.resistance.rows(at, owners, contacts) @ basis
        closure, closing = self.loops(at)
        return State(
            z, at.q, at, self.load(at), slack, motion, force, owners, contacts, closure, closing
        )  # fmt: skip

    def _other_rows(self, at: Kinematics, slack: Array, motion: Array) -> None:
        """Fill in slack and gradient of stops and one-sided elements."""
        stops = len(self._stop_columns)
        slack[:stops] = self._stop_signs * (self._stop_limits - at.q[self._stop_columns])
        motion[:stops] = self._stop_rows
        for row, element in enumerate(self.one_sided, start=stops):
            slack[row] = element.slack(at)
            motion[row] = element.slack_gradient(at) @ self.reduction.basis

    def load(self, at: Kinematics) -> Array:
        """(n,) what the supports must carry: gravity minus springs, and a motion resistance."""
        whole = pin.computeGeneralizedGravity(self.model, self.data, at.q) * (self.gravity / STANDARD)
        for element in self.elastics:
            whole = whole - element.force(at)
        if self.resistance is not None:
            whole = whole - self.resistance.drag(at)
        load: Array = whole @ self.reduction.basis
        return load

    def loops(self, at: Kinematics) -> tuple[Array, Array]:
        """Residual (k,) and Jacobian (k, n) of all loops."""
        loops = self.rover.loops
        if not loops:
            return np.zeros(0), np.zeros((0, self.n))
        residual = np.concatenate([loop.residual(at) for loop in loops])
        jacobian = np.vstack([loop.jacobian(at) for loop in loops]) @ self.reduction.basis
        return residual, jacobian

    def stiffness(
        self, state: State, terrain: Terrain, multipliers: Array, pulls: Array, window: float
    ) -> Array:
        """(n, n) derivative of load - force' N - closing' multipliers by z, in closed form.

        N and the loops' multipliers are kept; contact points move with z along the terrain. By central
        differences where a loaded contact lies on a crease, its shape has no ring, or it pulls the rover on.

        Args:
            state: the equations at z.
            terrain: what it stands on.
            multipliers: (m,) N of the state's rows.
            pulls: (k,) multipliers of the loops.
            window: that the state was made with.
        """
        loaded = np.flatnonzero(multipliers[: len(state.owners)])
        if not self._is_smooth(state, terrain, loaded):
            return stiffness_by_differences(self, state, terrain, multipliers, pulls, window)
        at = state.at if state.at is self._latest else self.locate(state.z)
        out = np.zeros((self.model.nv, self.model.nv))
        self._bend_loads(at, state, terrain, multipliers, loaded, out)
        for elastic in self.elastics:
            elastic.bend(at, out)
        first = len(state.slack) - len(self.one_sided)
        for element, multiplier in zip(self.one_sided, multipliers[first:].tolist(), strict=True):
            if multiplier != 0.0:
                element.bend_slack(at, multiplier, out)
        row = 0
        for loop in self.rover.loops:
            loop.bend(at, pulls[row : row + loop.size], out)
            row += loop.size
        basis = self.reduction.basis
        matrix: Array = basis.T @ out @ basis
        return matrix

    def _is_smooth(self, state: State, terrain: Terrain, loaded: Integers) -> bool:
        """Whether the ground has its own normal at the loaded contacts of rings, and none of them pulls."""
        owners = state.owners[loaded]
        if (
            self.resistance is not None
            or terrain.kind == CALLABLE
            or np.any(self.shapes.forms[owners] != RING)
        ):
            return False
        if terrain.kind != LINEAR:
            return True
        x, y = state.contacts[loaded, 1], state.contacts[loaded, 2]
        normals = np.column_stack([-terrain.gradient(x, y), np.ones(len(x))])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return bool(np.max(np.abs(normals - state.contacts[loaded, 4:7]), initial=0.0) < 1e-9)

    def _bend_loads(
        self, at: Kinematics, state: State, terrain: Terrain, multipliers: Array, loaded: Integers, out: Array
    ) -> None:
        """Take the derivative of the generalised forces of weight and contacts off `out`."""
        joints, columns, masses, levers = self._lumps
        tree = at.columns
        rotations, origins = (found[joints] for found in at.placements)
        centers, axes = self.place_shapes(at)
        owners = state.owners[loaded]
        bend_loads(
            tree.parent, tree.turn, tree.move, tree.ref, columns, rotations, origins, masses, levers,
            self.gravity, out, terrain.kind, terrain.table, terrain.params, self._carrier_columns[owners],
            centers[owners], axes[owners], self.shapes.rings[owners], state.contacts[loaded, 1:4],
            multipliers[loaded],
        )  # fmt: skip

    @cached_property
    def _lumps(self) -> tuple[Integers, Integers, Array, Array]:
        """Joints that carry a mass, their columns, masses (b,) kg and levers (b, 3) m."""
        inertias = list(self.model.inertias)
        joints = [joint for joint, body in enumerate(inertias) if joint > 0 and body.mass > 0.0]
        return (
            np.array(joints, dtype=np.int64),
            np.array([column_of(joint) for joint in joints], dtype=np.int64),
            np.array([inertias[joint].mass for joint in joints]),
            np.array([inertias[joint].lever for joint in joints]).reshape(-1, 3),
        )

    @cached_property
    def _carrier_columns(self) -> Integers:
        """(s,) columns of the shapes' carriers."""
        return np.array([column_of(int(joint)) for joint in self.shapes.joints], dtype=np.int64)

    def mass_matrix(self, at: Kinematics) -> Array:
        """(n, n) inertia on the free coordinates."""
        whole = pin.crba(self.model, self.data, at.q)
        whole = np.triu(whole) + np.triu(whole, 1).T
        basis = self.reduction.basis
        matrix: Array = basis.T @ whole @ basis
        return matrix

    def tilt(self, z: Array) -> float:
        """Angle between the base's z axis and the vertical [rad]."""
        q = self.reduction.expand(z)
        return float(np.arccos(np.clip(np.cos(q[4]) * np.cos(q[5]), -1.0, 1.0)))


STANDARD = 9.81
"""Gravity of Pinocchio's models, m/s2; loads scale with what is asked for."""
