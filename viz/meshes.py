"""The robot's own looks: URDF primitives and meshes, and rings where a wheel has none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import InputError
from rover_pin.numerics import Array
from rover_pin.viz.colours import BODY, HUB, RUBBER, hexadecimal
from rover_pin.viz.surfaces import Surface, joined, revolved, ring_profile

if TYPE_CHECKING:
    from rover_pin.rover import Rover

Y_TO_Z = np.array(
    [[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]]
)  # three.js cylinders lie along y


def surface_object(surface: Surface, *, on_top: bool = False, opacity: float = 1.0) -> Any:
    """A Meshcat object of a coloured mesh; `on_top` is unshaded and hides behind nothing."""
    from meshcat import geometry as g

    geometry = g.TriangularMeshGeometry(surface.vertices, surface.faces, surface.colours)
    if on_top:
        material = g.MeshBasicMaterial(
            vertexColors=True, opacity=opacity, transparent=True, depthTest=False, depthWrite=False
        )
    else:
        material = g.MeshPhongMaterial(vertexColors=True, opacity=opacity, shininess=8)
    return g.Mesh(geometry, material)


def visual_object(visual: Any) -> tuple[Any, Array]:
    """The Meshcat object of a URDF visual, and its (4, 4) placement in the joint's frame."""
    from meshcat import geometry as g

    red, green, blue, alpha = (float(part) for part in (visual.rgba or (*BODY, 1.0)))
    material = g.MeshPhongMaterial(color=hexadecimal((red, green, blue)), opacity=alpha, shininess=12)
    placement = np.asarray(visual.placement, dtype=np.float64)
    size = [float(part) for part in np.atleast_1d(visual.size)] if visual.size is not None else []
    if visual.kind == "box":
        return g.Mesh(g.Box(size), material), placement
    if visual.kind == "cylinder":
        return g.Mesh(g.Cylinder(size[1], size[0]), material), placement @ Y_TO_Z
    if visual.kind == "sphere":
        return g.Mesh(g.Sphere(size[0]), material), placement
    vertices, faces = _read_mesh(str(visual.mesh))
    scale = np.array(size) if size else np.ones(3)
    return g.Mesh(g.TriangularMeshGeometry(vertices * scale, faces), material), placement


def _read_mesh(path: str) -> tuple[Array, Any]:
    """Vertices and faces of a mesh file of any form that trimesh reads, its scene flattened.

    Corners sharper than trimesh's smoothing angle keep their edge, which shared vertices would round off.

    Raises:
        InputError: the file cannot be read.
    """
    import trimesh

    try:
        mesh: Any = trimesh.load(path, force="mesh")
        if not len(mesh.faces):
            mesh = _by_coal(path)
    except Exception as error:  # its readers raise whatever their formats' libraries raise
        raise InputError(
            "this mesh cannot be read", file=path, value=str(error), cure="convert it"
        ) from error
    if len(mesh.faces) < 60_000:
        mesh = trimesh.graph.smooth_shade(mesh, angle=np.radians(30))
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)


def _by_coal(path: str) -> Any:
    """The mesh as Pinocchio's collision library reads it: COLLADA files of which trimesh takes nothing."""
    import coal
    import trimesh

    read = coal.MeshLoader().load(path, np.ones(3))
    if not read.num_tris:
        raise ValueError("no faces")
    faces = [[read.tri_indices(i)[k] for k in range(3)] for i in range(read.num_tris)]
    return trimesh.Trimesh(np.array(read.vertices()), np.array(faces))


def ring_surface(shape: Any) -> Surface:
    """What touches the ground, in its joint's frame: a wheel's swept ring, a ball or a capsule.

    The side is drawn lighter inside two thirds of the ring, where the hub is.
    """
    ring, tread = float(shape.ring), max(float(shape.tread), 2e-3)
    center, axis = np.asarray(shape.center, dtype=np.float64), np.asarray(shape.axis, dtype=np.float64)
    if not np.any(axis):
        axis = np.array([0.0, 1.0, 0.0])
    if shape.form == 1:
        profile = ring_profile(0.0, tread)
        profile[:, 1] += np.where(np.arange(len(profile)) <= len(profile) // 2, -ring, ring)
        return revolved(profile, np.tile(RUBBER, (len(profile), 1)), center, axis, 32)
    profile = ring_profile(ring, tread)
    tyre = revolved(profile, np.tile(RUBBER, (len(profile), 1)), center, axis, 48)
    if ring <= 0:
        return tyre
    hub, lift, colour = 0.62 * ring, 1.02 * tread, np.tile(HUB, (2, 1))
    sides = [np.array([[0.0, -lift], [hub, -lift]]), np.array([[hub, lift], [0.0, lift]])]
    return joined([tyre, *(revolved(side, colour, center, axis, 32) for side in sides)])


def bare_shapes(rover: Rover) -> list[Any]:
    """Wheels and feet whose link has no visual of its own."""
    dressed = {visual.link for visual in rover.visuals}
    return [shape for shape in rover.shapes if shape.link not in dressed]
