"""Geoms: their shapes in URDF's words, and the mass that they give a body without `<inertial>`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from rover_pin.description.mjcf.reading import Element, Source, along
from rover_pin.numerics import Array

_SHAPELESS = ("plane", "hfield", "sdf")


@dataclass(frozen=True)
class Geom:
    """A shape on a body.

    Attributes:
        kind: box, sphere, cylinder, capsule, ellipsoid or mesh.
        size: halves and radii as MJCF has them [m]; of a mesh, its scales.
        placed: in the body's frame.
        mesh: the mesh's file, or None.
        touches: whether it collides with anything.
        element: as it stands in the file.
    """

    kind: str
    size: tuple[float, ...]
    placed: pin.SE3
    mesh: Path | None
    touches: bool
    element: Element


def geoms_of(source: Source, body: Element) -> list[Geom]:
    """The body's own geoms; planes and height fields are scenery.

    Raises:
        DescriptionError: a kind or size that is none.
    """
    found = []
    for element in body.iterfind("geom"):
        kind = source.get(element, "type", "mesh" if source.get(element, "mesh") else "sphere") or "sphere"
        if kind in _SHAPELESS:
            continue
        touches = (source.get(element, "contype", "1"), source.get(element, "conaffinity", "1")) != ("0", "0")
        if kind == "mesh":
            scale, file = _mesh(source, element)
            found.append(Geom(kind, scale, source.placed(element), file, touches, element))
            continue
        size, placed = source.numbers(element, "size"), source.placed(element)
        ends = source.numbers(element, "fromto")
        if len(ends) == 6:
            first, last = np.array(ends[:3]), np.array(ends[3:])
            placed = pin.SE3(along(first - last), (first + last) / 2)
            half = float(np.linalg.norm(last - first)) / 2
            size = [size[0], half] if kind in ("cylinder", "capsule") else [size[0], size[0], half]
        wanted = {"sphere": 1, "cylinder": 2, "capsule": 2, "box": 3, "ellipsoid": 3}.get(kind)
        if wanted is None:
            raise source.error(
                "unknown kind of geom", element, kind, "use box, sphere, cylinder, capsule or mesh"
            )
        if len(size) < wanted or min(size[:wanted]) <= 0:
            raise source.error(
                f"a {kind} needs {wanted} sizes above zero", element, str(size), "give them in m"
            )
        found.append(Geom(kind, tuple(size[:wanted]), placed, None, touches, element))
    return found


def _mesh(source: Source, element: Element) -> tuple[tuple[float, ...], Path | None]:
    name = source.get(element, "mesh")
    for asset in source.root.iterfind("asset/mesh"):
        file = asset.get("file") or ""
        if (asset.get("name") or Path(file).stem) != name:
            continue
        scale = source.numbers(asset, "scale", "1 1 1", 3)
        folder = source.compiler.get("meshdir") or source.compiler.get("assetdir") or ""
        path = source.path.parent / folder / file
        return tuple(scale), path if file and path.is_file() else None
    raise source.error("no mesh of that name", element, name, "declare it under <asset>")


def inertia_of(source: Source, geom: Geom) -> pin.Inertia:
    """Of a solid of the geom's `mass`, else its `density` (1000 kg/m3 unless told), in the body's frame.

    Raises:
        DescriptionError: a mesh that cannot be measured and has mass.
    """
    volume, com, tensor = _solid(source, geom)
    stated = source.numbers(geom.element, "mass", count=None)
    mass = stated[0] if stated else volume * source.numbers(geom.element, "density", "1000")[0]
    if mass < 0:
        raise source.error("negative mass", geom.element, mass, "give its mass in kg, or density in kg/m3")
    if volume <= 0 or mass == 0:
        return pin.Inertia.Zero()
    try:
        return geom.placed.act(pin.Inertia(mass, com, tensor * (mass / volume)))
    except RuntimeError as problem:  # Pinocchio's own check of the tensor
        raise source.error(
            f"no inertia: {problem}", geom.element, str(geom.size), "mend its sizes"
        ) from problem


def _solid(source: Source, geom: Geom) -> tuple[float, Array, Array]:
    """Volume, centre and moments about it at density 1."""
    size, zero = geom.size, np.zeros(3)
    if geom.kind == "mesh":
        return _measured(source, geom)
    if geom.kind == "sphere":
        volume = 4 / 3 * math.pi * size[0] ** 3
        return volume, zero, np.eye(3) * 0.4 * volume * size[0] ** 2
    if geom.kind in ("box", "ellipsoid"):
        a, b, c = size
        volume = 8 * a * b * c if geom.kind == "box" else 4 / 3 * math.pi * a * b * c
        share = volume / (3 if geom.kind == "box" else 5)
        return volume, zero, share * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    radius, half = size
    tube = 2 * half * math.pi * radius**2
    about, across = tube * radius**2 / 2, tube * (radius**2 / 4 + half**2 / 3)
    volume = tube
    if geom.kind == "capsule":
        ball = 4 / 3 * math.pi * radius**3
        volume += ball
        about += 0.4 * ball * radius**2
        across += ball * (0.4 * radius**2 + half**2 + 0.75 * half * radius)
    return volume, zero, np.diag([across, across, about])


def _measured(source: Source, geom: Geom) -> tuple[float, Array, Array]:
    import trimesh

    if source.numbers(geom.element, "mass") == [0.0] or source.numbers(geom.element, "density") == [0.0]:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    cure = "put the mesh there, or give the body an <inertial>"
    if geom.mesh is None:
        raise source.error("its mesh is missing, and its body's mass hangs on it", geom.element, cure=cure)
    try:
        mesh: Any = trimesh.load(geom.mesh, force="mesh")
        mesh.apply_scale(geom.size)
        found = mesh.mass_properties
        return float(found["volume"]), np.array(found["center_mass"]), np.array(found["inertia"])
    except Exception as problem:  # trimesh raises whatever a damaged mesh or a missing reader makes it raise
        raise source.error("its mesh cannot be measured", geom.element, str(geom.mesh), cure) from problem
