"""Tables 6, 7 and 8, and what the prose of section 5.1 says beside them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.finding import Finding, claimed, compared, fitted
from rover_pin.analysis.papers.polibot.ground import on_obstacle
from rover_pin.analysis.papers.polibot.reading import Reading, front_wheel, read, rear_wheel, wheel_centers
from rover_pin.mechanism.kinematics import Kinematics
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance

WHOLE_MASS, PAYLOAD = 96.2, 80.0  # kg, Table 5 and section 5.1.1
HEIGHT = 0.055  # m, of the obstacles of Table 8

TABLE_6 = {
    "X_A": ("mm", 311.0, 303.9),
    "Z_A": ("mm", 303.3, 309.4),
    "theta": ("deg", 4.41, 4.02),
    "theta_1": ("deg", 61.6, 59.1),
    "theta_2": ("deg", 38.3, 40.8),
    "theta_3": ("deg", 71.6, 72.2),
    "theta_4": ("deg", 52.2, 53.5),
}
"""Unit, the paper's model, its measurement."""

TABLE_7 = {"Z_A": ("mm", 291.2, 300.5), "theta": ("deg", 2.61, 3.04)}
TABLE_8 = {
    "W3": {"Z_A": ("mm", 307.9, 318.0), "theta": ("deg", -2.69, -2.98)},
    "W6": {"Z_A": ("mm", 307.8, 313.0), "theta": ("deg", 7.31, 8.07)},
}

USED = "the robot's geometry was identified from this column, so agreement is no evidence"


@dataclass(frozen=True, eq=False)
class Stances:
    """The four stances of section 5.1, of one rover.

    Attributes:
        rover: the half model.
    """

    rover: Rover

    @cached_property
    def baseline(self) -> Stance:
        """At rest on level ground."""
        return settle(self.rover, Terrain.flat())

    @cached_property
    def payload(self) -> Stance:
        """With 80 kg more on the whole robot, the centre of mass where it was."""
        heavier = self.rover.parameters["mass"] * (1.0 + PAYLOAD / WHOLE_MASS)
        return settle(self.rover.with_parameters(mass=heavier), Terrain.flat())

    @cached_property
    def front(self) -> Stance:
        """With the obstacle under the front road wheel."""
        return on_obstacle(self.rover, front_wheel(self.rover), HEIGHT, self.baseline)

    @cached_property
    def rear(self) -> Stance:
        """With the obstacle under the rear road wheel."""
        return on_obstacle(self.rover, rear_wheel(self.rover), HEIGHT, self.baseline)


def findings(stances: Stances) -> list[Finding]:
    """Every row of section 5.1."""
    rest, heavy, front, rear = (
        read(s) for s in (stances.baseline, stances.payload, stances.front, stances.rear)
    )
    return [
        *_table("Table 6", "", TABLE_6, rest),
        *_table("Table 7", "80 kg payload: ", TABLE_7, heavy),
        *_table("Table 8", "55 mm under W3: ", TABLE_8["W3"], front),
        *_table("Table 8", "55 mm under W6: ", TABLE_8["W6"], rear),
        *_errors(rest, front, rear),
        *_prose(rest, heavy, front, rear),
        *_independent(stances),
    ]


def values(reading: Reading) -> dict[str, float]:
    """By the tables' names."""
    arms = {f"theta_{k}": value for k, value in enumerate(reading.arms, 1)}
    return {"X_A": reading.x_a, "Z_A": reading.z_a, "theta": reading.theta, **arms}


def _table(where: str, case: str, rows: dict[str, tuple[str, float, float]], found: Reading) -> list[Finding]:
    ours = values(found)
    return [
        fitted(f"{case}{name}", unit, model, ours[name], where=where, measured=measured, why=USED)
        for name, (unit, model, measured) in rows.items()
    ]


def _errors(rest: Reading, front: Reading, rear: Reading) -> list[Finding]:
    """What the paper says of its model's errors to the real robot, of ours."""
    ours = values(rest)
    off = [100.0 * abs(ours[name] / real - 1.0) for name, (_, _, real) in TABLE_6.items()]
    steps = {
        name: [
            100.0 * abs(values(found)[name] / TABLE_8[case][name][2] - 1.0)
            for case, found in (("W3", front), ("W6", rear))
        ]
        for name in ("Z_A", "theta")
    }
    why = "follows from columns that the geometry was identified from"
    said = (
        ("mean error to the real robot, Table 6", 4.0, float(np.mean(off)), "Section 5.1.1"),
        ("largest error to the real robot, Table 6", 10.0, max(off), "Section 5.1.1"),
        ("largest pitch error, Table 8", 10.0, max(steps["theta"]), "Section 5.1.2"),
        ("largest height error, Table 8", 3.0, max(steps["Z_A"]), "Section 5.1.2"),
    )
    return [
        compared(name, "%", paper, found, within=0.5, where=where, used=True, why=why)
        for name, paper, found, where in said
    ]


def _prose(rest: Reading, heavy: Reading, front: Reading, rear: Reading) -> list[Finding]:
    shorter = sum(heavy.springs[name] > force for name, force in rest.springs.items()) if heavy.springs else 0
    return [
        compared("80 kg payload: drop of Z_A", "mm", 12.0, rest.z_a - heavy.z_a, within=0.5,
                 where="Section 5.1.1", used=True, why="the difference of Tables 6 and 7"),
        compared("80 kg payload: change of pitch", "deg", 1.0, rest.theta - heavy.theta, within=0.05,
                 where="Section 5.1.1",
                 why="the prose rounds the measurements (4.02 - 3.04 = 0.98); the paper's own model columns"
                 " give 4.41 - 2.61 = 1.80"),
        claimed("80 kg payload: springs pressed further", "", "all 3", shorter, shorter == 3,
                where="Section 5.1.1", why="forces in the springs, beside those without the payload"),
        compared("55 mm under W3: pitch in the prose", "deg", -2.98, front.theta, within=0.005,
                 where="Section 5.1.2",
                 why="the prose quotes the measured value; Table 8 gives -2.69 for the model"),
        compared("55 mm under W6: rise of pitch in the prose", "deg", 3.3, rear.theta - rest.theta,
                 within=0.05, where="Section 5.1.2",
                 why="the paper's own model columns give 7.31 - 4.41 = 2.90"),
    ]  # fmt: skip


def _independent(stances: Stances) -> list[Finding]:
    """Statements elsewhere in the paper that the identification did not use."""
    rover, rest = stances.rover, stances.baseline
    centers = wheel_centers(rest)
    base = 1e3 * float(centers[front_wheel(rover)][0] - centers[rear_wheel(rover)][0])
    teeth = _teeth(rest)
    return [
        compared("wheelbase, W3 to W6", "mm", 630.0, base, within=5.0, where="Section 5.3",
                 why="at rest on level ground; not used in the identification"),
        claimed("sprocket's teeth engaged", "", "at least 3", teeth, teeth >= 3.0, where="Section 3",
                why="arc of the track on the sprocket over the pitch of 26 mm; not used in identifying"),
    ]  # fmt: skip


def _teeth(stance: Stance) -> float:
    """Pitches of the belt that lie on the first wheel of the track."""
    rover = stance.rover
    track = rover.tracks[0]
    wrap = track.wrap(Kinematics(rover.model, rover.model.createData(), stance.configuration))
    k = next(k for k, circle in enumerate(track.circles) if circle.name == rover.wheels[0].name)
    return float(wrap.turns[k] * wrap.rho[k] / 0.026)
