"""The work of a study as one object that any process can carry out, any part of it, in any order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.batch import Answered, CompiledRows
from rover_pin.analysis.cases import Case, Cases
from rover_pin.analysis.draw import Draw
from rover_pin.analysis.rovers import Rovers
from rover_pin.analysis.rows import BOUNDS, Columns, Layout, Rows, compact, count_of, cut, joined
from rover_pin.analysis.words import posture
from rover_pin.description.trace_expand import TracedText
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
    """Everything a case needs; crosses processes whole. The cases are not in it, but what draws them.

    `traced` is the robot's description as a function of the parameters that vary, for the compiled path.
    """

    rover: Rover
    terrain: Terrain
    cases: Draw
    layout: Layout
    gravity: float
    locks: tuple[str, ...]
    traced: TracedText | None = None

    def runner(self) -> Runner:
        """What carries it out in this process."""
        return Runner(self)


class Draws(Protocol):
    """Whatever knows the cases by their numbers."""

    def run(self, start: int, stop: int) -> Cases:
        """The cases from `start` to before `stop`."""
        ...


class Runner:
    """Carries out parts of a job in this process.

    A case's answer depends on nothing but the case: nothing is handed from one case to the next but rovers,
    which are the same however often they are built, and a sampler, which gives the same points whichever
    way it comes to them.
    """

    def __init__(self, job: Job, drawer: Draws | None = None) -> None:
        self.job = job
        self._rovers = Rovers(job.rover)
        self._drawer: Draws = drawer or job.cases.drawer()
        self._start = 0
        self._drawn: Cases = self._drawer.run(0, 0)

    @cached_property
    def compiled(self) -> CompiledRows | None:
        """The compiled path, or None where everything goes the plain way."""
        return CompiledRows.of(self.job)

    def case(self, i: int) -> Case:
        """Case i."""
        if not self._start <= i < self._start + len(self._drawn):
            self._draw((i, i + 1))
        return self._drawn[i - self._start]

    def _draw(self, chunk: Chunk) -> Cases:
        self._start, self._drawn = chunk[0], self._drawer.run(*chunk)
        return self._drawn

    def stance(self, i: int) -> Stance:
        """Case i at rest, by the plain path.

        Raises:
            InputError: the case cannot be posed.
        """
        from rover_pin import settle

        case = self.case(i)
        rover = self._rovers(case.parameters, case.weights)
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
        """The rows of a chunk: by the compiled path where it serves, what it leaves by the plain one.

        Raises:
            SolverError: a case failed in a way that no status describes; names the case.
        """
        start, stop = chunk
        cases = self._draw(chunk)
        if self.compiled is None:
            return self._plainly(np.arange(start, stop))
        answered = self.compiled.answer(cases)
        return (
            _completed(answered, self._plainly(start + answered.left))
            if len(answered.left)
            else answered.columns
        )

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

    def _plainly(self, which: NDArray[np.int64]) -> Columns:
        """The rows of these cases, one by one."""
        rows = Rows(self.job.layout, len(which))
        for row, i in enumerate(which.tolist()):
            try:
                self._row(rows, row, i)
            except OffMapError as error:
                rows.failed(row, str(Status.OFF_MAP), str(error))
            except InputError as error:
                rows.failed(row, INVALID, str(error))
            except SolverError as error:
                rows.failed(row, str(Status.NO_CONVERGENCE), str(error))
            except Exception as error:
                raise SolverError(f"failed: {type(error).__name__}: {error}", element=f"case {i}") from error
        return rows.columns()

    def _row(self, rows: Rows, row: int, i: int) -> None:
        """Answer case i."""
        stance = self.stance(i)
        layout = self.job.layout
        if stance.settled:
            friction = self.case(i).friction
            margins = stability(stance, layout.margins, friction=friction) if layout.margins else {}
            rows.margins(row, margins)
            if BOUNDS in layout.measures:
                from rover_pin.statics.bounds import load_bounds

                rows.bounds(row, load_bounds(stance, friction=friction))
        rows.stance(row, stance)


def _completed(answered: Answered, plain: Columns) -> Columns:
    """A chunk whose open rows are those of the plain path."""
    count = count_of(answered.columns)
    rows = np.arange(count)
    rows[answered.left] = count + np.arange(len(answered.left))
    return compact(cut(joined([answered.columns, plain]), rows))


Done = Callable[[Chunk, Columns], None]
"""What an engine calls in the parent process with each finished chunk."""
