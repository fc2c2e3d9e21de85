"""A study's result as an xarray Dataset with units and provenance, in memory and as netCDF."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rover_pin.analysis.cases import POSTURE, Cases
from rover_pin.analysis.measures import title
from rover_pin.analysis.provenance import git_state, versions
from rover_pin.analysis.rows import EDGES, Columns, Layout, joined
from rover_pin.errors import StudyError
from rover_pin.stability.registry import MEASURES

if TYPE_CHECKING:
    from rover_pin.analysis.study import Study

CASE, WHEEL, EDGE, JOINT = "case", "wheel", "edge", "joint"

ABOUT: dict[str, tuple[str, str]] = {
    "z_m": ("m", "height of the root link's origin"),
    "roll_rad": ("rad", "roll of the root link, R = Rz(yaw) Ry(pitch) Rx(roll)"),
    "pitch_rad": ("rad", "pitch of the root link"),
    "redundant": ("1", "supports more than equilibrium determines"),
    "equilibrium": (
        "1",
        "largest residual of forces over weight, moments over weight times largest wheel distance",
    ),
    "gap_m": ("m", "largest distance of a contact from the surface"),
    "loop_m": ("m", "largest opening of a loop or coupling"),
    "complementarity": ("1", "largest product of a gap and a load, scaled"),
    "load_n": ("N", "load against gravity; zero where the wheel does not touch"),
    "load_low_n": ("N", "least load that equilibrium and friction allow"),
    "load_high_n": ("N", "greatest load that equilibrium and friction allow"),
    "joint_rad": ("rad", "joint position; m where the joint slides"),
    "x_m": ("m", "x of the root link's origin"),
    "y_m": ("m", "y of the root link's origin"),
    "yaw_rad": ("rad", "heading of the root link"),
    "friction_given": ("1", "coefficient of Coulomb friction under every wheel"),
}
ACROSS = {"load_n": WHEEL, "load_low_n": WHEEL, "load_high_n": WHEEL, "joint_rad": JOINT}
VARIED = "varied"


def dataset(study: Study, parts: list[Columns]) -> xr.Dataset:
    """The Dataset of a study from its chunks in order."""
    job = study.plan.job
    columns = joined(parts)
    edges = sorted(
        {str(edge) for name in job.layout.margins for edge in _edge_names(columns, name, job.layout)}
    )
    variables: dict[str, Any] = {
        "status": (CASE, _words(columns["status"]), {"long_name": "how the case ended"})
    }
    variables["reason"] = (CASE, _words(columns["reason"]), {"long_name": "why it did not settle"})
    for name, (unit, text) in ABOUT.items():
        if name in columns:
            dims = (CASE, ACROSS[name]) if name in ACROSS else (CASE,)
            variables[name] = (dims, columns[name], {"units": unit, "long_name": text})
    for name in job.layout.margins:
        variables |= _measure(name, columns, job.layout, edges)
    variables |= _asked(job.cases, set(variables))
    return xr.Dataset(
        variables,
        coords={
            CASE: np.arange(len(job.cases)),
            WHEEL: _words(job.layout.wheels),
            JOINT: _words(job.layout.joints),
            EDGE: _words(edges),
        },
        attrs=_attributes(study),
    )


def _edge_names(columns: Columns, measure: str, layout: Layout) -> list[str]:
    """Edge names of a measure; none where what it calls edges are wheels."""
    names = [str(name) for name in columns[EDGES + measure]]
    return [] if set(names) <= set(layout.wheels) else names


def _measure(name: str, columns: Columns, layout: Layout, edges: list[str]) -> dict[str, Any]:
    """A measure's value, what limits it, and its values along the edges or wheels."""
    kind = MEASURES[name]
    about = {"units": kind.unit, "better": kind.better}
    out: dict[str, Any] = {
        name: (CASE, columns[name], {**about, "long_name": title(name)}),
        f"{name}_limiting": (CASE, _words(columns[f"{name}_limiting"]), {"long_name": f"what limits {name}"}),
    }
    own = [str(each) for each in columns[EDGES + name]]
    if own:
        on_wheels = set(own) <= set(layout.wheels)
        labels, dim = (list(layout.wheels), WHEEL) if on_wheels else (edges, EDGE)
        wide = np.full((len(columns[name]), len(labels)), np.nan)
        wide[:, [labels.index(each) for each in own]] = columns[f"{name}_edge"]
        out[f"{name}_{dim}"] = ((CASE, dim), wide, {**about, "long_name": f"{title(name)}, each {dim}"})
    return out


def _asked(cases: Cases, taken: set[str]) -> dict[str, Any]:
    """What was asked: one variable per quantity, marked `varied` where it is not the same in every case."""
    columns: dict[str, NDArray[Any]] = {"x_m": cases.x, "y_m": cases.y, "yaw_rad": cases.yaw}
    if cases.friction is not None:
        columns["friction_given"] = cases.friction
    if cases.postures:
        columns[POSTURE] = _words(np.asarray(cases.postures)[cases.posture])
    taken = taken | set(columns) | {CASE, WHEEL, EDGE, JOINT}
    for name, values in cases.parameters.items():
        columns[name if name not in taken else f"parameter_{name}"] = values
    for name, values in cases.joints.items():
        columns[f"joint_{name}"] = values
    out: dict[str, Any] = {}
    for name, values in columns.items():
        unit, text = ABOUT.get(name, ("", f"{name} asked for"))
        units = {"units": unit} if unit else {}
        out[name] = (CASE, values, {**units, "long_name": text, VARIED: int(len(np.unique(values)) > 1)})
    return out


def _words(words: Any) -> NDArray[np.str_]:
    """Words as xarray reads them back from a file."""
    return np.array([str(word) for word in words], dtype=np.str_)


def _attributes(study: Study) -> dict[str, Any]:
    """Where the numbers come from."""
    ready = study.plan
    commit, state = git_state(study.folder)
    own_commit, own_state = git_state(Path(__file__).resolve().parent)
    return {
        "title": f"{ready.rover.name} on {ready.job.terrain.label}",
        "robot": study.spec.robot,
        "terrain": ready.job.terrain.label,
        "terrain_digest": ready.job.terrain.digest,
        "seed": study.spec.cases.seed,
        "study": study.text,
        "study_file": "" if study.file is None else str(study.file),
        "study_folder": str(study.folder),
        "gravity": study.spec.gravity,
        "left_out": "; ".join(f"{name}: {why}" for name, why in ready.left_out.items()),
        "git_commit": commit,
        "git_state": state,
        "rover_pin_git_commit": own_commit,
        "rover_pin_git_state": own_state,
        **{f"{name}_version": text for name, text in versions().items()},
        "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
    }


def write(data: xr.Dataset, path: Path) -> None:
    """Write a Dataset as netCDF-4; wide tables compressed."""
    encoding = {
        str(name): {"zlib": True, "complevel": 1, "_FillValue": None}
        if values.ndim == 2
        else {"_FillValue": None}
        for name, values in data.variables.items()
        if values.dtype.kind == "f"
    }
    data.to_netcdf(path, engine="h5netcdf", encoding=encoding)


def read(path: Path) -> xr.Dataset:
    """A study's result from its file, in memory.

    Raises:
        StudyError: no such file, or not the result of a study.
    """
    if not path.is_file():
        raise StudyError("no such file", file=path, cure="make one with rover-pin study -o")
    try:
        data = xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError, KeyError) as error:
        raise StudyError(f"is no netCDF file: {error}", file=path) from None
    if "study" not in data.attrs or "status" not in data:
        raise StudyError("is not the result of a study", file=path, cure="make one with rover-pin study -o")
    return data
