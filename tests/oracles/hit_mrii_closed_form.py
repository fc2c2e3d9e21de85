"""HIT-MRII on level ground, both sides alike, in closed form: no Pinocchio, no project code.

Lengths in m, angles in rad, forces in N; x forward, z up, angles of the front arm positive downwards.

Motor angle u turns the rear arm by u and the front arm by z u; p is the body's pitch (nose down positive).
Then a = z u + p is the front arm's angle and b = theta20 + u - p the rear arm's slope below the horizontal.
The bogie stays level, its two wheels sharing a load equally.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

GRAVITY = 9.81


@dataclass(frozen=True)
class Machine:
    """The numbers the closed forms need; defaults are the robot's."""

    front_arm: float = 0.775
    rear_arm: float = 0.3907
    bogie_half: float = 0.3875
    pillar: float = 0.300
    gear: float = 1 / 2.2
    wheel_radius: float = 0.150
    belly: float = 0.200
    body_mass: float = 120.0
    body_x: float = 0.019375
    front_mass: float = 8.0
    rear_mass: float = 6.0
    bogie_mass: float = 8.0
    steer_mass: float = 19 / 6
    steer_above_wheel: float = 0.100
    wheel_mass: float = 7.0

    @property
    def drop(self) -> float:
        """Bogie's pivot below the hinge at u = p = 0: sqrt(R^2 - half^2)."""
        return math.sqrt(self.rear_arm**2 - self.bogie_half**2)

    @property
    def theta20(self) -> float:
        """Slope of the rear arm at u = p = 0."""
        return math.asin(self.drop / self.rear_arm)

    @property
    def mass(self) -> float:
        """kg."""
        side = self.front_mass + self.rear_mass + self.bogie_mass + 3 * (self.steer_mass + self.wheel_mass)
        return self.body_mass + 2 * side

    def angles(self, u: float) -> tuple[float, float, float]:
        """(a, b, p) from the closure F sin a + P (cos a - 1) = R sin b - drop.

        Its left side rises with p and its right side falls as long as F' and R' are positive: one root.
        """

        def open_by(p: float) -> float:
            a, b = self.gear * u + p, self.theta20 + u - p
            rise = self.front_arm * math.sin(a) + self.pillar * (math.cos(a) - 1)
            return rise - (self.rear_arm * math.sin(b) - self.drop)

        p = float(brentq(open_by, -0.3, 0.3, xtol=1e-15, rtol=1e-14))
        return self.gear * u + p, self.theta20 + u - p, p

    def hinge_height(self, u: float) -> float:
        """H + its value at home: R sin b - drop + pillar + r."""
        _, b, _ = self.angles(u)
        return self.rear_arm * math.sin(b) - self.drop + self.pillar + self.wheel_radius

    def clearance(self, u: float) -> float:
        """Of the belly point below the hinges: hinge height - belly cos p."""
        return self.hinge_height(u) - self.belly * math.cos(self.angles(u)[2])

    def motor_angle(self, clearance: float) -> float:
        """u for a clearance of the belly point."""
        return float(brentq(lambda u: self.clearance(u) - clearance, -0.5, 1.1, xtol=1e-14))

    def levers(self, u: float) -> tuple[float, float]:
        """(F', R') = (F cos a - P sin a, R cos b): front wheel ahead of, bogie's pivot behind the hinge."""
        a, b, _ = self.angles(u)
        return self.front_arm * math.cos(a) - self.pillar * math.sin(a), self.rear_arm * math.cos(b)

    def wheelbase(self, u: float) -> float:
        """Front to middle wheel: F' + R' - bogie's half-length."""
        ahead, behind = self.levers(u)
        return ahead + behind - self.bogie_half

    def shortening(self, u: float) -> float:
        """(d(0) - d(u)) / d(0), d the wheelbase front to middle."""
        return 1 - self.wheelbase(u) / self.wheelbase(0.0)

    def lift_rate(self, u: float, motor_rate: float) -> float:
        """dh/dt = (1 + z) du/dt / (1/F' + 1/R'), m/s, from da + db = (1 + z) du and dh = F' da = R' db."""
        ahead, behind = self.levers(u)
        return (1 + self.gear) * motor_rate / (1 / ahead + 1 / behind)

    def wheelbase_rate(self, u: float, lift_rate: float) -> float:
        """d(d_fm)/dt = -dh/dt [(F sin a + P cos a)/F' + tan b], m/s; the front wheel's speed over ground."""
        a, b, _ = self.angles(u)
        ahead, _ = self.levers(u)
        below = self.front_arm * math.sin(a) + self.pillar * math.cos(a)
        return -lift_rate * (below / ahead + math.tan(b))

    def rim_rate(self, u: float, lift_rate: float) -> float:
        """What the front wheel's encoder sees, m/s at the rim: speed over ground - r da/dt, da = dh / F'."""
        ahead, _ = self.levers(u)
        return self.wheelbase_rate(u, lift_rate) - self.wheel_radius * lift_rate / ahead

    def loads(self, u: float, gravity: float = GRAVITY) -> tuple[float, float]:
        """(front wheel, middle or rear wheel): 2 Nf + 4 N = m g and moments about the hinges' line.

        2 (Nf F' - 2 N R') = g sum(m x), x ahead of the hinges.
        """
        a, b, p = self.angles(u)
        ahead, behind = self.levers(u)
        steering = self.front_arm * math.cos(a) - (self.pillar - self.steer_above_wheel) * math.sin(a)
        side = (
            self.front_mass * self.front_arm / 2 * math.cos(a)
            + self.steer_mass * steering
            + self.wheel_mass * ahead
            - self.rear_mass * self.rear_arm / 2 * math.cos(b)
            - (self.bogie_mass + 2 * (self.steer_mass + self.wheel_mass)) * behind
        )
        moment = gravity * (self.body_mass * self.body_x * math.cos(p) + 2 * side)
        weight = self.mass * gravity
        front = (moment / 2 + weight / 2 * behind) / (ahead + behind)
        return front, (weight / 2 - front) / 2
