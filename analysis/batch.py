"""Chunks through the compiled path: its answers as columns, without a loop over the cases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.cases import Cases
from rover_pin.analysis.rows import EDGES, PLAIN, POSE, RESIDUALS, TENSION, Columns, Layout, coded
from rover_pin.analysis.vocabulary import Words, tight
from rover_pin.analysis.weights import changes_of
from rover_pin.analysis.words import posture
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    from rover_pin.analysis.job import Job
    from rover_pin.compiled import Answers, Batch


@dataclass(frozen=True)
class Answered:
    """A chunk as the compiled path has it: every row's columns, and the rows left for the plain path."""

    columns: Columns
    left: NDArray[np.int64]


class CompiledRows:
    """The compiled path for one job."""

    def __init__(self, job: Job, batch: Batch) -> None:
        self._batch = batch
        self._layout = job.layout

    @classmethod
    def of(cls, job: Job) -> CompiledRows | None:
        """The compiled path, where it serves this rover, this terrain and every measure asked for."""
        from rover_pin.compiled import COMPILED_MEASURES, Batch

        if not set(job.layout.measures) <= set(COMPILED_MEASURES):
            return None
        names = tuple(job.cases.questions.parameters)
        if names and job.traced is None:
            return None
        batch = Batch(
            job.rover,
            job.terrain,
            gravity=job.gravity,
            locks=job.locks,
            measures=job.layout.margins,
            **_designs(job, names),
        )
        return None if batch.refusal else cls(job, batch)

    def answer(self, cases: Cases) -> Answered:
        """The rows of some cases."""
        from rover_pin.compiled import OPEN

        answers = self._batch.answer(
            cases.x,
            cases.y,
            cases.yaw,
            postures=tuple(posture(word) for word in cases.postures) or (None,),
            posture=cases.posture,
            joints=cases.joints or None,
            parameters=cases.parameters or None,
            changes=changes_of(cases.weights) if cases.weights else None,
        )
        return Answered(as_columns(answers, self._layout), np.flatnonzero(answers.code == OPEN))


def _designs(job: Job, names: tuple[str, ...]) -> dict[str, Any]:
    """What `Batch` is told of parameters that vary."""
    if not names:
        return {}
    from rover_pin.compiled import Designs

    return {"designs": Designs(job.rover, names, job.traced)}


def as_columns(answers: Answers, layout: Layout) -> Columns:
    """Answers in the form of `Rows.columns`; rows that are open say nothing yet."""
    from rover_pin.compiled import SETTLED

    status, reason = _endings(answers)
    out: Columns = {**coded("status", status), **coded("reason", reason)}
    out[PLAIN] = np.zeros(len(answers.code), dtype=np.int8)
    for name in (*POSE, *RESIDUALS):
        out[name] = getattr(answers, name)
    out["redundant"] = np.where(answers.code == SETTLED, answers.redundant, np.nan)
    for name in layout.margins:
        out[name] = answers.value[name]
    out |= {"load_n": answers.load_n, "joint_rad": answers.joint_rad}
    if layout.tracks:
        out[TENSION] = answers.tension_n
    for name in layout.margins:
        names, table, limiting = answers.labelled(name)
        out |= coded(f"{name}_limiting", Words.picked(limiting + 1, ["", *names]))
        said = ~np.isnan(table).all(axis=0)
        out[EDGES + name] = tight(np.array(names, dtype=np.str_)[said])
        out[f"{name}_edge"] = table if said.all() else table[:, said]
    return out


def _endings(answers: Answers) -> tuple[Words, Words]:
    """Status and reason of each case; reasons are spelled only where there are any."""
    from rover_pin.compiled import GROUNDED, OFF_MAP, SETTLED

    known: Sequence[str] = ("", str(Status.SETTLED), str(Status.GROUNDED), str(Status.OFF_MAP))
    place = np.zeros(256, dtype=np.int64)
    place[[SETTLED, GROUNDED, OFF_MAP]] = 1, 2, 3
    status = place[answers.code]
    code: NDArray[Any] = np.zeros(len(status), dtype=np.int64)
    reasons: list[str] = [""]
    failed = np.flatnonzero(status > 1)
    if len(failed):
        told = Words.of(np.asarray(answers.words()[1])[failed])
        reasons += [str(reason) for reason in told.known]
        code[failed] = told.code.astype(np.int64) + 1
    return Words.picked(status, known), Words.picked(code, reasons)
