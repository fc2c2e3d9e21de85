"""One robot on one ground by every method, each answer beside the plain path's."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pinocchio as pin

from rover_pin.analysis.benchmarks.agreement import Agreement, compare
from rover_pin.analysis.benchmarks.clock import NOTHING
from rover_pin.analysis.benchmarks.compiled import Timed, make, slowest_ms, time_compiled
from rover_pin.analysis.benchmarks.mujoco_model import cannot
from rover_pin.analysis.benchmarks.mujoco_peer import Dropper, Rest
from rover_pin.analysis.benchmarks.plain import Answered, answer_plainly, total
from rover_pin.analysis.benchmarks.plain import slowest_ms as slowest_plain_ms
from rover_pin.analysis.benchmarks.row import COMPILED, MUJOCO, PLAIN, Row, rates
from rover_pin.analysis.benchmarks.scene import Places, Scene
from rover_pin.analysis.benchmarks.size import Size
from rover_pin.compiled import Batch
from rover_pin.errors import OffMapError
from rover_pin.statics.settle import settle

WORKS = ("settle", "row")
SLOWEST = "slowest case"
MOST_DROPS = 3  # for each pose in which it has to rest


@dataclass(frozen=True)
class SceneBench:
    """Measures one scene; what several rows need is done once."""

    scene: Scene
    size: Size

    @cached_property
    def places(self) -> Places:
        """Of the compiled path; the others take the first of them."""
        return self.scene.places(self.size.cases)

    @cached_property
    def batch(self) -> Batch:
        """For settles alone."""
        return make(self.scene)

    def measures(self, work: str) -> tuple[str, ...]:
        """What a work asks for beside the stance."""
        return self.scene.measures if work == "row" else ()

    @cached_property
    def plain(self) -> dict[str, list[Answered]]:
        """By work."""
        first = self.places.first(self.size.plain)
        return {work: answer_plainly(self.scene, first, self.measures(work)) for work in WORKS}

    @cached_property
    def settles(self) -> Timed:
        """The compiled path without measures."""
        return time_compiled(self.batch, self.places, self.size.times)

    @cached_property
    def left_open(self) -> list[Answered]:
        """Cases that the compiled path leaves, by the plain path one by one."""
        chosen = self.settles.open[: self.size.open_alone]
        places = self.places
        return answer_plainly(self.scene, Places(places.x[chosen], places.y[chosen], places.yaw[chosen]))

    def compiled_rows(self) -> list[Row]:
        """`settle` and `row`."""
        full = make(self.scene, self.measures("row"))
        timed = {"settle": self.settles, "row": time_compiled(full, self.places, self.size.times)}
        return [self._compiled_row(work, each) for work, each in timed.items()]

    def _compiled_row(self, work: str, timed: Timed) -> Row:
        count, left = len(self.places), len(timed.open)
        agreement = compare(self.scene, timed.answers[0], self.plain[work])
        each = total(self.left_open).wall / max(len(self.left_open), 1)
        return self._row(
            work,
            COMPILED,
            **rates(count - left, timed.spent) | {"cases": count},
            to_plain_path=left / count,
            per_second_with_plain=count / (timed.spent.wall + left * each),
            **agreement.told(),
        )

    def slowest_row(self) -> Row:
        """The slowest case: of those left open by the plain path, of a sample by the compiled path alone."""
        closed = np.setdiff1d(np.arange(self.size.alone), self.settles.open)
        alone = slowest_ms(self.batch, self.places, closed)
        slow = [alone, slowest_plain_ms(self.left_open)] if self.left_open else [alone]
        return self._row(
            SLOWEST, COMPILED, cases=len(closed) + len(self.left_open), slowest_ms=max(slow),
            to_plain_path=len(self.settles.open) / len(self.places),
        )  # fmt: skip

    def plain_rows(self) -> list[Row]:
        """`settle` and `row`."""
        return [
            self._row(work, PLAIN, **rates(len(each), total(each)), slowest_ms=slowest_plain_ms(each))
            for work, each in self.plain.items()
        ]

    def mujoco_row(self) -> tuple[Row | None, str]:
        """`settle` by dropping, and why there is none."""
        why = cannot(self.scene.rover)
        if why:
            return None, f"it cannot say {why}"
        dropper = Dropper(self.scene.rover, self.scene.terrain)
        rests: list[Rest] = []
        drops = 0
        while len(rests) < self.size.resting and drops < min(
            MOST_DROPS * self.size.resting, len(self.places)
        ):
            i = drops
            rest = dropper.drop(float(self.places.x[i]), float(self.places.y[i]), float(self.places.yaw[i]))
            rests += [rest] if rest.resting else []
            drops += 1
        if not rests:
            return None, f"none of {drops} drops came to rest"
        time = sum((rest.spent for rest in rests), NOTHING)
        agreement = _compare_rests(self.scene, rests).told()
        row = self._row("settle", MUJOCO, **rates(len(rests), time), **agreement)
        short = "" if len(rests) >= self.size.resting else f"only {len(rests)} of {drops} drops came to rest"
        return replace(row, unsettled=drops - len(rests)), short

    def _row(self, work: str, method: str, **measured: Any) -> Row:
        scene = self.scene
        return Row(work, scene.rover.name, scene.kind, scene.terrain.label, method, **measured)


def _compare_rests(scene: Scene, rests: list[Rest]) -> Agreement:
    """Height and tilt beside the plain path's, where the simulator came to rest."""
    found = Agreement()
    for rest in rests:
        try:
            stance = settle(scene.rover, scene.terrain, x=rest.position[0], y=rest.position[1], yaw=rest.yaw)
        except OffMapError:
            found.other_status += 1
            continue
        if not stance.settled:
            found.other_status += 1
            continue
        found.compared += 1
        upward = pin.rpy.rpyToMatrix(*(float(angle) for angle in stance.rpy))[:, 2]
        found.add("m", float(rest.position[2]), float(stance.position[2]))
        found.add("rad", math.acos(min(1.0, float(upward @ rest.rotation[:, 2]))), 0.0)
    return found
