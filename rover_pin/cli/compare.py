"""`rover-pin compare`: designs side by side on the same cases."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rover_pin.cli.options import (
    HeightOffset,
    HeightScale,
    Interpolation,
    Json,
    OwnGravity,
    Packages,
    Payload,
    SkipIncludes,
    Spacing,
    altered,
    pairs,
)
from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.analysis.comparison import Comparison


def compare(
    designs: Annotated[
        list[str],
        typer.Argument(
            help="Robots, as ROBOT:param=value,posture=NAME; or results of studies.",
            metavar="DESIGN DESIGN...",
        ),
    ],
    study: Annotated[
        Path | None, typer.Option(help="Study file whose robot the designs replace.", metavar="SPEC")
    ] = None,
    terrain: Annotated[
        str | None, typer.Option(help="A height map's file, flat, slope:DEG, rough:SEED,RMS,HURST, ...")
    ] = None,
    spacing: Spacing = None,
    interpolation: Interpolation = "smooth",
    height_scale: HeightScale = None,
    height_offset: HeightOffset = 0.0,
    cases: Annotated[
        int | None, typer.Option("--cases", "-n", help="Places and headings; silent: 1000.", metavar="N")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Of the draws and the bootstrap.", metavar="N")] = None,
    measure: Annotated[
        list[str] | None, typer.Option(help="Of each stance: tip, clearance, loads, ...")
    ] = None,
    gravity: OwnGravity = None,
    payload: Payload = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    engine: Annotated[str, typer.Option(help="serial, process, ...")] = "process",
    workers: Annotated[
        int | None, typer.Option(help="Worker processes; silent: one a core.", metavar="N")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Keep each design's result: OUT_A.nc, OUT_B.nc, ...", metavar="OUT.nc"
        ),
    ] = None,
    html: Annotated[Path | None, typer.Option(help="Write the comparison's page.", metavar="FILE")] = None,
    json: Json = False,
) -> int:
    """Two or more designs on the same terrain, at the same places, with the same draws."""
    from rover_pin.cli.compare_report import comparison_object, print_comparison
    from rover_pin.cli.output import INTERRUPTED, aside, check_outputs, print_json

    check_outputs(out, html)
    results = [word for word in designs if word.endswith(".nc")]
    said = {
        "--study": study, "--terrain": terrain, "--cases": cases, "--measure": measure,
        "--gravity": gravity, "--payload": payload, "--out": out,
    }  # fmt: skip
    kept = _places(out, designs)
    started = time.perf_counter()
    if results:
        found = _read(designs, results, said, seed or 0)
    else:
        map_ = (terrain, spacing, interpolation, height_scale, height_offset)
        keys = _keys(map_, measure, package, skip_missing_includes)
        try:
            found = _run(designs, study, (gravity, payload), (cases, seed), keys, (engine, workers, kept))
        except KeyboardInterrupt:
            aside("interrupted")
            return INTERRUPTED
    seconds = time.perf_counter() - started
    if html is not None:
        from rover_pin.viz.page.compare import save_comparison_page

        save_comparison_page(found, html)
    if json:
        print_json(comparison_object(found, kept, html, seconds))
    else:
        print_comparison(found, seconds)
    for written in (*kept.values(), html):
        if written is not None:
            aside(f"wrote {written}")
    return 0 if any(pair.both for pair in found.pairs) else 1


def _keys(
    map_: tuple[str | None, float | None, str, float | None, float],
    measures: list[str] | None,
    package: list[str] | None,
    skip_missing_includes: bool,
) -> dict[str, Any]:
    """Entries of the study that options replace."""
    keys: dict[str, Any] = {}
    word, spacing, interpolation, scale, offset = map_
    if word is not None:
        from rover_pin.terrain import Terrain

        keys["terrain"] = Terrain.parse(word, spacing, interpolation, scale, offset)
    if measures:
        keys["measures"] = measures
    if package:
        keys["packages"] = pairs(package, "--package")
    if skip_missing_includes:
        keys["skip_missing_includes"] = True
    return keys


def _run(
    designs: list[str],
    study: Path | None,
    pulls: tuple[str | None, list[str] | None],
    counts: tuple[int | None, int | None],
    keys: dict[str, Any],
    how: tuple[str, int | None, dict[str, Path]],
) -> Comparison:
    """The designs on the study's cases, as options change it."""
    from rover_pin.analysis import Study
    from rover_pin.analysis import compare as side_by_side
    from rover_pin.analysis.comparison.same_cases import DEFAULT
    from rover_pin.analysis.yaml_file import parse_mapping
    from rover_pin.cli.output import announce_compilation
    from rover_pin.cli.progress import progress_bar

    base = Study.from_text(DEFAULT) if study is None else Study.from_file(study)
    base = altered(base, *pulls)
    drawn = {key: value for key, value in zip(("n", "seed"), counts, strict=True) if value is not None}
    if drawn:
        stated = parse_mapping(base.text).get("cases") or {}
        keys["cases"] = {**({"sampler": stated} if isinstance(stated, str) else stated), **drawn}
    engine, workers, kept = how
    announce_compilation(batch=True)
    with progress_bar("cases") as progress:
        return side_by_side(
            designs,
            base,
            engine=engine,
            workers=workers,
            out=kept or None,
            progress=progress,
            seed=counts[1] or 0,
            **keys,
        )


def _read(designs: list[str], results: list[str], said: dict[str, Any], seed: int) -> Comparison:
    """Results of studies that are there already."""
    from rover_pin.analysis import Study, paired
    from rover_pin.analysis.dataset import read

    if len(results) < len(designs):
        other = next(word for word in designs if word not in results)
        cure = "name designs only, or results only"
        raise InputError("is no result like the others", element="design", value=other, cure=cure)
    for option, given in said.items():
        if given:
            raise InputError("results have their own", element=option, value=given, cure="leave it out")
    for word in results:
        if results.count(word) > 1:
            raise InputError("is given twice", element="result", value=word, cure="compare different ones")
    data = {word: read(Path(word)) for word in results}
    return paired(data, studies={word: Study.from_dataset(each) for word, each in data.items()}, seed=seed)


def _places(out: Path | None, designs: list[str]) -> dict[str, Path]:
    """Where each design's result goes: OUT_A.nc and so on."""
    if out is None:
        return {}
    from rover_pin.analysis.comparison.names import letters

    return {word: out.with_name(f"{out.stem}_{name}.nc") for word, name in letters(designs).items()}
