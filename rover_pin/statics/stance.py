"""A stance: a rover at rest on a terrain, and everything that is known of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING

from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


class Status(str, Enum):
    """How a settle ended; only `settled` has loads."""

    SETTLED = "settled"
    TIPS = "tips"
    GROUNDED = "grounded"
    OFF_MAP = "off_map"
    SLACK = "slack"
    LOOSE = "loose"
    NO_CONVERGENCE = "no_convergence"

    def __str__(self) -> str:
        """The word used in tables and files."""
        return self.value


@dataclass(frozen=True)
class Contact:
    """One place where a shape touches the terrain.

    Attributes:
        wheel: name of the wheel or foot.
        joint: Pinocchio's id of the joint whose body carries the shape (the wheel braked).
        point: (3,) m, world; on the terrain's surface.
        normal: (3,) unit, world; out of the ground.
        rolling: (3,) unit, world; the wheel's rolling direction in the tangent plane, zero for a foot.
        radius: m; the lever of the rolling force about the wheel's axis, zero for a foot.
        gap: m; distance to the surface, negative in it.
        load: N; the force against gravity that the ground gives here.
        friction: coefficient of Coulomb friction declared for the shape.
        free: whether the wheel turns freely and so can carry no rolling force.
    """

    wheel: str
    joint: int
    point: Array
    normal: Array
    rolling: Array
    radius: float
    gap: float
    load: float
    friction: float
    free: bool = False


def _empty() -> Mapping[str, float]:
    return MappingProxyType({})


@dataclass(frozen=True)
class Stance:
    """A rover at rest on a terrain, or the reason why it is not.

    Lengths in m, angles in rad, forces in N, world frame z up (REP 103).

    Attributes:
        rover: the rover (with its payload).
        terrain: the terrain it stands on.
        status: how it ended; loads exist only where it is `settled`.
        reason: one clause for people: which wheel, joint or link, and why; empty where settled.
        limiting: name of that wheel, joint or link, or None.
        position: (3,) the root link's origin.
        rpy: (3,) roll, pitch, yaw of the root link: R = Rz(yaw) Ry(pitch) Rx(roll).
        joints: every moving joint's position (rad or m).
        contacts: the places that touch, several a wheel where there are several.
        loads: per wheel or foot, the sum of its contacts' loads.
        gaps: per wheel or foot, its least gap.
        tensions: per track, N; its slack strand's where a resistance is overcome.
        tight: per track, N, tension of the tight strand at the driven wheel.
        tractions: per wheel or foot, N: what it pulls with against a motion resistance.
        traction_ratio: tangential over vertical force of every contact that pulls; 0 without resistance.
        resistance: N, against the heading.
        springs: per spring, its force (N) or torque (N m).
        stops: per joint or spring that stands on a stop, the stop's force (N) or torque (N m).
        com: (3,) centre of mass with payload.
        gravity: m/s2.
        locked: passive joints that were held.
        residuals: `equilibrium` [-], `gap_m`, `loop_m`, `complementarity`: recomputed from the model.
        redundant: how many more supports there are than equilibrium determines.
        undetermined: passive joints that nothing determines; they kept their posture.
        configuration: (nv,) Pinocchio's vector, for code inside the project.
    """

    rover: Rover
    terrain: Terrain
    status: Status
    reason: str
    limiting: str | None
    position: Array
    rpy: Array
    joints: Mapping[str, float]
    contacts: tuple[Contact, ...]
    loads: Mapping[str, float]
    gaps: Mapping[str, float]
    com: Array
    gravity: float
    configuration: Array = field(repr=False)
    tensions: Mapping[str, float] = field(default_factory=_empty)
    tight: Mapping[str, float] = field(default_factory=_empty)
    tractions: Mapping[str, float] = field(default_factory=_empty)
    traction_ratio: float = 0.0
    resistance: float = 0.0
    springs: Mapping[str, float] = field(default_factory=_empty)
    stops: Mapping[str, float] = field(default_factory=_empty)
    locked: tuple[str, ...] = ()
    residuals: Mapping[str, float] = field(default_factory=_empty)
    redundant: int = 0
    undetermined: tuple[str, ...] = ()

    @property
    def settled(self) -> bool:
        """Whether the rover stands."""
        return self.status is Status.SETTLED

    @property
    def weight(self) -> float:
        """Weight of rover and payload, N."""
        return self.rover.mass * self.gravity

    def __repr__(self) -> str:
        """One line: robot, status, pose."""
        x, y, z = self.position
        return (
            f"Stance({self.rover.name} on {self.terrain.label}: {self.status}"
            f"{', ' + self.reason if self.reason else ''}; x {x:.3f}, y {y:.3f}, z {z:.3f} m)"
        )
