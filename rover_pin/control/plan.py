"""A rover's `control.yaml`: its sides, how fast its modes move, and what motion constraints allow in each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, create_model

from rover_pin.control.layout import Layout, Side
from rover_pin.control.modes import Speeds
from rover_pin.control.motion_constraints import CONSTRAINTS
from rover_pin.control.threshold import Threshold
from rover_pin.description.reading import check_schema, parse_yaml, place, read_text, validated
from rover_pin.description.specs import Positive, Spec
from rover_pin.errors import InputError, SidecarError

if TYPE_CHECKING:
    from rover_pin.rover import Rover

FILE = "control.yaml"
SCHEMA: Literal[1] = 1

Margin = Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)]


class SideSpec(Spec):
    """A side, see `Side`."""

    wheels: tuple[str, ...]
    hinge: str
    rocker: str
    clutch: str | None = None


class SidesSpec(Spec):
    """Both sides."""

    left: SideSpec
    right: SideSpec


class SpeedsSpec(Spec):
    """See `Speeds`."""

    roll: Positive = Speeds.roll
    lift: Positive = Speeds.lift
    steer: Positive = Speeds.steer


class ThresholdSpec(Spec):
    """See `Threshold`; the mode's margin where it states none."""

    limit: Positive
    margin: Margin | None = None


class ModeSpec(Spec):
    """A mode's margin; the thresholds are keys of its own, one a motion constraint that takes one."""

    margin: Margin = 1.0


_TAKE_ONE = tuple(name for name, kind in CONSTRAINTS.items() if kind.kind != "set")
_KEYS: dict[str, Any] = dict.fromkeys(_TAKE_ONE, (ThresholdSpec | None, None))
ThresholdsSpec: type[ModeSpec] = create_model("ThresholdsSpec", __base__=ModeSpec, **_KEYS)


class ControlSpec(Spec):
    """All keys of the file."""

    version: Literal[1] = Field(default=SCHEMA, alias="schema")
    sides: SidesSpec
    speeds: SpeedsSpec = SpeedsSpec()
    modes: dict[str, ThresholdsSpec]


@dataclass(frozen=True)
class Plan:
    """What a rover's control is told.

    Attributes:
        file: where it stands.
        layout: the rover's sides.
        speeds: of its modes.
        thresholds: by mode, then by motion constraint; a constraint that a mode does not name is not watched
            in it. Which wheels may be lifted together needs no threshold.
    """

    file: Path
    layout: Layout
    speeds: Speeds
    thresholds: Mapping[str, Mapping[str, Threshold]]

    def thresholds_of(self, mode: str) -> Mapping[str, Threshold]:
        """The thresholds of a mode.

        Raises:
            InputError: none are stated; names the modes there are.
        """
        if mode not in self.thresholds:
            raise InputError(
                "no thresholds for this mode",
                file=self.file,
                element=f"modes.{mode}",
                cure=f"state them; there are {', '.join(self.thresholds)}",
            )
        return self.thresholds[mode]


def load_plan(rover: Rover, path: str | Path | None = None) -> Plan:
    """The plan of a rover.

    Args:
        rover: whose.
        path: of the file; silent: `control.yaml` beside the rover's own description.

    Raises:
        SidecarError: no such file, not YAML, another schema, an unknown or missing key, a value of the wrong
            kind, a name that the rover does not have; with the file, the line, the key's path and the cure.
    """
    file = rover.source.parent / FILE if path is None else Path(path)
    text = read_text(file, f"write a {FILE} with its sides and modes, or give the path of one")
    data, node = parse_yaml(text, file)
    check_schema(data, SCHEMA, file)
    spec = validated(ControlSpec, data, node, file)
    if not spec.modes:
        raise SidecarError("names no mode", file=place(file, node, ("modes",)), element="modes",
                           cure="state the thresholds of at least one")  # fmt: skip
    sides = [Side(name, *_entries(getattr(spec.sides, name))) for name in ("left", "right")]
    try:
        layout = Layout(*sides).checked(rover)
    except InputError as error:
        where = "sides" if error.element == "sides" else f"sides: {error.element}"
        raise SidecarError(error.what, file=place(file, node, ("sides",)), element=where,
                           value=error.value, cure=error.cure) from None  # fmt: skip
    speeds = Speeds(spec.speeds.roll, spec.speeds.lift, spec.speeds.steer)
    thresholds = {mode: _thresholds(each) for mode, each in spec.modes.items()}
    return Plan(file, layout, speeds, MappingProxyType(thresholds))


def _entries(side: SideSpec) -> tuple[tuple[str, ...], str, str, str | None]:
    return side.wheels, side.hinge, side.rocker, side.clutch


def _thresholds(mode: ModeSpec) -> Mapping[str, Threshold]:
    stated = {name: getattr(mode, name) for name in _TAKE_ONE}
    return MappingProxyType(
        {
            name: Threshold(each.limit, mode.margin if each.margin is None else each.margin)
            for name, each in stated.items()
            if each is not None
        }
    )
