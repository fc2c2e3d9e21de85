"""One of the designs that are compared: a robot, its parameters, a posture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.finite import number
from rover_pin.errors import StudyError

if TYPE_CHECKING:
    from rover_pin.description.recipe import Payload
    from rover_pin.rover import Rover

FORM = "ROBOT:parameter=value,posture=NAME"


@dataclass(frozen=True)
class Design:
    """A robot as it is compared.

    Attributes:
        label: what it is called.
        robot: bundled name, or path of a URDF or xacro.
        parameters: values of declared parameters.
        posture: a name, or `clearance=M`; None for the study's.
        sidecar: the rover.yaml, or None for the one beside the URDF.
        packages: package name to folder.
        payload: masses on it beyond the study's, as for `Rover.with_payload`.
    """

    label: str
    robot: str
    parameters: Mapping[str, float] = field(default_factory=dict)
    posture: str | None = None
    sidecar: str | None = None
    packages: Mapping[str, str] = field(default_factory=dict)
    payload: tuple[Payload, ...] = ()

    @classmethod
    def parse(cls, word: str) -> Design:
        """`ROBOT` or `ROBOT:name=value,...`; `posture` and `sidecar` are such names beside the parameters.

        Raises:
            StudyError: not of that form.
        """
        head, sign, tail = word.rpartition(":")
        if not sign or "=" not in tail:
            head, tail = word, ""
        if not head:
            raise StudyError("names no robot", element="design", value=word, cure=f"write {FORM}")
        said: dict[str, str] = {}
        for part in tail.split(",") if tail else ():
            name, equals, value = (piece.strip() for piece in part.partition("="))
            if not (name and equals and value):
                cure = f"write {FORM}"
                raise StudyError("is not NAME=VALUE", element=f"design {word}", value=part, cure=cure)
            if name in said:
                raise StudyError("is given twice", element=f"design {word}", value=name, cure="keep one")
            said[name] = value
        posture, sidecar = said.pop("posture", None), said.pop("sidecar", None)
        values = {name: _value(word, name, text) for name, text in said.items()}
        absolute = None if sidecar is None else str(Path(sidecar).expanduser().resolve())
        robot = Path(head).expanduser()
        return cls(word, str(robot.resolve()) if robot.is_file() else head, values, posture, absolute)

    @classmethod
    def of(cls, rover: Rover, label: str | None = None) -> Design:
        """A loaded rover, read anew from its files: parameters and payload as it has them."""
        beside = None if rover.sidecar_path is None else str(rover.sidecar_path.resolve())
        recipe = rover.recipe
        return cls(
            label or rover.name,
            str(rover.source.resolve()),
            dict(rover.parameters),
            None,
            beside,
            dict(recipe.packages),
            recipe.payload,
        )


def designs_of(given: Sequence[Any] | Mapping[str, Any]) -> tuple[Design, ...]:
    """Words, rovers and designs as designs; a mapping says what they are called.

    Raises:
        StudyError: less than two, or the same one twice.
    """
    pairs = given.items() if isinstance(given, Mapping) else [(None, each) for each in given]
    found = tuple(_design(each, label) for label, each in pairs)
    if len(found) < 2:
        cure = f"name two or more: {FORM}"
        raise StudyError("there is nothing to compare with", element="designs", value=len(found), cure=cure)
    seen: set[str] = set()
    for each in found:
        if each.label in seen:
            cure = "compare different ones, or call them differently by a mapping in Python"
            raise StudyError("is given twice", element="design", value=each.label, cure=cure)
        seen.add(each.label)
    return found


def _design(given: Any, label: str | None) -> Design:
    from dataclasses import replace

    from rover_pin.rover import Rover

    if isinstance(given, Rover):
        return Design.of(given, label)
    if not isinstance(given, str | Path | Design):
        raise StudyError("is no design", value=type(given).__name__, cure="give a word, a Rover or a Design")
    made = given if isinstance(given, Design) else Design.parse(str(given))
    return made if label is None else replace(made, label=label)


def _value(word: str, name: str, text: str) -> float:
    try:
        return number(text)
    except StudyError as error:
        raise StudyError(error.what, element=f"design {word}: {name}", value=text) from None
