"""Drawing cases: any run of a study's cases on demand, the same bits as if all were drawn at once."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from rover_pin.analysis.cases import POSTURE, Cases, Questions
from rover_pin.analysis.grid import Grid
from rover_pin.analysis.independent import Independent
from rover_pin.analysis.one_by_one import OneByOne
from rover_pin.analysis.saltelli import Saltelli
from rover_pin.analysis.sobol import Sobol
from rover_pin.analysis.spec import CasesSpec
from rover_pin.errors import StudyError
from rover_pin.numerics import frozen


@dataclass(frozen=True)
class Draw:
    """What the cases of a study are drawn from; a few hundred bytes, however many cases there are."""

    questions: Questions
    spec: CasesSpec
    count: int

    def __len__(self) -> int:
        """The number of cases."""
        return self.count

    @property
    def inputs(self) -> tuple[str, ...]:
        """What varies, in the order of the columns."""
        return tuple(name for name, asked in self.questions.columns.items() if asked.varies)

    @property
    def digest(self) -> str:
        """Hex of all that decides the cases (but for the version of scipy)."""
        asked = (list(self.questions.columns.items()), self.questions.postures, self.spec, self.count)
        return hashlib.sha256(repr(asked).encode()).hexdigest()

    def drawer(self) -> Drawer:
        """One that draws; each process keeps its own."""
        return Drawer(self)


class Drawer:
    """Draws runs of cases; quickest forwards, where only the gap is skipped."""

    def __init__(self, source: Draw) -> None:
        self._questions = source.questions
        self._count = source.count
        self._sampler = _sampler(source.questions, source.spec)

    def run(self, start: int, stop: int) -> Cases:
        """The cases from `start` to before `stop`.

        Raises:
            StudyError: there are no such cases.
        """
        if not 0 <= start <= stop <= self._count:
            cure = f"there are {self._count}"
            raise StudyError("no such cases", element="cases", value=f"{start} to {stop}", cure=cure)
        asked = self._questions
        drawn = self._sampler.columns(start, stop)
        return Cases(
            x=frozen(drawn["x"]),
            y=frozen(drawn["y"]),
            yaw=frozen(np.deg2rad(drawn["yaw_deg"])),
            postures=asked.postures,
            posture=drawn[POSTURE].astype(np.int64),
            friction=frozen(drawn["friction"]) if asked.friction is not None else None,
            parameters={name: frozen(drawn[name]) for name in asked.parameters},
            joints={name: frozen(drawn[name]) for name in asked.joints},
            weights={name: frozen(drawn[name]) for name in asked.weights},
        )


def draw(questions: Questions, spec: CasesSpec) -> Draw:
    """The cases of a study, none of them drawn yet.

    Raises:
        StudyError: a grid without its counts, a count of what does not vary, a distribution that the sampler
            cannot cut, or too many cases.
    """
    sampler = _sampler(questions, spec)
    return Draw(questions, spec, spec.number if isinstance(sampler, Sobol | Independent) else sampler.count)


def _sampler(questions: Questions, spec: CasesSpec) -> Sobol | Independent | Saltelli | Grid | OneByOne:
    """The sampler that the study names."""
    columns = questions.columns
    if spec.sampler == "grid":
        return Grid(columns, spec)
    if spec.sampler == "sensitivity":
        return OneByOne(columns, questions.parameters)
    if spec.sampler == "saltelli":
        return Saltelli(columns, spec.number, spec.seed)
    return (Independent if spec.sampler == "random" else Sobol)(columns, spec.seed)
