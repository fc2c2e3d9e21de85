"""Study: a rover, a terrain and what varies; run it for a Dataset, or ask for one of its stances."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.engines import Resources, engine
from rover_pin.analysis.given import GivenTerrain, as_text
from rover_pin.analysis.ground import Ground
from rover_pin.analysis.job import Chunk, Runner
from rover_pin.analysis.parts import Parts
from rover_pin.analysis.plan import Plan, plan
from rover_pin.analysis.quantities import MAP
from rover_pin.analysis.rows import Columns
from rover_pin.analysis.spec import DEFAULT_STUDY, StudySpec, read_spec
from rover_pin.analysis.store import Memory, missing
from rover_pin.analysis.strict import checked
from rover_pin.analysis.trial import trial
from rover_pin.analysis.yaml_file import parse_mapping
from rover_pin.errors import StudyError

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.description.recipe import Payload
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain

Progress = Callable[[int, int], None]
"""Called with the number of cases finished and of all cases."""


class Study:
    """Many cases of one question.

    Attributes:
        spec: the study file's values, checked.
        text: the study file's text.
        file: where it was read from, or None.
        folder: where relative file names count from.
    """

    def __init__(
        self,
        robot: str | Path | Rover,
        terrain: str | Mapping[str, Any] | Terrain,
        *,
        cases: Mapping[str, Any] | None = None,
        vary: Mapping[str, Any] | None = None,
        measures: Sequence[str] | None = None,
        folder: str | Path = ".",
        **others: Any,
    ) -> None:
        """A study from Python: the same words as in a study file, or a Rover and a Terrain.

        `others` are the study file's further keys.

        Raises:
            StudyError: a value that cannot be used.
        """
        from rover_pin.rover import Rover as RoverType

        raw: dict[str, Any] = {"robot": robot, "terrain": terrain, "cases": cases, "vary": vary}
        raw = {
            key: value for key, value in {**raw, "measures": measures, **others}.items() if value is not None
        }
        given = robot if isinstance(robot, RoverType) else None
        raw |= _named(robot, raw) if isinstance(robot, RoverType) else {"robot": str(robot)}
        text = as_text(raw)
        if not isinstance(terrain, str | Mapping):
            raw["terrain"] = GivenTerrain(given=terrain)
        self._take(checked(StudySpec, raw, element="study"), text, None, Path(folder), given)

    def _take(
        self, spec: StudySpec, text: str, file: Path | None, folder: Path, given: Rover | None = None
    ) -> None:
        self.spec = spec
        self.text = text
        self.file = file
        self.folder = folder.resolve()
        self._given = given

    @classmethod
    def from_file(cls, path: str | Path) -> Study:
        """The study that a file describes.

        Raises:
            StudyError: the file cannot be read or used; names file, key, value and cure.
        """
        file = Path(path).expanduser()
        spec, text = read_spec(file)
        study = cls.__new__(cls)
        study._take(spec, text, file, file.parent)
        return study

    @classmethod
    def from_text(cls, text: str, *, file: object = None, folder: str | Path = ".") -> Study:
        """The study that a study file's text describes; `file` names it in errors.

        Raises:
            StudyError: as `from_file`.
        """
        study = cls.__new__(cls)
        spec = checked(StudySpec, parse_mapping(text, file), file=file)
        study._take(spec, text, None, Path(folder))
        return study

    @classmethod
    def default(cls) -> Study:
        """What `rover-pin study` runs without a file."""
        return cls.from_text(DEFAULT_STUDY, file="the default study")

    @classmethod
    def from_dataset(cls, data: xr.Dataset | str | Path) -> Study:
        """The study that a result came from, from its attributes.

        Raises:
            StudyError: no result of a study, or one whose terrain was given as an object.
        """
        from rover_pin.analysis.dataset import read

        if isinstance(data, str | Path):
            with read(Path(data)) as opened:
                attrs = opened.attrs
        else:
            attrs = data.attrs
        text, folder = str(attrs["study"]), str(attrs["study_folder"])
        return cls.from_text(text, file="the result's study", folder=folder)

    def altered(self, *, payload: Sequence[Payload] = (), **keys: Any) -> Study:
        """The same study with some of the study file's keys said otherwise, and further payload.

        Its text, and so the result's provenance, says what was changed.

        Args:
            payload: (kg, place) as for `Rover.with_payload`, on top of the study's own.
            keys: as in a study file; `terrain` may be a Terrain.

        Raises:
            StudyError: a value that cannot be used.
        """
        raw = {**parse_mapping(self.text, self.file), **keys}
        if payload:
            more = [{"kg": kg, "at": at if isinstance(at, str) else list(at)} for kg, at in payload]
            raw["payload"] = [*(raw.get("payload") or ()), *more]
        text = as_text(raw)
        ground = keys.get("terrain", self.spec.terrain)
        raw["terrain"] = ground if isinstance(ground, str | Mapping | Ground) else GivenTerrain(given=ground)
        study = type(self).__new__(type(self))
        given = None if "robot" in keys else self._given
        study._take(checked(StudySpec, raw, file=self.file), text, self.file, self.folder, given)
        return study

    @cached_property
    def plan(self) -> Plan:
        """Robot, terrain and cases, read on first use.

        Raises:
            InputError: a file, name or range that cannot be used.
        """
        return plan(self.spec, self.folder, self.file, self._given)

    @cached_property
    def _runner(self) -> Runner:
        return Runner(self.plan.job)

    def __len__(self) -> int:
        """The number of cases."""
        return len(self.plan.job.cases)

    def stance(self, case: int) -> Stance:
        """One case at rest, by the plain path.

        Where a row of the result says `plain_path` 1, it is this stance to the last bit; a row of the
        compiled path agrees with it to 1e-8 m, 1e-8 rad and 1e-5 N.

        Raises:
            InputError: no such case, or one that cannot be posed.
        """
        if not 0 <= case < len(self):
            raise StudyError("no such case", element="case", value=case, cure=f"give 0 to {len(self) - 1}")
        return self._runner.stance(case)

    def run(
        self,
        *,
        engine: str = "serial",
        workers: int | None = None,
        scheduler: str | None = None,
        out: str | Path | None = None,
        resume: bool = False,
        chunk: int | None = None,
        progress: Progress | None = None,
    ) -> xr.Dataset:
        """Every case, as a Dataset; the values hang neither on the engine nor on the chunks.

        Args:
            engine: `serial`, `process`, or another of `analysis/engines/`.
            workers: worker processes; None for one a core.
            scheduler: a scheduler's address, for engines that take one.
            out: the netCDF file to write; finished chunks are kept in `<out>.parts/` until it is whole.
                The Dataset is then opened lazily from it; memory does not grow with the number of cases.
                None keeps all of it in memory.
            resume: go on with the parts of a run that was killed.
            chunk: cases a chunk; None for about three quarters of a second's work.
            progress: called with finished and all cases.

        Raises:
            InputError: the study or the place of the result cannot be used, or the result needs more disk
                than there is; nothing is written then. Or the disk filled up; what is finished is kept.
            SolverError: a case failed in a way that no status describes; what is finished is kept.
        """
        from rover_pin.analysis.dataset import dataset
        from rover_pin.analysis.result import check_disk, save_result

        if self.spec.search is not None:
            cure = "run it with rover-pin search, or leave the entry out"
            raise StudyError("asks for a search", file=self.file, element="search", cure=cure)
        if chunk is not None and chunk < 1:
            raise StudyError("must be at least 1", element="chunk", value=chunk)
        resources = Resources(workers, scheduler)
        chosen = _engine(engine, resources)
        parts = None if out is None else Parts(Path(out), self.plan.fingerprint, resume=resume)
        self._runner.first()
        tried = trial(self._runner, len(self), chunk)
        size = chunk or tried.chunk(len(self), chosen.workers(resources))
        kept = Memory() if parts is None else parts
        if parts is not None:
            check_disk(self, parts, tried)
            parts.begin()
        del tried
        finished = sum(stop - start for start, stop in kept.done())
        report = progress or _silent
        report(finished, len(self))

        def done(part: Chunk, columns: Columns) -> None:
            nonlocal finished
            kept.save(part, columns)
            finished += part[1] - part[0]
            report(finished, len(self))

        chosen.run(self.plan.job, missing(kept.done(), len(self), size), resources, done)
        return dataset(self, kept.columns()) if isinstance(kept, Memory) else save_result(self, kept)

    def __repr__(self) -> str:
        """One line."""
        cases = (
            f"{self.spec.cases.sampler}, n {self.spec.cases.n}"
            if self.spec.cases.n
            else self.spec.cases.sampler
        )
        return f"Study({self.spec.robot}; {cases}; {', '.join(self.spec.measures)})"


_engine = engine


def _named(rover: Rover, raw: Mapping[str, Any]) -> dict[str, Any]:
    """A rover in the words of a study file: its files, its parameters as fixed ones."""
    everywhere: dict[str, Any] = {"x": MAP, "y": MAP, "yaw_deg": [0, 360]}
    vary = dict(raw.get("vary") or everywhere)
    if rover.parameters:
        vary["parameters"] = {**rover.parameters, **vary.get("parameters", {})}
    sidecar = {} if rover.sidecar_path is None else {"sidecar": str(rover.sidecar_path.resolve())}
    packages = {"packages": dict(rover.recipe.packages)} if rover.recipe.packages else {}
    return {"robot": str(rover.source.resolve()), "vary": vary, **sidecar, **packages}


def _silent(finished: int, count: int) -> None:
    return None
