"""Robots of the package example-robot-data by name, with the feet and wheels their URDFs do not declare."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata, resources
from pathlib import Path

from rover_pin.errors import DescriptionError, nearest

PREFIX = "example:"
_DISTRIBUTION = "example-robot-data"
_ROBOTS = Path("share") / _DISTRIBUTION / "robots"


@dataclass(frozen=True)
class Example:
    """A robot of that package.

    Attributes:
        name: after `example:`; its sidecar is `urdf/examples/NAME.yaml`.
        file: its URDF, below the package's `robots`.
        summary: what it is.
    """

    name: str
    file: str
    summary: str


EXAMPLES = (
    Example(
        "anymal_b", "anymal_b_simple_description/robots/anymal.urdf", "ANYmal B, a quadruped on ball feet."
    ),
    Example("hyq", "hyq_description/robots/hyq_no_sensors.urdf", "HyQ, a hydraulic quadruped on ball feet."),
    Example("solo12", "solo_description/robots/solo12.urdf", "Solo 12, a small quadruped on ball feet."),
    Example("talos", "talos_data/robots/talos_reduced.urdf", "TALOS, a humanoid on two flat soles."),
    Example("tiago", "tiago_description/robots/tiago.urdf", "TIAGo, an arm on two wheels and four casters."),
)


def sidecar_of(name: str) -> Path:
    """The bundled sidecar of `example:NAME`.

    Raises:
        DescriptionError: no such example.
    """
    return Path(str(resources.files("rover_pin"))) / "urdf" / "examples" / f"{_example(name).name}.yaml"


def description_of(name: str) -> Path:
    """The URDF of `example:NAME`.

    Raises:
        DescriptionError: no such example, or the package is not installed; with the places tried.
    """
    example = _example(name)
    tried = list(dict.fromkeys(_places()))
    for folder in tried:
        if (folder / example.file).is_file():
            return folder / example.file
    raise DescriptionError(
        f"{_DISTRIBUTION} has no {example.file}, or is not installed",
        value=name,
        cure=f"pip install {_DISTRIBUTION}; tried {', '.join(map(str, tried))}",
    )


def _example(name: str) -> Example:
    bare = name.removeprefix(PREFIX)
    known = {each.name: each for each in EXAMPLES}
    if bare not in known:
        cure = nearest(name, [PREFIX + each for each in known])
        raise DescriptionError("no example of that name", value=name, cure=cure)
    return known[bare]


def _places() -> Iterator[Path]:
    """Where the package's robots may lie: its wheel's own files, then prefixes of this environment."""
    with contextlib.suppress(metadata.PackageNotFoundError):
        yield Path(str(metadata.distribution(_DISTRIBUTION).locate_file("cmeel.prefix"))) / _ROBOTS
    yield from (
        Path(entry) / "cmeel.prefix" / _ROBOTS for entry in sys.path if entry.endswith("site-packages")
    )
    yield Path(sys.prefix) / _ROBOTS
