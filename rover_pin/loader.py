"""From a name or a path to a Rover."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from rover_pin.description import catalogue, examples
from rover_pin.description.actuation import actuated_joints
from rover_pin.description.couplings import gather_couplings
from rover_pin.description.expand import expand, refuse_undeclared
from rover_pin.description.geometry import read_geometry
from rover_pin.description.gepetto import stands_in
from rover_pin.description.guesses import guesses_waiting
from rover_pin.description.limits import tell_zero_efforts
from rover_pin.description.masses import Masses
from rover_pin.description.mjcf import Converted, convert, is_mjcf
from rover_pin.description.model import BASE_DOF, build_model, joint_names, set_limits
from rover_pin.description.notes import Notes
from rover_pin.description.others import Kind, Other
from rover_pin.description.packages import Packages
from rover_pin.description.parameters import parameter_values
from rover_pin.description.prepare import prepare
from rover_pin.description.recipe import Recipe
from rover_pin.description.shapes import Placer
from rover_pin.description.sidecar import Sidecar, formulas_of, load_sidecar, read_sidecar
from rover_pin.description.stated import checked_postures, lockable_joints, resolve_springs
from rover_pin.errors import naming
from rover_pin.mechanism import Kinematics
from rover_pin.rover import Rover


def load(
    name_or_path: str | Path,
    *,
    sidecar: str | Path | None = None,
    packages: Mapping[str, str | Path] | None = None,
    skip_missing_includes: bool = False,
    **parameters: float,
) -> Rover:
    """A rover from a bundled name, or from a URDF or xacro file.

    Args:
        name_or_path: `rocker_bogie`, `example:anymal_b`, or a path. Xacro evaluates expressions: load only
            files you trust.
        sidecar: its file, or an SRDF; where silent, `rover.yaml` beside the description, else Gepetto's
            `robot.yaml` there, else only what the URDF says.
        packages: ROS package -> folder, for `package://` and `$(find ...)`.
        skip_missing_includes: leave out xacro includes that are not there.
        **parameters: numbers for parameters that the sidecar declares.

    Raises:
        InputError: anything that cannot be used, with file, element, value and cure.
    """
    bundled, path = catalogue.locate(name_or_path)
    sidecar_path = _sidecar_of(bundled, path, sidecar)
    return _from_files(
        bundled,
        path,
        sidecar_path,
        {name: str(folder) for name, folder in (packages or {}).items()},
        skip_missing_includes,
        parameters,
    )


def load_bare(path: Path, packages: Mapping[str, str], skip_missing_includes: bool = False) -> Rover:
    """What a URDF or xacro file says by itself, whatever lies beside it.

    Raises:
        InputError: as `load`.
    """
    return _from_files(None, path, None, packages, skip_missing_includes, {})


def reload(recipe: Recipe, parameters: Mapping[str, float]) -> Rover:
    """A rover read anew from its files, with some parameters changed, its masses and payload put back.

    Raises:
        InputError: as `load`.
    """
    rover = _from_files(
        recipe.name,
        recipe.source,
        recipe.sidecar_path,
        recipe.packages,
        recipe.skip_missing_includes,
        {**recipe.parameters, **parameters},
    )
    return _weighed(rover, recipe)


def _weighed(rover: Rover, recipe: Recipe) -> Rover:
    """The rover with a recipe's masses, and its payload on top."""
    rover = rover.with_masses(recipe.masses) if recipe.masses else rover
    return rover.with_payload(recipe.payload) if recipe.payload else rover


def _sidecar_of(bundled: str | None, path: Path, given: str | Path | None) -> Path | None:
    if given is not None:
        return Path(given).expanduser()
    if bundled is not None and bundled.startswith(examples.PREFIX):
        return examples.sidecar_of(bundled)
    beside = path.parent / catalogue.SIDECAR
    if beside.is_file():
        return beside
    theirs = path.parent / catalogue.GEPETTO
    return theirs if theirs.is_file() and stands_in(theirs) else None


def _from_files(
    bundled: str | None,
    path: Path,
    sidecar_path: Path | None,
    packages: Mapping[str, str],
    skip: bool,
    parameters: Mapping[str, float],
) -> Rover:
    found, notes = Packages(path, packages), Notes()
    mjcf = _converted(path, notes)
    extra: dict[Kind, Other] | None = (
        None if mjcf is None else {"mjcf": Other(file=str(path), text=mjcf.sidecar)}
    )
    spec, sidecar_text = load_sidecar(sidecar_path, found, extra)
    values = parameter_values(spec.parameters, parameters)
    used: set[str] = set()
    if sidecar_text is not None:
        used.update(*(formula.names for formula in formulas_of(sidecar_text, sidecar_path).values()))
    if mjcf is None:
        text = expand(path, values, found, notes, skip, sidecar_path, used)
    else:
        refuse_undeclared(path, values, sidecar_path, used)
        text = mjcf.urdf
    return assemble(
        Recipe(bundled, path, text, sidecar_path, sidecar_text, values, packages, skip, notes=notes.lines())
    )


def _converted(path: Path, notes: Notes) -> Converted | None:
    """An MJCF file in our terms; None where the file is something else, or nothing to read."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return None
    return convert(text, path, notes) if is_mjcf(text) else None


def assemble(recipe: Recipe) -> Rover:
    """A rover from its texts; meshes are looked for where they were, and missed without harm.

    Raises:
        InputError: what is wrong in the texts.
    """
    with naming(recipe.sidecar_path or recipe.source):
        return _assembled(recipe)


def _assembled(recipe: Recipe) -> Rover:
    file, text = recipe.sidecar_path, recipe.sidecar_text
    sidecar = Sidecar() if text is None else read_sidecar(text, file or recipe.source, recipe.parameters)
    notes = Notes(recipe.notes)
    if file is None:
        notes.add("no sidecar: suspension, wheels and actuation are only what the URDF says")
    elif waiting := guesses_waiting(text or ""):
        notes.add(f"{waiting} guesses of rover-pin init are still commented out in {file.name}: not used")
    made = prepare(recipe, sidecar, notes)
    name = recipe.name or made.tree.name or recipe.source.stem
    model = build_model(made.urdf, name, made.tree.joints)
    joints = joint_names(model)
    columns = {joint: len(BASE_DOF) + i for i, joint in enumerate(joints)}
    limits = set_limits(model, made.limits)
    placer = Placer(model, made.turning_axes(), file, notes)
    touching = placer.place(sidecar, made)
    driven = [w.drive for w in touching.wheels if w.drive is not None and w.drive in made.continuous]
    idle = sidecar.states.passive
    actuated = actuated_joints(
        made.tree, joints, sidecar.actuated, sidecar.passive, driven, notes, file, idle
    )
    tell_zero_efforts(made.limits, actuated, notes)
    couplings = gather_couplings(made.mimics, sidecar.couplings, made.held, notes, file)
    meshes = Packages(recipe.source, recipe.packages)
    rover = Rover(
        name=name,
        urdf=made.urdf,
        model=model,
        root=made.root,
        joints=joints,
        **limits,
        actuated=actuated,
        lockable=lockable_joints(sidecar, joints, actuated, file),
        couplings=tuple(c.resolve(columns, model.nv, file=file) for c in couplings),
        loops=tuple(loop.resolve(model, file=file) for loop in sidecar.loops),
        springs=resolve_springs(sidecar, columns, model, file),
        tracks=(),  # wrapped below, around the wheels as they stand at home
        wheels=touching.wheels,
        feet=touching.feet,
        belly=touching.belly,
        postures=checked_postures(sidecar, columns, made.held, limits, notes, file),
        recipe=dataclasses.replace(recipe, payload=(), masses=Masses()),
        loading_notes=notes.lines(),
        read_geometry=functools.cache(
            lambda: read_geometry(made.tree, model, meshes.resolve, touching.wheel_links, meshes.advice)
        ),
    )
    return _weighed(_with_tracks(rover, sidecar), recipe)


def _with_tracks(rover: Rover, sidecar: Sidecar) -> Rover:
    """The rover with its tracks around the wheels as they stand at home."""
    if not sidecar.tracks:
        return rover
    at = Kinematics(rover.model, rover.model.createData(), np.array(rover.neutral))
    wheels = {wheel.name: wheel for wheel in rover.wheels}
    tracks = tuple(spec.resolve(at, wheels, file=rover.sidecar_path) for spec in sidecar.tracks)
    return dataclasses.replace(rover, tracks=tracks)
