"""Other masses than a rover's files say: of links or of the whole robot, and where they sit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

ROBOT = "robot"
"""The word for the whole robot where a link's name is asked for."""

Offset = tuple[float, float, float]


@dataclass(frozen=True)
class Masses:
    """What is other than in the files; the payload comes on top of it.

    Attributes:
        kg: link to its mass; of `robot` all links are scaled alike, to that sum.
        scale: link to the factor on its mass; `robot` scales all links after that.
        com: link to how far its centre of mass is moved, m in the link's frame; of `robot` the whole robot's
            centre of mass, m in the root link's frame, by moving what is fixed to the root link.
    """

    kg: Mapping[str, float] = field(default_factory=dict)
    scale: Mapping[str, float] = field(default_factory=dict)
    com: Mapping[str, Offset] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Whether anything is other than in the files."""
        return bool(self.kg or self.scale or self.com)
