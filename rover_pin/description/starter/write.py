"""The text of a sidecar to start from."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rover_pin.description.starter.joints import (
    guess_differential,
    guess_passive,
    stated_actuation,
    stated_couplings,
)
from rover_pin.description.starter.loops import guess_loops
from rover_pin.description.starter.subject import Guess, Subject, flow, flow_value
from rover_pin.description.starter.wheels import guess_feet, guess_wheels
from rover_pin.rover import Rover

_ARGUMENT = re.compile(r"<xacro:arg\s[^>]*>")
_HEAD = """\
## A sidecar for {name}, to start from: what its URDF cannot say. `rover-pin info` tells what comes of it.
##
## Lines that begin with two hashes are words. Lines that begin with one hash and a blank are YAML that does
## nothing yet: take `# ` away where the line is right. Each says what it rests on; a guess may be wrong.
## Lengths in m, angles in rad, masses in kg. All keys: README, "What a sidecar can say".
"""
_WORDS = {
    "srdf": "Postures and passive joints of MoveIt:",
    "up": "Where the root link's z does not point up:",
    "loops": "Frames that coincide. Types: ball, hinge, planar, weld, distance:",
    "couplings": "Sum of coefficient times joint = offset:",
    "passive": "Joints that nothing drives (or say `actuated`, the others):",
    "wheels": "What rolls. `tread` is the rounding of the rim; friction is Coulomb's:",
    "contacts": "Feet: balls, or points where the radius is 0:",
    "postures": "Joint positions by name; `home` is taken where none is named:",
    "parameters": "Arguments of the xacro that may vary:",
}
_LISTS = ("loops", "couplings", "wheels", "contacts")


@dataclass(frozen=True)
class Start:
    """A sidecar to start from.

    Attributes:
        text: YAML, every guess commented out.
        guesses: what was guessed, and why.
        words: what was seen and no guess made of.
    """

    text: str
    guesses: tuple[Guess, ...]
    words: tuple[str, ...]


def start(rover: Rover, folder: Path) -> Start:
    """What a rover that was loaded without a sidecar suggests.

    Args:
        rover: as loaded.
        folder: where the sidecar will lie; other files are named from there.
    """
    subject = Subject(rover)
    wheels, mute = guess_wheels(subject)
    feet, flat = guess_feet(subject, wheels)
    loops, odd = guess_loops(subject)
    links = {guess.link for guess in wheels}
    drives = [joint for link in links if (joint := subject.made.tree.joint_above(link)) in rover.joints]
    differential, passive = guess_differential(subject), guess_passive(subject, drives)
    guesses = [
        *_srdf(rover, folder),
        *_up(subject, wheels),
        *loops,
        *stated_couplings(subject),
        *([differential] if differential else []),
        *([passive] if passive else []),
        *wheels,
        *feet,
        *_home(rover, drives),
        *_parameters(rover.source),
    ]
    words = [
        *(f"link {link} is named like a wheel, but no shape tells its radius" for link in mute),
        *(f"link {link} is named like a foot, but no sphere tells its radius" for link in flat),
        *odd,
    ]
    said = stated_actuation(subject)
    if said is not None:
        words.append(f"{said} says what is driven: {', '.join(rover.actuated) or 'nothing that moves'}")
    if not wheels and not feet:
        words.append("no link looks like a wheel or a ball foot: list `wheels` or `contacts`")
    return Start(
        _text(rover.name, guesses, words, _robot_yaml(rover.source, folder)), tuple(guesses), tuple(words)
    )


def _text(name: str, guesses: Sequence[Guess], words: Sequence[str], robot_yaml: str | None) -> str:
    lines = [*_HEAD.format(name=name).splitlines(), "schema: 1"]
    if robot_yaml is not None:
        lines += [
            "",
            "## Loops and driven joints of Gepetto's file, read as it is:",
            f"robot_yaml: {robot_yaml}",
        ]
    for key, about in _WORDS.items():
        own = [guess for guess in guesses if guess.key == key]
        if not own:
            continue
        lines += ["", f"## {about}"]
        if key in _LISTS:
            lines += [f"# {key}:", *(f"#   - {guess.line}  # {_why(guess)}" for guess in own)]
        else:
            lines += [f"# {key}: {guess.line}  # {_why(guess)}" for guess in own]
    return "\n".join([*lines, *([""] if words else []), *(f"## Note: {each}." for each in words), ""])


def _why(guess: Guess) -> str:
    return guess.reason if guess.reason.startswith("<mimic>") else f"guess: {guess.reason}"


def _srdf(rover: Rover, folder: Path) -> list[Guess]:
    near = rover.source.parent
    found = [*sorted(near.glob("*.srdf")), *sorted((near.parent / "srdf").glob("*.srdf"))]
    alike = [path for path in found if path.stem in (rover.source.stem.removesuffix(".urdf"), rover.name)]
    return [
        Guess("srdf", os.path.relpath(path, folder), "an SRDF of that name lies there") for path in alike[:1]
    ]


def _robot_yaml(source: Path, folder: Path) -> str | None:
    from rover_pin.description.catalogue import GEPETTO
    from rover_pin.description.gepetto import stands_in

    path = source.parent / GEPETTO
    return os.path.relpath(path, folder) if path.is_file() and stands_in(path) else None


def _up(subject: Subject, wheels: Sequence[Guess]) -> list[Guess]:
    import pinocchio as pin

    links = [guess.link for guess in wheels]
    if not links:
        return []
    model = subject.rover.model
    middle = float(pin.centerOfMass(model, model.createData(), subject.rover.neutral * 0)[2])
    above = [float(subject.frame(link).translation[2]) - middle for link in links]
    if min(above) <= 0:
        return []
    return [Guess("up", "[0, 0, -1]", "every wheel lies above the centre of mass along z")]


def _home(rover: Rover, drives: Sequence[str]) -> list[Guess]:
    values = {name: _within(rover, rover.column[name]) for name in rover.joints if name not in drives}
    if not values or len(values) > 40:
        return []
    return [Guess("postures", flow({"home": values}), "zero, or the limit nearest to it")]


def _within(rover: Rover, k: int) -> float:
    """A joint's neutral place as it will be written, rounded to the inside where it is one of its limits."""
    value = float(rover.neutral[k])
    if rover.lower[k] <= float(flow_value(value)) <= rover.upper[k]:
        return value
    scale = 10.0 ** min(6, 5 - math.floor(math.log10(abs(value))))
    return math.copysign(math.ceil(abs(value) * scale) / scale, value)  # the inside lies away from zero


def _parameters(source: Path) -> list[Guess]:
    """Arguments with a number for a default."""
    found: dict[str, object] = {}
    for tag in _ARGUMENT.findall(source.read_text(encoding="utf-8")):
        name = re.search(r"\bname\s*=\s*[\"']([^\"']+)", tag)
        default = re.search(r"\bdefault\s*=\s*[\"']([^\"']+)", tag)
        try:
            found[name.group(1)] = {"default": float(default.group(1))}  # type: ignore[union-attr]
        except (AttributeError, ValueError):
            continue
    return [Guess("parameters", flow(found), "<xacro:arg> with a number")] if found else []
