"""The `terrain:` entry of a study file, one model a kind."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from pydantic import Field

from rover_pin.analysis.strict import Strict, checked
from rover_pin.errors import StudyError, nearest

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

Interpolation = Literal["smooth", "linear"]


class Ground(Strict):
    """A terrain as written in a study file."""

    @abstractmethod
    def build(self, folder: Path) -> Terrain:
        """The terrain; relative files count from `folder`."""


class Word(Ground):
    """A word of the command line: `flat`, `slope:10`, `step:0.2,1`, `rough:1,0.05,0.8`, or a file's name."""

    word: str

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.parse`, a file counting from `folder`."""
        from rover_pin.terrain import Terrain

        path = folder / self.word
        return Terrain.parse(str(path) if path.is_file() else self.word)


class RoughShape(Strict):
    """Seeded rough ground of a power-law spectrum: lengths in m."""

    seed: int = 0
    rms: float = Field(gt=0)
    hurst: float = Field(gt=0, le=1)
    size: float = Field(default=20.0, gt=0)
    spacing: float = Field(default=0.05, gt=0)
    shortest: float | None = Field(default=None, gt=0)


class Rough(Ground):
    """`{rough: {seed, rms, hurst, size, spacing}}`."""

    rough: RoughShape

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.rough`."""
        from rover_pin.terrain import Terrain

        return Terrain.rough(**self.rough.model_dump(exclude_none=True))


class MapFile(Ground):
    """`{file, spacing, origin, interpolation, height_scale, height_offset}`: a height map, lengths in m."""

    file: str
    spacing: float | None = Field(default=None, gt=0)
    origin: tuple[float, float] | None = None
    interpolation: Interpolation = "smooth"
    height_scale: float | None = None
    height_offset: float | None = None

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.from_file`."""
        from rover_pin.terrain import Terrain

        given = self.model_dump(exclude={"file"}, exclude_none=True)
        return Terrain.from_file(folder / Path(self.file).expanduser(), **given)


class Slope(Ground):
    """`{slope: DEG}`, rising along +x."""

    slope: float = Field(gt=-90, lt=90)

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.slope`."""
        from rover_pin.terrain import Terrain

        return Terrain.slope(self.slope)


class StepShape(Strict):
    """A step of `height` beyond `x`, ramped over `spacing`, in m."""

    height: float
    x: float
    spacing: float = Field(default=0.05, gt=0)


class Step(Ground):
    """`{step: {height, x, spacing}}`."""

    step: StepShape

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.step`."""
        from rover_pin.terrain import Terrain

        return Terrain.step(**self.step.model_dump())


class Flat(Ground):
    """`{flat: HEIGHT}` in m."""

    flat: float

    def build(self, folder: Path) -> Terrain:
        """Through `Terrain.flat`."""
        from rover_pin.terrain import Terrain

        return Terrain.flat(self.flat)


KINDS: dict[str, type[Ground]] = {"rough": Rough, "file": MapFile, "slope": Slope, "step": Step, "flat": Flat}


def ground(raw: object) -> Ground:
    """Read a `terrain:` entry.

    Raises:
        StudyError: no kind, two kinds, or a kind's own values are wrong.
    """
    if isinstance(raw, Ground):
        return raw
    if isinstance(raw, str):
        return Word(word=raw)
    if not isinstance(raw, Mapping):
        raise StudyError(
            "is no terrain", value=raw, cure="write flat, {slope: 10}, {rough: {...}} or {file: F}"
        )
    kinds = [key for key in KINDS if key in raw]
    if len(kinds) > 1:
        raise StudyError("names two terrains", value=" and ".join(kinds), cure="keep one")
    if not kinds:
        key = next((str(k) for k in raw), "")
        raise StudyError("names no kind of terrain", value=key, cure=nearest(key, KINDS))
    return checked(KINDS[kinds[0]], raw)
