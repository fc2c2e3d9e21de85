"""HIT-MRII on level ground with clutches engaged and wheels lifted: no Pinocchio, no project code.

Every mass and wheel is placed by hand from the note's lengths. The standing wheels' gaps are closed by scipy;
then the loads are the Lagrange multipliers of the potential energy: grad V = sum N_i grad gap_i over the free
coordinates, which on level ground is equilibrium. Lengths in m, angles in rad, forces in N.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from hit_mrii_closed_form import GRAVITY, Machine
from scipy.optimize import brentq, fsolve

WHEELS = ("LF", "LM", "LB", "RF", "RM", "RB")
HINGE, WHEEL_PLANE, ARM_PLANE = 0.415, 0.652, 0.415 + 0.1185
TREAD = 0.03


def turned(angle: float, x: float, z: float) -> tuple[float, float]:
    """(x, z) pitched nose down."""
    return x * math.cos(angle) + z * math.sin(angle), -x * math.sin(angle) + z * math.cos(angle)


@dataclass(frozen=True)
class Lift:
    """Rocker and clutch values of a lift.

    Attributes:
        rockers: motor angles, left and right.
        clutches: bogies' angles, left and right; None where that clutch is open.
        lifted: names of wheels.
    """

    rockers: tuple[float, float]
    clutches: tuple[float | None, float | None]
    lifted: tuple[str, ...]
    machine: Machine = field(default_factory=Machine)

    def free(self) -> int:
        """Height, pitch, roll, differential, and every open bogie."""
        return 4 + sum(clutch is None for clutch in self.clutches)

    def bodies(self, xi):
        """Heights of wheels and masses, rise of the axis; xi = (z, pitch, roll, differential, bogies)."""
        m = self.machine
        height, pitch, roll, differential, *open_bogies = xi
        bogies = list(open_bogies)
        centres, masses = {}, [(m.body_mass, (m.body_x, 0.0, 0.0))]
        for side, y_sign, shaft, u, clutch in (
            ("L", 1.0, differential, self.rockers[0], self.clutches[0]),
            ("R", -1.0, -differential, self.rockers[1], self.clutches[1]),
        ):
            beam = bogies.pop(0) if clutch is None else clutch
            front, rear = shaft + m.gear * u, shaft - u
            arm = turned(front, m.front_arm / 2, 0.0)
            masses.append((m.front_mass, (arm[0], y_sign * ARM_PLANE, arm[1])))
            half = turned(rear, -m.bogie_half / 2, -m.drop / 2)
            masses.append((m.rear_mass, (half[0], y_sign * ARM_PLANE, half[1])))
            pivot = turned(rear, -m.bogie_half, -m.drop)
            low = turned(rear + beam, 0.0, -0.05)
            masses.append((m.bogie_mass, (pivot[0] + low[0], y_sign * WHEEL_PLANE, pivot[1] + low[1])))
            column = m.pillar - m.drop
            for name, foot, angle, along, below in (
                ("F", (0.0, 0.0), front, m.front_arm, m.pillar),
                ("M", pivot, rear + beam, m.bogie_half, column),
                ("B", pivot, rear + beam, -m.bogie_half, column),
            ):
                axle, steer = turned(angle, along, -below), turned(angle, along, m.steer_above_wheel - below)
                centre = (foot[0] + axle[0], y_sign * WHEEL_PLANE, foot[1] + axle[1])
                centres[side + name] = centre
                masses.append((m.wheel_mass, centre))
                masses.append((m.steer_mass, (foot[0] + steer[0], centre[1], foot[1] + steer[1])))
        up = np.array([-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll)])
        place = lambda point: height + float(up @ np.array(point))  # noqa: E731
        return {k: place(c) for k, c in centres.items()}, [(kg, place(p)) for kg, p in masses], up[1]

    def gaps(self, xi) -> dict[str, float]:
        """Of every wheel: a ring swept by a ball, its axis as steep as the rover rolls."""
        centres, _, steep = self.bodies(xi)
        ring = self.machine.wheel_radius - TREAD
        return {name: z - ring * math.sqrt(1.0 - steep**2) - TREAD for name, z in centres.items()}

    def energy(self, xi) -> float:
        """Of gravity, J."""
        return GRAVITY * sum(kg * z for kg, z in self.bodies(xi)[1])

    def solve(self) -> tuple[dict[str, float], dict[str, float]]:
        """(gap of the lifted wheels, load of the standing ones)."""
        standing = [wheel for wheel in WHEELS if wheel not in self.lifted]
        assert len(standing) == self.free()
        touch = lambda xi: [self.gaps(xi)[wheel] for wheel in standing]  # noqa: E731
        open_bogie = self.rockers[0] if self.clutches[0] is None else self.rockers[1]
        start = [0.6, 0.0, 0.0, 0.0, *[open_bogie] * (self.free() - 4)]
        xi, _, found, message = fsolve(touch, start, full_output=True, xtol=1e-13)
        assert found == 1, message
        rows = np.array([_slope(lambda at, w=wheel: self.gaps(at)[w], xi) for wheel in standing])
        loads = np.linalg.solve(rows.T, _slope(self.energy, xi))
        gaps = self.gaps(xi)
        return {wheel: gaps[wheel] for wheel in self.lifted}, dict(zip(standing, loads, strict=True))


def single(clearance: float, wheel: str, height: float) -> tuple[float, dict[str, float]]:
    """(angle of the rocker, loads) with one wheel lifted from a clearance, both sides alike before."""
    machine = Machine()
    start = machine.motor_angle(clearance)
    bogie = machine.angles(start)[1] - machine.theta20
    left = wheel[0] == "L"

    def at(u: float) -> Lift:
        rockers = (u, start) if left else (start, u)
        return Lift(rockers, (bogie, None) if left else (None, bogie), (wheel,))

    ways = (start, start + 0.6) if wheel[1] == "M" else (start - 0.35, start)
    u = float(brentq(lambda x: at(x).solve()[0][wheel] - height, *ways, xtol=1e-13))
    return u, at(u).solve()[1]


def front_by_hand(clearance: float, height: float) -> tuple[float, float, float]:
    """(angle of the rocker, middle, rear load of the side) with its front wheel lifted: moments on paper.

    With the clutch engaged the rear arm and the bogie stay where they are, so that the shaft turns by the
    motor's turn w and the front arm by (1 + z) w: the hinges keep their height, nothing rolls, and each side
    carries half the weight. The shafts share the body's moment equally.
    """
    m = Machine()
    u0 = m.motor_angle(clearance)
    a0, b, p0 = m.angles(u0)
    top = lambda a: m.front_arm * math.sin(a) + m.pillar * math.cos(a)  # noqa: E731
    a = float(brentq(lambda angle: top(a0) - top(angle) - height, a0 - 0.5, a0))
    w = (a - a0) / (1.0 + m.gear)
    behind = m.rear_arm * math.cos(b)
    ahead, steer = (
        turned(a, m.front_arm, -m.pillar)[0],
        turned(a, m.front_arm, m.steer_above_wheel - m.pillar)[0],
    )
    wheel_and_steer = m.wheel_mass + m.steer_mass
    gravity = GRAVITY * (
        m.front_mass * turned(a, m.front_arm / 2, 0.0)[0]
        + m.wheel_mass * ahead
        + m.steer_mass * steer
        - m.rear_mass * behind / 2
        - (m.bogie_mass + 2 * wheel_and_steer) * behind
    )
    body = GRAVITY * m.body_mass * m.body_x * math.cos(p0 + w / 2) / 2
    half = m.mass * GRAVITY / 2
    # N_M + N_B = half and N_M x_M + N_B x_B = gravity + body, x_B = x_M - 2 bogie_half
    middle_x = m.bogie_half - behind
    rear = (half * middle_x - gravity - body) / (2 * m.bogie_half)
    return u0 + w, half - rear, rear


def _slope(function, xi):
    xi = np.asarray(xi)
    step = 1e-5
    return np.array([(function(xi + d) - function(xi - d)) / (2 * step) for d in step * np.eye(len(xi))])
