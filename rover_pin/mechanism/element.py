"""The three faces an element of the mechanism can show to the equations of equilibrium.

An element may show more than one: a spring with a stop is elastic, and one-sided at its stop. A cable of
constant length is one-sided: its slack is at least zero and its tension is the multiplier.
"""

from __future__ import annotations

from typing import Protocol

from rover_pin.mechanism.kinematics import Kinematics
from rover_pin.numerics import Array


class Bilateral(Protocol):
    """Rows c(q) = 0 whose multipliers may have either sign: a closed loop."""

    @property
    def name(self) -> str:
        """The name given in the sidecar."""

    @property
    def size(self) -> int:
        """Number of rows m."""

    def residual(self, at: Kinematics) -> Array:
        """c(q), (m,) [m, or rad for rows that close an orientation]."""

    def jacobian(self, at: Kinematics) -> Array:
        """dc/dq, (m, nv)."""


class Closing(Bilateral, Protocol):
    """Rows that bend: their derivative changes with q."""

    def bend(self, at: Kinematics, multipliers: Array, out: Array) -> None:
        """Take the sum of multipliers (m,) times second derivatives of c off `out` (nv, nv)."""


class OneSided(Protocol):
    """A row s(q) >= 0 whose multiplier is at least zero and complementary: a stop, a cable."""

    @property
    def name(self) -> str:
        """The name given in the sidecar."""

    @property
    def kind(self) -> str:
        """Its list in the sidecar."""

    @property
    def impossible(self) -> tuple[str, str]:
        """What is wrong, and the cure, where no motion of the joints makes s(q) >= 0."""

    def slack(self, at: Kinematics) -> float:
        """s(q) [m or rad]: what is left before the stop or until the cable is taut."""

    def slack_gradient(self, at: Kinematics) -> Array:
        """ds/dq, (nv,): also the direction of the generalised force of a unit multiplier."""

    def bend_slack(self, at: Kinematics, multiplier: float, out: Array) -> None:
        """Take multiplier times the second derivative of s off `out` (nv, nv)."""


class Elastic(Protocol):
    """A potential: a spring."""

    @property
    def name(self) -> str:
        """The name given in the sidecar."""

    def energy(self, at: Kinematics) -> float:
        """V(q) [J]."""

    def force(self, at: Kinematics) -> Array:
        """Generalised force -dV/dq, (nv,) [N or N m]."""

    def bend(self, at: Kinematics, out: Array) -> None:
        """Add the second derivative of V to `out` (nv, nv)."""

    def effort(self, at: Kinematics) -> float:
        """What is reported to people: the force along the spring [N] or the joint's torque [N m]."""
