"""The study file as a model: every value checked that can be checked without the robot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, field_validator, model_validator

from rover_pin.analysis.chance import KEYS
from rover_pin.analysis.finite import number
from rover_pin.analysis.ground import ground
from rover_pin.analysis.measures import known_measures
from rover_pin.analysis.quantities import (
    MAP,
    OptionalField,
    PlaceField,
    Quantity,
    QuantityField,
    Span,
    quantity,
)
from rover_pin.analysis.search_spec import SearchSpec
from rover_pin.analysis.strict import Strict, checked
from rover_pin.analysis.words import gravity, posture
from rover_pin.analysis.yaml_file import read_mapping
from rover_pin.description.masses import ROBOT
from rover_pin.errors import StudyError, nearest

MOST_CASES = 2**30
"""As many points as a Sobol sequence of scipy has."""

DEFAULT_STUDY = """\
robot: rocker_bogie
terrain: {rough: {seed: 1, rms: 0.05, hurst: 0.8, size: 20, spacing: 0.05}}
cases: {sampler: sobol, n: 10000, seed: 0}
vary: {x: map, y: map, yaw_deg: [0, 360], posture: [home], parameters: {track: [1.0, 1.4]}, friction: [0.5]}
measures: [loads, polygon, tip, force_angle, energy, zmp, clearance]
gravity: 9.81
payload: []
"""
"""What `rover-pin study` runs without a file."""

CHEAP = ("loads", "polygon", "tip", "force_angle", "energy", "zmp", "clearance")


class CasesSpec(Strict):
    """How cases are drawn.

    `random`: n independent draws. `saltelli`: n blocks, a power of two, of D + 2 cases each that change one
    of the D things that vary at a time, for Sobol indices. `sobol`: n scrambled Sobol points of `seed` over
    everything that varies. `grid`: every combination, ranges cut into the counts of `grid` (by the
    quantity's name), or into one common count so that there are at most n cases; where both are silent one
    range is cut into 41, two into 21 each. `sensitivity`: one design, and each of the parameters `to` (all
    where silent) moved from it alone by the share `step` of its value. A bare word is a sampler.
    """

    sampler: Literal["sobol", "random", "saltelli", "grid", "sensitivity"] = "sobol"
    n: int | None = Field(default=None, ge=1, le=MOST_CASES)
    seed: int = Field(default=0, ge=0)
    grid: dict[str, Annotated[int, Field(ge=1)]] | None = None
    step: float = Field(default=0.01, gt=0, le=0.5)
    to: tuple[str, ...] | None = None

    @model_validator(mode="before")
    @classmethod
    def _sampler_follows(cls, raw: Any) -> Any:
        if isinstance(raw, str):
            return {"sampler": raw}
        if not isinstance(raw, dict):
            return raw
        alone = [key for key in ("step", "to") if raw.get(key) is not None]
        if alone:
            if raw.get("sampler", "sensitivity") != "sensitivity":
                raise StudyError("needs the sampler sensitivity", element=alone[0], value=raw["sampler"])
            raw = {**raw, "sampler": "sensitivity"}
        if raw.get("sampler") == "sensitivity" and raw.get("n") is not None:
            cure = "leave it out: there are four cases a parameter, and one"
            raise StudyError("does not say how many cases sensitivities take", element="n", cure=cure)
        if raw.get("grid") is not None:
            if raw.get("sampler", "grid") != "grid":
                raise StudyError("counts need the sampler grid", element="grid", value=raw["sampler"])
            if raw.get("n") is not None:
                raise StudyError("n and grid both say how many", element="n", value=raw["n"], cure="keep one")
            return {**raw, "sampler": "grid"}
        return raw

    @field_validator("to", mode="before")
    @classmethod
    def _one_name(cls, raw: Any) -> Any:
        return [raw] if isinstance(raw, str) else raw

    @property
    def number(self) -> int:
        """The number of cases asked for (the most, under a grid), or of blocks."""
        silent = 1024 if self.sampler == "saltelli" else 10_000
        return silent if self.n is None else self.n


class ShiftSpec(Strict):
    """How far a centre of mass is moved, m."""

    x: OptionalField = None
    y: OptionalField = None
    z: OptionalField = None


class CarriedSpec(ShiftSpec):
    """A mass [kg] at a point of the base [m] that varies, on top of the study's payload."""

    kg: QuantityField

    @field_validator("kg")
    @classmethod
    def _mass(cls, given: Quantity) -> Quantity:
        if given.support[0] < 0:
            raise StudyError("may be below zero", value=given.support[0], cure=BOUND)
        return given


BOUND = "give bounds, as {normal: {mean: 10, sd: 1, bounds: [7, 13]}}"


class VarySpec(Strict):
    """What varies: x, y [m], yaw [deg], postures, parameters, joints [rad or m], friction, masses.

    `mass`: kg, of links by name or of the whole `robot` (all links scaled alike; the word alone may
    be left out); `com`: how far the centre of mass of a link is moved in the link's frame, of the `robot` in
    the root link's; `payload`: on the base.

    What is silent does not vary: the middle of the map (the origin where it has no edge), heading 0, home,
    declared parameters and friction.
    """

    x: PlaceField = None
    y: PlaceField = None
    yaw_deg: QuantityField = quantity(0.0)
    posture: tuple[str, ...] | None = None
    parameters: dict[str, QuantityField] = Field(default_factory=dict)
    joints: dict[str, QuantityField] = Field(default_factory=dict)
    friction: OptionalField = None
    mass: dict[str, QuantityField] = Field(default_factory=dict)
    com: dict[str, ShiftSpec] = Field(default_factory=dict)
    payload: CarriedSpec | None = None

    @field_validator("mass", mode="before")
    @classmethod
    def _whole(cls, raw: Any) -> Any:
        """A quantity instead of quantities by link is the robot's."""
        words = (
            isinstance(raw, Mapping)
            and bool(raw)
            and set(raw) <= {*KEYS, "values", "from", "to", "by", "count"}
        )
        return {ROBOT: raw} if raw is not None and (words or not isinstance(raw, Mapping)) else raw

    @field_validator("mass")
    @classmethod
    def _masses(cls, given: dict[str, Quantity]) -> dict[str, Quantity]:
        for name, asked in given.items():
            if asked.support[0] < 0 or asked.ends[0] <= 0:
                raise StudyError("may be zero or less", element=name, value=asked.support[0], cure=BOUND)
        return given

    @field_validator("posture", mode="before")
    @classmethod
    def _one_posture(cls, raw: Any) -> Any:
        names = [raw] if isinstance(raw, str) else raw
        if isinstance(names, list | tuple):
            if not names:
                raise StudyError("names no posture", cure="write [home], or leave it out")
            for name in names:
                posture(str(name))
        return names

    @field_validator("friction")
    @classmethod
    def _positive(cls, given: Quantity | None) -> Quantity | None:
        if given is not None and (given.support[0] < 0 or given.ends[0] <= 0):
            raise StudyError("must be more than zero", value=given.support[0])
        return given


def _seat(raw: Any) -> Any:
    if isinstance(raw, str):
        return raw
    if not isinstance(raw, list | tuple) or len(raw) != 3:
        raise StudyError("is no place", value=raw, cure="write [x, y, z] in m, or a link's name")
    return tuple(number(part) for part in raw)


Seat = Annotated[Any, BeforeValidator(_seat)]


class PayloadSpec(Strict):
    """A mass [kg] at a point of the base [m], or at the origin of a link."""

    kg: float = Field(gt=0)
    at: Seat


def _measures(raw: Any) -> Any:
    names = [raw] if isinstance(raw, str) else raw
    if isinstance(names, list | tuple):
        for name in names:
            if name not in known_measures():
                raise StudyError("no such measure", value=name, cure=nearest(str(name), known_measures()))
        if len(set(names)) < len(names):
            raise StudyError("names a measure twice", value=", ".join(names))
    return names


Ground = Annotated[Any, BeforeValidator(ground)]
Measures = Annotated[tuple[str, ...], BeforeValidator(_measures)]
Gravity = Annotated[float, BeforeValidator(gravity)]


class StudySpec(Strict):
    """A study file."""

    robot: str = Field(min_length=1)
    sidecar: str | None = None
    packages: dict[str, str] = Field(default_factory=dict)
    skip_missing_includes: bool = False
    terrain: Ground
    cases: CasesSpec = CasesSpec()
    vary: VarySpec = VarySpec(x=MAP, y=MAP, yaw_deg=Span(0.0, 360.0))
    locks: tuple[str, ...] = ()
    measures: Measures = CHEAP
    gravity: Gravity = 9.81
    payload: tuple[PayloadSpec, ...] = ()
    search: SearchSpec | None = None

    @model_validator(mode="before")
    @classmethod
    def _at_one_place(cls, raw: Any) -> Any:
        """Sensitivities are taken at one place where the file does not say what varies."""
        if not isinstance(raw, dict) or raw.get("vary") is not None:
            return raw
        cases = raw.get("cases")
        words = (
            cases.get("sampler", "sensitivity" if {"step", "to"} & set(cases) else "")
            if isinstance(cases, dict)
            else cases
        )
        return {**raw, "vary": {}} if words == "sensitivity" else raw


def read_spec(path: Path) -> tuple[StudySpec, str]:
    """The study file at `path`, checked, and its text.

    Raises:
        StudyError: no such file, not YAML, or a value that cannot be used.
    """
    raw, text = read_mapping(path)
    return checked(StudySpec, raw, file=path), text
