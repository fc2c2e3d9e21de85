"""The work of a mobility map as one object: any process can answer any rows of it, in any order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.job import INVALID, Chunk
from rover_pin.analysis.mobility.cells import best_and_worst, commonest_failure
from rover_pin.analysis.mobility.outcome import FROM_CODE, OUTCOMES, STANDS, UNANSWERED
from rover_pin.analysis.rows import Columns
from rover_pin.compiled import Batch
from rover_pin.errors import InputError, OffMapError, SolverError
from rover_pin.numerics import Array
from rover_pin.rover import Rover
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import stability
from rover_pin.statics.stance import Status
from rover_pin.terrain import Terrain

Posture = str | Mapping[str, float] | None
"""What `rover_pin.settle` takes."""


@dataclass(frozen=True)
class Survey:
    """A rover set down on every place (x, y) in every heading.

    Attributes:
        rover, terrain: what stands on what.
        x: (columns,) m.
        y: (rows,) m.
        yaw: (headings,) rad.
        measure: name of the measure of every stance.
        posture: as `rover_pin.settle` takes it.
        gravity: m/s2.
    """

    rover: Rover
    terrain: Terrain
    x: Array
    y: Array
    yaw: Array
    measure: str
    posture: Posture
    gravity: float

    @property
    def cases_a_row(self) -> int:
        """Columns times headings."""
        return len(self.x) * len(self.yaw)

    def runner(self) -> Surveyor:
        """What answers rows, in this process."""
        return Surveyor(self)

    def stand(self, x: float, y: float, yaw: float) -> tuple[int, float]:
        """One case by the plain path: its outcome's number; the measure's value where it stands, else NaN.

        Raises:
            SolverError: it failed in a way that no status describes; names the place.
        """
        from rover_pin import settle

        try:
            stance = settle(
                self.rover, self.terrain, x=x, y=y, yaw=yaw, posture=self.posture, gravity=self.gravity
            )
            value = stability(stance, [self.measure])[self.measure].value if stance.settled else np.nan
        except OffMapError:
            return OUTCOMES.index(str(Status.OFF_MAP)), np.nan
        except InputError:
            return OUTCOMES.index(INVALID), np.nan
        except SolverError:
            return OUTCOMES.index(str(Status.NO_CONVERGENCE)), np.nan
        except Exception as error:
            where = f"x {x:g}, y {y:g} m, yaw {yaw:g} rad"
            raise SolverError(f"failed: {type(error).__name__}: {error}", element=where) from error
        return OUTCOMES.index(str(stance.status)), value


@dataclass(frozen=True)
class Surveyor:
    """Answers rows of a survey in this process; a cell's answer depends on nothing but the cell."""

    survey: Survey

    @cached_property
    def batch(self) -> Batch:
        """The compiled path."""
        asked = self.survey
        return Batch(asked.rover, asked.terrain, gravity=asked.gravity, measures=(asked.measure,))

    def run(self, chunk: Chunk) -> Columns:
        """Rows `chunk[0]` to before `chunk[1]` of the map.

        Returns:
            `worst`, `best`, `worst_yaw_rad`, `best_yaw_rad`, `settled_share`, `status`, each (rows, columns);
            `outcomes` (rows, kinds) counts cases by how they ended, `to_plain_path` (rows,) those that the
            compiled path left open.
        """
        asked = self.survey
        y, x, yaw = np.meshgrid(asked.y[chunk[0] : chunk[1]], asked.x, asked.yaw, indexing="ij")
        outcome, value = self.answer(x.ravel(), y.ravel(), yaw.ravel())
        open_cases = outcome == UNANSWERED
        for i in np.flatnonzero(open_cases):
            place = float(x.ravel()[i]), float(y.ravel()[i]), float(yaw.ravel()[i])
            outcome[i], value[i] = asked.stand(*place)
        outcome, value = outcome.reshape(x.shape), value.reshape(x.shape)
        settled = outcome == STANDS
        counts = np.stack([np.sum(outcome == k, axis=(1, 2)) for k in range(len(OUTCOMES))], axis=1)
        return {
            **best_and_worst(value, settled, asked.yaw, MEASURES[asked.measure].better),
            "settled_share": settled.mean(axis=2),
            "status": commonest_failure(outcome, len(OUTCOMES)),
            "outcomes": counts,
            "to_plain_path": open_cases.reshape(x.shape).sum(axis=(1, 2)),
        }

    def answer(self, x: Array, y: Array, yaw: Array) -> tuple[NDArray[np.int64], Array]:
        """(n,) outcome's number, `UNANSWERED` where the compiled path leaves it open; (n,) value or NaN."""
        answers = self.batch.answer(x, y, yaw, postures=(self.survey.posture,))
        outcome = np.empty(len(x), dtype=np.int64)
        for code, number in FROM_CODE.items():
            outcome[answers.code == code] = number
        return outcome, np.array(answers.value[self.survey.measure], dtype=np.float64)
