"""The `search:` entry of a study file."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from rover_pin.analysis.finite import number
from rover_pin.analysis.strict import Strict
from rover_pin.errors import StudyError

Bounds = tuple[float | None, float | None]
"""Least and greatest value; None where there is none."""


def _bounds(raw: Any) -> Any:
    if not isinstance(raw, list | tuple) or len(raw) != 2 or raw[0] is raw[1] is None:
        raise StudyError("is no pair of bounds", value=raw, cure="write [least, most], or [null, most]")
    low, high = (None if each is None else number(each) for each in raw)
    if low is not None and high is not None and low > high:
        raise StudyError("range is upside down", value=[low, high], cure="write the lesser number first")
    return low, high


class SearchSpec(Strict):
    """What is looked for among the designs that `vary.parameters` spans.

    Attributes:
        minimise, maximise: a figure's name; one of the two.
        subject_to: figure's name to its bounds; `tension_n` is every track, `load_n` every wheel.
        trials: designs that are tried; the first is the nominal one.
        seed: of the sampler.
        over: where several places are asked of a design, what of the figure counts: its mean, or its worst.
    """

    minimise: str | None = None
    maximise: str | None = None
    subject_to: dict[str, Annotated[Bounds, BeforeValidator(_bounds)]] = Field(default_factory=dict)
    trials: int = Field(default=200, ge=1, le=100_000)
    seed: int = Field(default=0, ge=0, lt=2**32)
    over: Literal["mean", "worst"] = "mean"

    @model_validator(mode="before")
    @classmethod
    def _with_spaces(cls, raw: Any) -> Any:
        """`subject to` is the same as `subject_to`; one goal."""
        if not isinstance(raw, dict):
            return raw
        told = {str(key).replace(" ", "_"): value for key, value in raw.items()}
        goals = [key for key in ("minimise", "maximise") if told.get(key) is not None]
        if len(goals) != 1:
            what = "has two goals" if goals else "has no goal"
            cure = "keep one" if goals else "write minimise: load_spread, say"
            raise StudyError(what, value=" and ".join(goals) or None, cure=cure)
        return told

    @property
    def goal(self) -> str:
        """The figure that is looked at."""
        return self.minimise or self.maximise or ""

    @property
    def sign(self) -> float:
        """1 where less is better, -1 where more is."""
        return 1.0 if self.minimise else -1.0
