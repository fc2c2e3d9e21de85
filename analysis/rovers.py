"""The rovers of a study: one as loaded, and the same with other parameters."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.analysis.spec import StudySpec
from rover_pin.analysis.weights import masses_of

if TYPE_CHECKING:
    from rover_pin.rover import Rover

KEPT = 32


class Rovers:
    """A rover under different parameters and masses, the latest kept: cases that share them share a rover."""

    def __init__(self, base: Rover) -> None:
        self.base = base
        self._kept: OrderedDict[tuple[tuple[str, float], ...], Rover] = OrderedDict()

    def __call__(self, parameters: Mapping[str, float], weights: Mapping[str, float] | None = None) -> Rover:
        """The rover with these parameters, and with masses named as in `weights.py`.

        Raises:
            InputError: parameters or masses that the rover cannot have.
        """
        if not parameters and not weights:
            return self.base
        key = (*parameters.items(), *(weights or {}).items())
        if key not in self._kept:
            rover = self.base.with_parameters(**parameters) if parameters else self.base
            self._kept[key] = weighed(rover, weights) if weights else rover
        self._kept.move_to_end(key)
        if len(self._kept) > KEPT:
            self._kept.popitem(last=False)
        return self._kept[key]


def weighed(rover: Rover, weights: Mapping[str, float]) -> Rover:
    """The rover with a case's masses, what varies of the payload on top of the study's.

    Raises:
        InputError: masses that the rover cannot have.
    """
    masses, payload = masses_of(weights)
    rover = rover.with_masses(masses) if masses else rover
    return rover.with_payload(payload) if payload else rover


def load_from(spec: StudySpec, folder: Path) -> Rover:
    """The rover a study names, with its payload; relative files count from `folder`.

    Raises:
        InputError: the files cannot be used.
    """
    from rover_pin.loader import load

    rover = load(
        _absolute(spec.robot, folder),
        sidecar=None if spec.sidecar is None else folder / Path(spec.sidecar).expanduser(),
        packages={name: folder / Path(path).expanduser() for name, path in spec.packages.items()} or None,
        skip_missing_includes=spec.skip_missing_includes,
    )
    return loaded(rover, spec)


def loaded(rover: Rover, spec: StudySpec) -> Rover:
    """The rover with the study's payload."""
    return rover.with_payload([(load.kg, load.at) for load in spec.payload]) if spec.payload else rover


def _absolute(text: str, folder: Path) -> str:
    """A robot's name as it is where it is bundled, else the absolute path where something lies there."""
    from rover_pin.description.catalogue import robots
    from rover_pin.description.examples import PREFIX

    if text.startswith(PREFIX) or any(entry.name == text for entry in robots()):
        return text
    path = folder / Path(text).expanduser()
    return str(path.resolve()) if path.exists() else text
