"""Shapes of the links: what a viewer draws, and points of the hull that must stay above the ground."""

from __future__ import annotations

import io
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pinocchio as pin

from rover_pin.description.notes import Notes
from rover_pin.description.tree import Tree
from rover_pin.numerics import Array, frozen

SPACING = 0.05  # m between neighbouring points of the hull, at most

_SIGNS = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])

Kind = Literal["box", "cylinder", "sphere", "mesh"]


@dataclass(frozen=True)
class Visual:
    """One drawn shape.

    Attributes:
        link: the link it belongs to.
        joint: Pinocchio's id of the joint that carries the link.
        placement: (4, 4) in that joint's frame.
        kind: box, cylinder (about its z), sphere or mesh.
        size: box: three edges; cylinder: radius, length; sphere: radius; mesh: three scales. m.
        mesh: the mesh's file, or None.
        rgba: colour, 0 to 1.
    """

    link: str
    joint: int
    placement: Array
    kind: Kind
    size: tuple[float, ...]
    mesh: Path | None
    rgba: tuple[float, float, float, float]


@dataclass(frozen=True)
class BodyPoint:
    """A point, or a ball, of a link.

    Attributes:
        link: the link.
        joint: Pinocchio's id of the joint that carries it.
        point: (3,) m, in that joint's frame.
        radius: m; of a ball, zero for a point.
    """

    link: str
    joint: int
    point: Array
    radius: float = 0.0


@dataclass(frozen=True)
class Geometry:
    """What is drawn, what bounds the robot, and what was left out.

    Attributes:
        visuals: what a viewer draws.
        hull: points of collision shapes, closely spaced.
        around: corners of the boxes around the same shapes.
        notes: what was left out.
    """

    visuals: tuple[Visual, ...]
    hull: tuple[BodyPoint, ...]
    around: tuple[BodyPoint, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class LinkShape:
    """A shape as a URDF states it; `address` is a mesh's, else empty; the rest as in `Visual`."""

    link: str
    joint: int
    placement: Array
    kind: Kind
    size: tuple[float, ...]
    address: str
    rgba: tuple[float, float, float, float]


def read_geometry(
    tree: Tree,
    model: pin.Model,
    resolve: Callable[[str], Path | None],
    without_hull: Collection[str],
    advice: Callable[[str], str] | None = None,
) -> Geometry:
    """Visual and collision shapes of a URDF; meshes are found but not opened.

    Args:
        tree: the URDF.
        model: its Pinocchio model, for the links' places.
        resolve: address of a mesh -> its file, or None.
        without_hull: links whose collision shapes do not count: the wheels.
        advice: address of a mesh in a package -> where it was looked for, and the cure.
    """
    notes = Notes()
    robot = _structure(tree, notes)
    colours = {m.name: m.color.rgba for m in robot.materials or [] if m.color is not None}
    visuals, missing = [], []
    for shape in _shapes(robot.links, "visuals", model, colours):
        mesh = resolve(shape.address) if shape.kind == "mesh" else None
        if shape.kind == "mesh" and mesh is None:
            missing.append(shape.address)
            continue
        visuals.append(
            Visual(shape.link, shape.joint, shape.placement, shape.kind, shape.size, mesh, shape.rgba)
        )
    notes.many(missing, "mesh {name} is missing: not drawn", "{n} meshes are missing: not drawn ({names})")
    if advice is not None:
        packages = {address.split("/")[2]: address for address in missing if address.startswith("package://")}
        for name, address in packages.items():
            notes.add(f"package {name}: {advice(address)}")
    points: list[BodyPoint] = []
    corners: list[BodyPoint] = []
    meshed = []
    for shape in _shapes(robot.links, "collisions", model, {}):
        if shape.link in without_hull:
            continue
        if shape.kind == "mesh":
            meshed.append(shape.link)
            continue
        points.extend(_hull_points(shape))
        corners.extend(_placed(shape, corners_around(shape.kind, np.array(shape.size))))
    notes.many(
        list(dict.fromkeys(meshed)),
        "link {name}: its collision mesh is not tested against the ground; "
        "use boxes, cylinders, spheres or `belly`",
        "collision meshes of {n} links are not tested against the ground ({names}); "
        "use boxes, cylinders, spheres or `belly`",
    )
    return Geometry(tuple(visuals), tuple(points), tuple(corners), notes.lines())


def shapes_of(tree: Tree, model: pin.Model) -> tuple[LinkShape, ...]:
    """Collision shapes, then visual ones."""
    links = _structure(tree, Notes()).links
    return tuple(shape for key in ("collisions", "visuals") for shape in _shapes(links, key, model, {}))


def _structure(tree: Tree, notes: Notes) -> Any:
    """The robot as yourdfpy reads it, meshes not loaded; shapes it does not know are left out."""
    import yourdfpy
    from lxml import etree

    robot = etree.fromstring(etree.tostring(tree.robot))
    for parent in robot.iterfind("link"):
        for tag in ("visual", "collision"):
            for element in parent.findall(tag):
                shape = element.find("geometry/*")
                if shape is None or shape.tag not in {"box", "cylinder", "sphere", "mesh"}:
                    kind = "empty" if shape is None else f"<{shape.tag}>"
                    notes.add(f"link {parent.get('name')}: {kind} {tag} shape left out")
                    parent.remove(element)
    for element in list(robot):
        if element.tag not in {"link", "joint", "material"}:
            robot.remove(element)
    robot.set("name", tree.name or "robot")
    try:
        return yourdfpy.URDF.load(
            io.BytesIO(etree.tostring(robot)), build_scene_graph=False, load_meshes=False
        ).robot
    except Exception as problem:  # it raises whatever an odd shape or colour makes it raise
        raise tree.error(
            f"shapes or colours cannot be read: {problem!r}", "robot", cure="mend them"
        ) from problem


def _shapes(links: Iterable[Any], key: str, model: pin.Model, colours: dict[str, Any]) -> Iterator[LinkShape]:
    for link in links:
        frame = model.frames[model.getFrameId(link.name, pin.FrameType.BODY)]
        for element in getattr(link, key):
            kind, size, address = _measure(element.geometry)
            origin = np.eye(4) if element.origin is None else element.origin
            yield LinkShape(
                link.name,
                int(frame.parentJoint),
                frozen(frame.placement.homogeneous @ origin),
                kind,
                size,
                address,
                _colour(getattr(element, "material", None), colours),
            )


def _measure(geometry: Any) -> tuple[Kind, tuple[float, ...], str]:
    if geometry.box is not None:
        return "box", tuple(map(float, geometry.box.size)), ""
    if geometry.cylinder is not None:
        return "cylinder", (float(geometry.cylinder.radius), float(geometry.cylinder.length)), ""
    if geometry.sphere is not None:
        return "sphere", (float(geometry.sphere.radius),), ""
    scale = geometry.mesh.scale
    size = np.broadcast_to(1.0 if scale is None else scale, 3)
    return "mesh", tuple(map(float, size)), str(geometry.mesh.filename)


def _colour(material: Any, colours: dict[str, Any]) -> tuple[float, float, float, float]:
    rgba = None
    if material is not None:
        rgba = material.color.rgba if material.color is not None else colours.get(material.name)
    r, g, b, a = (0.7, 0.7, 0.7, 1.0) if rgba is None else map(float, rgba)
    return r, g, b, a


def _hull_points(shape: LinkShape) -> list[BodyPoint]:
    """Points of a shape no further apart than `SPACING`; a ball as such."""
    if shape.kind == "sphere":
        return _placed(shape, np.zeros((1, 3)), shape.size[0])
    return _placed(shape, _box(shape.size) if shape.kind == "box" else _cylinder(shape.size))


def _placed(shape: LinkShape, local: Array, radius: float = 0.0) -> list[BodyPoint]:
    turned = local @ shape.placement[:3, :3].T + shape.placement[:3, 3]
    return [BodyPoint(shape.link, shape.joint, frozen(p), radius) for p in turned]


def corners_around(kind: str, size: Array) -> Array:
    """(..., 8, 3) corners of the box around a shape, in its own axes.

    Args:
        kind: box, cylinder or sphere.
        size: (..., k) as in `Visual.size` [m].
    """
    if kind == "box":
        half = size / 2
    elif kind == "cylinder":
        half = np.stack([size[..., 0], size[..., 0], size[..., 1] / 2], axis=-1)
    else:
        half = np.repeat(size, 3, axis=-1)
    corners: Array = half[..., None, :] * _SIGNS
    return corners


def _steps(length: float) -> int:
    return max(1, int(np.ceil(length / SPACING - 1e-9)))


def _box(size: tuple[float, ...]) -> Array:
    """(n, 3) points on the faces of a box, corners and edges among them."""
    axes = [np.linspace(-s / 2, s / 2, _steps(s) + 1) for s in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    half = np.array(size) / 2
    on_face = np.any(np.isclose(np.abs(grid), half, rtol=0, atol=1e-12), axis=1)
    return np.asarray(grid[on_face], dtype=np.float64)


def _cylinder(size: tuple[float, ...]) -> Array:
    """(n, 3) points on the mantle of a cylinder about z, its rims among them."""
    radius, length = size
    angles = np.linspace(0, 2 * np.pi, max(8, _steps(2 * np.pi * radius)), endpoint=False)
    heights = np.linspace(-length / 2, length / 2, _steps(length) + 1)
    a, h = (m.ravel() for m in np.meshgrid(angles, heights, indexing="ij"))
    return np.column_stack([radius * np.cos(a), radius * np.sin(a), h])
