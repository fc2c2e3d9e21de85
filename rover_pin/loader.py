"""From a name or a path to a Rover."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

from rover_pin.description import catalogue, checks, rewrite, suspects
from rover_pin.description.actuation import actuated_joints
from rover_pin.description.couplings import gather_couplings
from rover_pin.description.expand import expand
from rover_pin.description.geometry import read_geometry
from rover_pin.description.limits import Limits
from rover_pin.description.mimic import read_mimics
from rover_pin.description.model import BASE_DOF, build_model, joint_names, set_limits
from rover_pin.description.notes import Notes
from rover_pin.description.packages import Packages
from rover_pin.description.parameters import parameter_values
from rover_pin.description.recipe import Recipe
from rover_pin.description.shapes import Placer
from rover_pin.description.sidecar import Sidecar, load_sidecar, read_sidecar
from rover_pin.description.tree import Tree, numbers, parse
from rover_pin.errors import PostureError, SidecarError, nearest
from rover_pin.mechanism import JointSpringSpec, Spring
from rover_pin.numerics import Array
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
        name_or_path: `rocker_bogie`, or a path. Xacro evaluates expressions: load only files you trust.
        sidecar: its file; where silent, `rover.yaml` beside the description, else everything is guessed and noted.
        packages: ROS package -> folder, for `package://` and `$(find ...)`.
        skip_missing_includes: leave out xacro includes that are not there.
        **parameters: numbers for parameters that the sidecar declares.

    Raises:
        InputError: anything that cannot be used, with file, element, value and cure.
    """
    bundled, path = catalogue.locate(name_or_path)
    sidecar_path = _sidecar_of(path, sidecar)
    return _from_files(
        bundled,
        path,
        sidecar_path,
        {name: str(folder) for name, folder in (packages or {}).items()},
        skip_missing_includes,
        parameters,
    )


def reload(recipe: Recipe, parameters: Mapping[str, float]) -> Rover:
    """A rover read anew from its files, with some parameters changed and its payload put back.

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
    return rover.with_payload(recipe.payload) if recipe.payload else rover


def _sidecar_of(path: Path, given: str | Path | None) -> Path | None:
    if given is not None:
        return Path(given).expanduser()
    beside = path.parent / catalogue.SIDECAR
    return beside if beside.is_file() else None


def _from_files(
    bundled: str | None,
    path: Path,
    sidecar_path: Path | None,
    packages: Mapping[str, str],
    skip: bool,
    parameters: Mapping[str, float],
) -> Rover:
    spec, sidecar_text = (Sidecar(), None) if sidecar_path is None else load_sidecar(sidecar_path)
    values = parameter_values(spec.parameters, parameters)
    notes = Notes()
    text = expand(path, values, Packages(path, packages), notes, skip)
    return assemble(
        Recipe(bundled, path, text, sidecar_path, sidecar_text, values, packages, skip, notes=notes.lines())
    )


def assemble(recipe: Recipe) -> Rover:
    """A rover from its texts; meshes are looked for where they were, and missed without harm.

    Raises:
        InputError: what is wrong in the texts.
    """
    file = recipe.sidecar_path
    spec = Sidecar() if recipe.sidecar_text is None else read_sidecar(recipe.sidecar_text, file)
    notes = Notes()
    for line in recipe.notes:
        notes.add(line)
    if file is None:
        notes.add("no sidecar: suspension, wheels and actuation are only what the URDF says")
    tree = parse(recipe.text, str(recipe.source))
    checks.check(tree)
    rewrite.free_joints(tree, spec.free, file)
    rewrite.override_inertials(tree, spec.inertials, file)
    for name in spec.inertials:
        checks.inertia(tree, name, tree.links[name])
    rewrite.drop_floating_root(tree, notes)
    suspects.tell_masses(tree, notes)
    suspects.tell_gazebo_loops(tree, notes)
    suspects.tell_dynamics(tree, notes)
    continuous = suspects.continuous_joints(tree)
    mimics = read_mimics(tree, notes)
    settled = rewrite.settle_joints(tree, notes)
    root = tree.root
    rewrite.turn_up(tree, spec.up)
    urdf = rewrite.bare_text(tree)
    name = recipe.name or tree.name or recipe.source.stem
    model = build_model(urdf, name)
    joints = joint_names(model)
    _refuse_reserved(tree, joints)
    limits = set_limits(model, settled.limits)
    placer = Placer(model, _axes(tree, joints), file, notes)
    wheels, feet, belly = placer.wheels(spec.wheels), placer.feet(spec.contacts), placer.belly(spec.belly)
    if not wheels and not feet:
        notes.add("no wheels nor contacts are declared: nothing touches the ground")
    suspects.tell_undeclared_wheels(tree, continuous, [w.link for w in wheels], notes)
    above = [w.drive for w in wheels if w.drive in continuous and w.drive is not None]
    actuated = actuated_joints(tree, joints, spec.actuated, spec.passive, above, notes, file)
    columns = {joint: len(BASE_DOF) + i for i, joint in enumerate(joints)}
    couplings = gather_couplings(mimics, spec.couplings, settled.held, notes, file)
    not_hull = _wheel_links(model, placer, spec, wheels)
    packages = Packages(recipe.source, recipe.packages)
    rover = Rover(
        name=name,
        urdf=urdf,
        model=model,
        root=root,
        joints=joints,
        **limits,
        actuated=actuated,
        lockable=_lockable(spec, joints, actuated, file),
        couplings=tuple(c.resolve(columns, model.nv, file=file) for c in couplings),
        loops=tuple(loop.resolve(model, file=file) for loop in spec.loops),
        springs=tuple(_springs(spec, columns, model, file)),
        tracks=(),
        wheels=wheels,
        feet=feet,
        belly=belly,
        postures=_postures(spec, columns, settled.held, limits, file),
        recipe=recipe,
        loading_notes=notes.lines(),
        read_geometry=functools.cache(lambda: read_geometry(tree, model, packages.resolve, not_hull)),
    )
    return _loaded(rover, recipe)


def _loaded(rover: Rover, recipe: Recipe) -> Rover:
    if not recipe.payload:
        return rover
    import dataclasses

    bare = dataclasses.replace(rover, recipe=dataclasses.replace(recipe, payload=()))
    return bare.with_payload(recipe.payload)


def _axes(tree: Tree, joints: Sequence[str]) -> dict[str, Array]:
    """Axis of every turning joint, in its own frame."""
    return {
        name: np.array(numbers(tree.joints[name].find("axis").get("xyz")))
        for name in joints
        if tree.joints[name].get("type") == "revolute"
    }


def _refuse_reserved(tree: Tree, joints: Sequence[str]) -> None:
    for name in joints:
        if name in BASE_DOF or name in ("universe", "root_joint"):
            raise tree.error("a name kept for the base", f"joint {name}", cure="rename the joint")


def _wheel_links(model: pin.Model, placer: Placer, spec: Sidecar, wheels: Sequence[object]) -> frozenset[str]:
    """Links that are wheels: all that turn with one, and the link of one that is rigid and centred on its frame."""
    links: set[str] = set()
    for entry, wheel in zip(spec.wheels, placer.wheels(spec.wheels), strict=True):
        if wheel.drive is not None:
            turning = model.getJointId(wheel.drive)
            links |= {
                f.name for f in model.frames if f.type == pin.FrameType.BODY and f.parentJoint == turning
            }
        elif not any(entry.center):
            links.add(wheel.link)
    return frozenset(links)


def _lockable(spec: Sidecar, joints: Sequence[str], actuated: Sequence[str], file: object) -> tuple[str, ...]:
    for i, name in enumerate(spec.locks):
        if name not in joints:
            raise SidecarError(
                "no moving joint of that name",
                file=file,
                element=f"locks[{i}]",
                value=name,
                cure=nearest(name, joints),
            )
        if name in actuated:
            raise SidecarError(
                "a driven joint is held anyway",
                file=file,
                element=f"locks[{i}]",
                value=name,
                cure="list passive joints",
            )
    return spec.locks


def _springs(spec: Sidecar, columns: Mapping[str, int], model: pin.Model, file: object) -> list[Spring]:
    return [
        s.resolve(columns, file=file) if isinstance(s, JointSpringSpec) else s.resolve(model, file=file)
        for s in spec.springs
    ]


def _postures(
    spec: Sidecar,
    columns: Mapping[str, int],
    held: Mapping[str, float],
    limits: Mapping[str, Array],
    file: object,
) -> dict[str, dict[str, float]]:
    """The sidecar's postures; a joint that its limits hold may be named at its place.

    Raises:
        PostureError: an unknown joint, or a value outside limits.
    """
    postures: dict[str, dict[str, float]] = {}
    for posture, values in spec.postures.items():
        kept = postures.setdefault(posture, {})
        for name, value in values.items():
            element = f"postures.{posture}.{name}"
            if name in held and math.isclose(value, held[name], abs_tol=1e-6):
                continue
            if name not in columns:
                raise PostureError(
                    "no moving joint of that name",
                    file=file,
                    element=element,
                    value=value,
                    cure=nearest(name, columns),
                )
            lower, upper = (float(limits[key][columns[name]]) for key in ("lower", "upper"))
            if not lower <= value <= upper:
                raise PostureError(
                    f"posture outside limits: Joint {name}: {lower:g} <= {value:g} <= {upper:g}",
                    file=file,
                    element=element,
                    cure="stay within the limits",
                )
            kept[name] = float(value)
    return postures
