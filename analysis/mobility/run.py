"""mobility: the worst and the best heading of a rover at every node of a height map."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.engines import Resources
from rover_pin.analysis.engines import engine as find_engine
from rover_pin.analysis.mobility.result import as_dataset
from rover_pin.analysis.mobility.survey import Posture, Survey
from rover_pin.compiled import COMPILED_MEASURES
from rover_pin.errors import InputError, TerrainError, nearest
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import inapplicable

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.job import Chunk
    from rover_pin.analysis.rows import Columns
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

BLOCK_CASES = 50_000
"""About how many cases one call of the compiled path answers: enough to be quick, and little memory."""

Progress = Callable[[int, int], None]
"""Called with the number of cases finished and of all cases."""


def mobility(
    rover: Rover,
    terrain: Terrain,
    headings: int = 16,
    measure: str = "tip",
    *,
    posture: Posture = None,
    every: int = 1,
    gravity: float = 9.81,
    engine: str = "serial",
    workers: int | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """How a rover stands at every node of a height map, in every heading.

    The values hang neither on the engine nor on its workers. Memory holds the answer of every cell and the
    cases of a few rows.

    Args:
        rover: what stands.
        terrain: a height map.
        headings: how many, evenly over the circle, the first along +x.
        measure: one of the cheap measures.
        posture: as for `rover_pin.settle`.
        every: take every n-th node along x and y.
        gravity: m/s2.
        engine: `serial` or `process`.
        workers: worker processes; None for one a core.
        progress: called with finished and all cases.

    Returns:
        Dimensions y, x; `worst` and `best` (the measure over the headings that settle), `worst_yaw_rad`,
        `best_yaw_rad`, `settled_share`, `status` (0 where every heading settles, else the commonest failure);
        NaN where none settles. `outcomes` counts all cases by how they ended.

    Raises:
        InputError: a measure, posture or number that cannot be used.
        TerrainError: a terrain that is no grid, or one too small for the rover.
        SolverError: a case failed in a way that no status describes.
    """
    survey = _survey(rover, terrain, headings, measure, posture, every, gravity)
    resources = Resources(workers)
    chosen = find_engine(engine, resources)
    rows, cases = len(survey.y), survey.cases_a_row
    size = max(1, min(BLOCK_CASES // cases, math.ceil(rows / chosen.workers(resources))))
    blocks = [(start, min(start + size, rows)) for start in range(0, rows, size)]
    parts: dict[Chunk, Columns] = {}
    finished = 0

    def done(block: Chunk, columns: Columns) -> None:
        nonlocal finished
        parts[block] = columns
        finished += block[1] - block[0]
        if progress is not None:
            progress(finished * cases, rows * cases)

    if progress is not None:
        progress(0, rows * cases)
    chosen.run(survey, blocks, resources, done)
    return as_dataset(survey, [parts[block] for block in blocks])


def _survey(
    rover: Rover, terrain: Terrain, headings: int, measure: str, posture: Posture, every: int, gravity: float
) -> Survey:
    """The work, every word of it checked."""
    _check_measure(rover, measure)
    for name, value in (("headings", headings), ("every", every)):
        if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
            raise InputError("must be a whole number, at least 1", element=name, value=value)
    if terrain.nodes is None or not terrain.bounded:
        cure = "give a height map's file, rough:SEED,RMS,HURST, or Terrain.from_grid"
        raise TerrainError("a mobility map needs the nodes of a grid", element=terrain.label, cure=cure)
    span = rover.wheel_span
    terrain.require_room(span, f"{rover.name}, whose wheels are {span:.3g} m apart")
    x, y = (nodes[::every] for nodes in terrain.nodes)
    yaw = 2.0 * np.pi * np.arange(headings) / headings
    survey = Survey(rover, terrain, x, y, yaw, measure, posture, gravity)
    _try(survey)
    return survey


def _check_measure(rover: Rover, measure: str) -> None:
    """Refuse a measure that there is not, that is not cheap, or that the rover cannot have."""
    if measure not in COMPILED_MEASURES:
        known = f"give one of {', '.join(COMPILED_MEASURES)}"
        if measure in MEASURES:
            raise InputError("takes too long for a map", element="measure", value=measure, cure=known)
        cure = nearest(str(measure), COMPILED_MEASURES)
        raise InputError("no such measure", element="measure", value=measure, cure=cure)
    missing = inapplicable(rover, [measure])
    if missing:
        raise InputError(f"{rover.name} cannot have it: {missing[measure]}", element="measure", value=measure)


def _try(survey: Survey) -> None:
    """Set the rover down in the middle of the map by either path, before the work begins.

    The plain path finds bad input; the compiled one leaves its kernels on disk, where workers find them.
    """
    from rover_pin import settle

    x, y = float(survey.x[len(survey.x) // 2]), float(survey.y[len(survey.y) // 2])
    settle(survey.rover, survey.terrain, x=x, y=y, posture=survey.posture, gravity=survey.gravity)
    survey.runner().answer(np.array([x]), np.array([y]), np.zeros(1))
