"""A study's page: where the rover is close to tipping, how margins and loads spread, the worst in 3D."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.errors import StudyError
from rover_pin.viz.facts import STATUS_WORDS
from rover_pin.viz.page.html import page, write_whole
from rover_pin.viz.page.matters import matters_of
from rover_pin.viz.page.measured import about_measures, main_measure
from rover_pin.viz.page.pack import Pack
from rover_pin.viz.page.raster import ground_raster
from rover_pin.viz.page.robots import robot
from rover_pin.viz.page.rows import page_columns, unit_of, varied
from rover_pin.viz.page.sweep import sweep_of

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain


def save_study_page(
    dataset: xr.Dataset,
    path: str | Path,
    *,
    rover: Rover,
    terrain: Terrain,
    stances: Mapping[int, Stance] | None = None,
    measure: str | None = None,
) -> Path:
    """Write the page of a study: one offline HTML file, whole or not at all.

    Args:
        dataset: of a Study: dimensions case, wheel, joint; see `measures_of`.
        path: of the file.
        rover: drawn for every case that `stances` does not hold.
        terrain: the study's ground.
        stances: exact stances of some cases (of `worst_cases`, say): their contacts and, where parameters
            vary, their own rover. For other cases the page places each load where the wheel is nearest
            to the plane of the ground under it.
        measure: shown first; else the one that says most about tipping.

    Raises:
        StudyError: no case, or no such measure.
        InputError: the file cannot be written.
    """
    return write_whole(path, study_page(dataset, rover, terrain, stances or {}, measure).encode("utf-8"))


def study_page(
    dataset: xr.Dataset,
    rover: Rover,
    terrain: Terrain,
    stances: Mapping[int, Stance],
    measure: str | None = None,
    matters: Mapping[str, Any] | None = None,
) -> str:
    """The page's HTML text; arguments as in `save_study_page`; `matters` of `matters_of`, where known."""
    if not dataset.sizes.get("case"):
        raise StudyError("the study has no case", cure="run it with n of 1 or more")
    columns = page_columns(dataset)
    variants, exact = _variants(rover, stances)
    ground, heights = ground_raster(
        terrain, dataset["x_m"].values, dataset["y_m"].values, float(variants[0][0]["span"])
    )
    title = str(dataset.attrs.get("title") or f"{rover.name} on {terrain.label}")
    header = {
        "title": title,
        "about": {str(key): _text(value) for key, value in dataset.attrs.items()},
        "cases": int(dataset.sizes["case"]),
        "first": main_measure(dataset, measure),
        "measures": about_measures(dataset),
        "wheels": [str(name) for name in dataset["wheel"].values],
        "joints": [str(name) for name in dataset["joint"].values],
        "varied": varied(dataset),
        "reshaped": any(name.removeprefix("parameter_") in rover.parameters for name in varied(dataset)),
        "reweighed": any(_weighs(name, rover) for name in varied(dataset)),
        "columns": {
            name: {**column.about(), "unit": unit_of(dataset, name)} for name, column in columns.items()
        },
        "status_words": STATUS_WORDS,
        "sweep": sweep_of(dataset),
        "matters": matters or matters_of(dataset),
        "ground": ground,
        "robots": [about for about, _ in variants],
        "exact": exact,
    }
    segments = {f"column/{name}": column.data for name, column in columns.items()}
    segments |= {"ground": heights, **{f"robot/{i}": stream for i, (_, stream) in enumerate(variants)}}
    return page("study", title, Pack(header, segments))


def _variants(
    rover: Rover, stances: Mapping[int, Stance]
) -> tuple[list[tuple[dict[str, Any], bytes]], dict[int, dict[str, Any]]]:
    """The rovers to draw, each once, and what is known exactly of some cases."""
    variants = [robot(rover)]
    known = {_looks(rover): 0}
    exact: dict[int, dict[str, Any]] = {}
    for case, stance in stances.items():
        looks = _looks(stance.rover)
        if looks not in known:
            known[looks] = len(variants)
            variants.append(robot(stance.rover, len(variants)))
        exact[int(case)] = {
            "robot": known[looks],
            "com": stance.com,
            "contacts": [[c.wheel, *(float(part) for part in c.point), c.load] for c in stance.contacts],
        }
    return variants, exact


def _weighs(name: str, rover: Rover) -> bool:
    """Whether a column that varies is of masses, as `Study` names them."""
    return name.startswith(("mass_", "com_", "payload_")) and name not in rover.parameters


def _looks(rover: Rover) -> tuple[tuple[str, float], ...]:
    return tuple(sorted((str(name), float(value)) for name, value in rover.parameters.items()))


def _text(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value
