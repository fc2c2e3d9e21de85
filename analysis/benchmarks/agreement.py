"""How near the answers of two methods are: the largest difference, by unit."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from rover_pin.analysis.benchmarks.plain import Answered
from rover_pin.analysis.benchmarks.scene import Scene
from rover_pin.compiled import GROUNDED, OFF_MAP, OPEN, SETTLED, Answers
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.stance import Stance, Status

WORDS = {SETTLED: str(Status.SETTLED), GROUNDED: str(Status.GROUNDED), OFF_MAP: str(Status.OFF_MAP)}


@dataclass
class Agreement:
    """Differences gathered case by case.

    Attributes:
        largest: unit -> largest difference.
        compared: cases in which both stand.
        other_status: cases that ended differently.
    """

    largest: dict[str, float] = field(default_factory=lambda: defaultdict(float))
    compared: int = 0
    other_status: int = 0

    def add(self, unit: str, one: float, other: float) -> None:
        """Compare two numbers; infinite ones of a sign agree, a missing one never does."""
        apart = 0.0 if one == other else abs(one - other)
        self.largest[unit] = max(self.largest[unit], np.inf if np.isnan(apart) else float(apart))

    def told(self) -> dict[str, object]:
        """As a row has it."""
        known = dict(self.largest) if self.compared else None
        return {"agreement": known, "compared": self.compared, "other_status": self.other_status}


def compare(scene: Scene, answers: Answers, plain: Sequence[Answered]) -> Agreement:
    """The compiled path's first cases beside the plain path's; cases left open are not compared."""
    found = Agreement()
    for i, each in enumerate(plain):
        code = int(answers.code[i])
        if code == OPEN:
            continue
        if WORDS[code] != each.status:
            found.other_status += 1
        elif each.stance is not None and each.stance.settled:
            found.compared += 1
            _stances(found, scene, answers, i, each.stance)
            for name, value in each.values.items():
                if name in answers.value:
                    found.add(MEASURES[name].unit, float(answers.value[name][i]), value)
    return found


def _stances(found: Agreement, scene: Scene, answers: Answers, i: int, stance: Stance) -> None:
    """Pose, joints and loads of one case."""
    rover = scene.rover
    found.add("m", float(answers.z_m[i]), float(stance.position[2]))
    found.add("rad", float(answers.roll_rad[i]), float(stance.rpy[0]))
    found.add("rad", float(answers.pitch_rad[i]), float(stance.rpy[1]))
    for k, name in enumerate(rover.joints):
        unit = "rad" if rover.turning[rover.column[name]] else "m"
        found.add(unit, float(answers.joint_rad[i, k]), stance.joints[name])
    for k, shape in enumerate(rover.shapes):
        found.add("N", float(answers.load_n[i, k]), stance.loads[shape.name])
