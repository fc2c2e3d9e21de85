"""MuJoCo's MJCF: the tree as URDF, and what URDF cannot say of it in the words of a sidecar.

Pinocchio's own import drops equalities silently and the names of joints that share a body, so it is not used.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from rover_pin.description.mjcf.equality import sidecar_of
from rover_pin.description.mjcf.reading import read
from rover_pin.description.mjcf.tree import urdf_of
from rover_pin.description.notes import Notes

__all__ = ["Converted", "convert", "is_mjcf"]

_ENDS = {"<?": "?>", "<!--": "-->", "<!": ">"}  # of what may stand before the outermost element


@dataclass(frozen=True)
class Converted:
    """An MJCF file as we read it.

    Attributes:
        urdf: its bodies, joints, geoms and actuators.
        sidecar: YAML with its loops, couplings and springs.
    """

    urdf: str
    sidecar: str


def is_mjcf(text: str) -> bool:
    """Whether the outermost element is `<mujoco>`."""
    rest = text.removeprefix("\ufeff").lstrip()
    while (begin := next((each for each in _ENDS if rest.startswith(each)), None)) is not None:
        _, end, rest = rest.partition(_ENDS[begin])
        if not end:
            return False
        rest = rest.lstrip()
    return re.match(r"<mujoco[\s/>]", rest) is not None


def convert(text: str, path: Path, notes: Notes) -> Converted:
    """An MJCF text in our terms.

    Raises:
        DescriptionError: what cannot be used, with the element and the cure.
    """
    source = read(text, path)
    return Converted(urdf_of(source, notes), sidecar_of(source, notes))
