"""Rover: the Pinocchio model, the mechanism, wheels and actuation; named joints in and out."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

from rover_pin.contact import Foot, Wheel
from rover_pin.description.geometry import BodyPoint, Geometry, Visual
from rover_pin.description.masses import Masses
from rover_pin.description.model import BASE_DOF
from rover_pin.description.recipe import Payload, Recipe
from rover_pin.errors import naming
from rover_pin.info import describe, info
from rover_pin.mechanism import Coupling, FrameSpring, Loop, OneSided, Spring, Track
from rover_pin.mechanism.frames import find_frame
from rover_pin.mobility import Mobility, measure_mobility
from rover_pin.numerics import Array, frozen
from rover_pin.payload import put_on
from rover_pin.posture import resolve_posture
from rover_pin.reweighed import bodies_of, reweigh
from rover_pin.weighing import Body

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


@dataclass(frozen=True, eq=False, repr=False)
class Rover:
    """A rover as loaded; nothing in it changes.

    Lengths in m, angles in rad, masses in kg. q = [x, y, z, yaw, pitch, roll, joints...] of the root link,
    R = Rz(yaw) Ry(pitch) Rx(roll), v = dq/dt; people meet names only.

    Attributes:
        name: the bundled name, else the URDF's.
        urdf: the URDF text that Pinocchio was given.
        model: Pinocchio's model; nq == nv.
        root: the URDF's root link.
        joints: moving joints in the order of q.
        lower, upper, effort, velocity: (nv,) limits of place, force, speed; +-inf where there are none.
        actuated: driven joints; lockable: passive ones that can be locked.
        couplings, loops, springs, tracks: what URDF cannot say.
        wheels, feet: what touches the ground.
        belly: points for clearance and grounding.
        postures: joint values by posture name.
        recipe: the texts it was made from.
    """

    name: str
    urdf: str
    model: pin.Model
    root: str
    joints: tuple[str, ...]
    lower: Array
    upper: Array
    effort: Array
    velocity: Array
    actuated: tuple[str, ...]
    lockable: tuple[str, ...]
    couplings: tuple[Coupling, ...]
    loops: tuple[Loop, ...]
    springs: tuple[Spring, ...]
    tracks: tuple[Track, ...]
    wheels: tuple[Wheel, ...]
    feet: tuple[Foot, ...]
    belly: tuple[BodyPoint, ...]
    postures: Mapping[str, Mapping[str, float]]
    recipe: Recipe
    loading_notes: tuple[str, ...]
    read_geometry: Callable[[], Geometry]

    @property
    def source(self) -> Path:
        """The URDF or xacro file."""
        return self.recipe.source

    @property
    def sidecar_path(self) -> Path | None:
        """The sidecar's file, or None."""
        return self.recipe.sidecar_path

    @property
    def parameters(self) -> Mapping[str, float]:
        """The value of every declared parameter."""
        return MappingProxyType(dict(self.recipe.parameters))

    @cached_property
    def dof_names(self) -> tuple[str, ...]:
        """(nv) the base's six, then the joints: names of q's entries and of a Jacobian's columns."""
        return (*BASE_DOF, *self.joints)

    @cached_property
    def column(self) -> Mapping[str, int]:
        """Where a name stands in q and v."""
        return MappingProxyType({name: i for i, name in enumerate(self.dof_names)})

    @cached_property
    def turning(self) -> tuple[bool, ...]:
        """(nv) whether an entry of q is an angle [rad], else a length [m]."""
        kinds = [self.model.joints[i].shortname() for i in range(2, self.model.njoints)]
        return (*(False,) * 3, *(True,) * 3, *(not kind.startswith("JointModelP") for kind in kinds))

    @cached_property
    def passive(self) -> tuple[str, ...]:
        """Moving joints that nothing drives."""
        return tuple(name for name in self.joints if name not in self.actuated)

    @property
    def shapes(self) -> tuple[Wheel | Foot, ...]:
        """Wheels, then feet."""
        return (*self.wheels, *self.feet)

    @cached_property
    def bearing(self) -> tuple[int, ...]:
        """Which of `shapes` should carry: all but auxiliary wheels."""
        idle = {i for i, wheel in enumerate(self.wheels) if wheel.auxiliary}
        return tuple(i for i in range(len(self.shapes)) if i not in idle)

    @cached_property
    def one_sided(self) -> tuple[OneSided, ...]:
        """Elements that bind one way: frame springs by their stops, then tracks."""
        return (*(spring for spring in self.springs if isinstance(spring, FrameSpring)), *self.tracks)

    @property
    def visuals(self) -> tuple[Visual, ...]:
        """What a viewer draws."""
        return self.read_geometry().visuals

    @property
    def hull(self) -> tuple[BodyPoint, ...]:
        """Points of collision primitives of links that are no wheel, at most 0.05 m apart."""
        return self.read_geometry().hull

    @property
    def notes(self) -> tuple[str, ...]:
        """What the loader dropped, guessed or found suspect."""
        return (*self.loading_notes, *self.read_geometry().notes)

    @cached_property
    def mass(self) -> float:
        """Kilograms, payload included."""
        return float(pin.computeTotalMass(self.model))

    @property
    def home(self) -> Mapping[str, float]:
        """The posture `home`, or nothing."""
        return self.postures.get("home", {})

    @cached_property
    def neutral(self) -> Array:
        """(nv,) the base at the origin, joints at home; 0 where that is silent, or the limit nearest to 0."""
        q = np.clip(np.zeros(self.model.nv), self.lower, self.upper)
        for name, value in self.home.items():
            q[self.column[name]] = value
        return frozen(q)

    @cached_property
    def wheel_span(self) -> float:
        """The largest distance between two wheels or feet at home, m; a lone one's diameter, else 1."""
        data = self.model.createData()
        pin.forwardKinematics(self.model, data, np.array(self.neutral))
        centers = [data.oMi[s.joint].act(np.array(s.center)) for s in self.shapes]
        span = max((math.dist(a, b) for a in centers for b in centers), default=0.0)
        if span > 0.0:
            return span
        return 2.0 * max((s.ring + s.tread for s in self.shapes), default=0.0) or 1.0

    @cached_property
    def mobility(self) -> Mobility:
        """Rank, redundancy and mobility of couplings and loops at home.

        Raises:
            MechanismError: a loop that cannot close.
        """
        tying = [loop for loop in self.loops if loop.type != "level"]  # that one holds the base
        with naming(self.sidecar_path or self.source):
            return measure_mobility(self.model, self.couplings, tying, self.neutral, len(BASE_DOF))

    def resolve_posture(self, posture: str | Mapping[str, float] | None = "home") -> dict[str, float]:
        """Joint values of a posture given by name or as a mapping; joints it does not name are left out.

        Raises:
            PostureError: an unknown posture or joint, a value that is no number or outside the limits.
        """
        return resolve_posture(self, posture)

    def configuration(
        self,
        joints: Mapping[str, float] | None = None,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        rpy: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> Array:
        """(nv,) q from a base pose (m; roll, pitch, yaw in rad) and named joints; the others as in `neutral`.

        Raises:
            PostureError: an unknown joint, or a value outside the limits.
        """
        q = np.array(self.neutral)
        q[:3] = position
        q[3:6] = rpy[2], rpy[1], rpy[0]
        for name, value in self.resolve_posture(joints or {}).items():
            q[self.column[name]] = value
        return q

    def jacobian(self, stance: Stance, frame: str) -> Array:
        """(6, nv) of a link's or joint's frame: linear rows [m/s] first, then angular [rad/s], world axes.

        Columns are named by `dof_names`; those of the base are its Cartesian rates and ZYX Euler rates.

        Raises:
            SidecarError: no link or joint of that name.
        """
        found = find_frame(self.model, frame, element="frame")
        data = self.model.createData()
        q = np.array(stance.configuration)
        pin.computeJointJacobians(self.model, data, q)
        jacobian: Array = pin.getFrameJacobian(
            self.model, data, int(found.parentJoint), found.placement, pin.LOCAL_WORLD_ALIGNED
        )
        return frozen(jacobian)

    def with_payload(self, payload: Sequence[Payload]) -> Rover:
        """The same rover with point masses on it: (kg, (x, y, z) in the root link's frame [m]) or (kg, link).

        A mass on a link or joint sits at its origin and moves with it.

        Raises:
            InputError: a mass below zero, something that is no finite number, or no such link or joint.
        """
        model, checked = put_on(self.model, self.root, payload)
        recipe = dataclasses.replace(self.recipe, payload=(*self.recipe.payload, *checked))
        return dataclasses.replace(self, model=model, recipe=recipe)

    @cached_property
    def bodies(self) -> Mapping[str, Body]:
        """Every link as it is fixed to its joint, its mass that of the files."""
        return MappingProxyType(bodies_of(self.model, self.urdf, str(self.source)))

    def with_masses(self, masses: Masses) -> Rover:
        """The same rover with other masses of links or of the whole, counted from its files; payload stays.

        Inertias about centres of mass grow with the masses. Other masses given before are forgotten.

        Raises:
            InputError: a link that is not there, a number that no mass has, or masses that no rover can have.
        """
        if self.recipe.masses:
            from rover_pin.loader import assemble

            return assemble(dataclasses.replace(self.recipe, masses=masses))
        recipe = dataclasses.replace(self.recipe, masses=masses)
        return dataclasses.replace(self, model=reweigh(self, masses), recipe=recipe)

    def with_parameters(self, **parameters: float) -> Rover:
        """The same rover with other parameter values, read anew from its files.

        Raises:
            InputError: as `load`.
        """
        from rover_pin.loader import reload

        return reload(self.recipe, parameters)

    def info(self) -> dict[str, Any]:
        """What `rover-pin info --json` prints."""
        return info(self)

    def describe(self) -> str:
        """The same for people, a few lines."""
        return describe(self)

    def __repr__(self) -> str:
        """One line."""
        return (
            f"Rover({self.name}: {self.mass:.4g} kg, {len(self.joints)} joints, {len(self.actuated)} driven, "
            f"{len(self.wheels)} wheels, {len(self.feet)} feet)"
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the recipe: a worker makes the rover again from its texts."""
        from rover_pin.loader import assemble

        return assemble, (self.recipe,)
