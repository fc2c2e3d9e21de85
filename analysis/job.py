"""The work of a study as one object that any process can carry out, any part of it, in any order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rover_pin.analysis.cases import Case, Cases
from rover_pin.analysis.rovers import Rovers
from rover_pin.analysis.rows import BOUNDS, Columns, Layout, Rows
from rover_pin.analysis.words import posture
from rover_pin.errors import InputError, OffMapError, SolverError, StudyError
from rover_pin.rover import Rover
from rover_pin.stability.report import stability
from rover_pin.statics.stance import Stance, Status
from rover_pin.terrain import Terrain

INVALID = "invalid"
"""Status of a case whose posture or parameters the rover cannot take."""

Chunk = tuple[int, int]
"""Cases from the first to before the second."""


@dataclass(frozen=True)
class Job:
    """Everything a case needs; crosses processes whole."""

    rover: Rover
    terrain: Terrain
    cases: Cases
    layout: Layout
    gravity: float
    locks: tuple[str, ...]

    def runner(self) -> Runner:
        """What carries it out in this process."""
        return Runner(self)


class Runner:
    """Carries out parts of a job in this process.

    A case's answer depends on nothing but the case: nothing is handed from one case to the next but rovers,
    which are the same however often they are built.
    """

    def __init__(self, job: Job) -> None:
        self.job = job
        self._rovers = Rovers(job.rover)

    def stance(self, i: int) -> Stance:
        """Case i at rest.

        Raises:
            InputError: the case cannot be posed.
        """
        from rover_pin import settle

        case = self.job.cases[i]
        rover = self._rovers(case.parameters)
        shapes, wheels = tuple(shape.name for shape in rover.shapes), self.job.layout.wheels
        if shapes != wheels or tuple(rover.joints) != self.job.layout.joints:
            raise StudyError("the parameters change which joints or wheels there are", file=rover.source)
        return settle(
            rover,
            self.job.terrain,
            x=case.x,
            y=case.y,
            yaw=case.yaw,
            posture=None if case.posture is None else posture(case.posture),
            joints=dict(case.joints) or None,
            locks=self.job.locks,
            gravity=self.job.gravity,
        )

    def run(self, chunk: Chunk) -> Columns:
        """The rows of a chunk.

        Raises:
            SolverError: a case failed in a way that no status describes; names the case.
        """
        start, stop = chunk
        rows = Rows(self.job.layout, stop - start)
        for i in range(start, stop):
            try:
                self._row(rows, i - start, i)
            except OffMapError as error:
                rows.failed(i - start, str(Status.OFF_MAP), str(error))
            except InputError as error:
                rows.failed(i - start, INVALID, str(error))
            except SolverError as error:
                rows.failed(i - start, str(Status.NO_CONVERGENCE), str(error))
            except Exception as error:
                raise SolverError(f"failed: {type(error).__name__}: {error}", element=f"case {i}") from error
        return rows.columns()

    def first(self) -> None:
        """Pose the first case, so that bad input is found before anything is written.

        Raises:
            InputError: the first case cannot be posed; being off the map is an answer.
        """
        rows = Rows(self.job.layout, 1)
        try:
            self._row(rows, 0, 0)
        except (OffMapError, SolverError):
            return

    def _row(self, rows: Rows, row: int, i: int) -> None:
        """Answer case i."""
        case: Case = self.job.cases[i]
        stance = self.stance(i)
        layout = self.job.layout
        if stance.settled:
            margins = stability(stance, layout.margins, friction=case.friction) if layout.margins else {}
            rows.margins(row, margins)
            if BOUNDS in layout.measures:
                from rover_pin.statics.bounds import load_bounds

                rows.bounds(row, load_bounds(stance, friction=case.friction))
        rows.stance(row, stance)


Done = Callable[[Chunk, Columns], None]
"""What an engine calls in the parent process with each finished chunk."""
