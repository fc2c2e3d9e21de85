"""A stance as a Meshcat scene, written through Meshcat's own Visualizer: every page shares it.

Paths: `rover` with a node or two a joint (see tree), `rover/.../visuals/N` for looks, `ground`, `loads`,
`tracks`, `springs`, `support/area`, `support/edges`, `support/region`, `com`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import InputError
from rover_pin.viz.arrows import load_arrows
from rover_pin.viz.inside import struts, tracks
from rover_pin.viz.meshes import bare_shapes, ring_surface, surface_object, visual_object
from rover_pin.viz.support import com_marker, region_edges, support_area, support_edges
from rover_pin.viz.terrain_mesh import ground_surface
from rover_pin.viz.tree import base_matrix, joint_nodes, turn

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.viz.surfaces import Surface


@dataclass(frozen=True)
class Drawn:
    """What a page should say of the picture.

    Attributes:
        contour_m: the contours' step, 0 where the ground has none.
        unread: names of mesh files that could not be read and are not drawn.
    """

    contour_m: float
    unread: tuple[str, ...] = ()


def span_of(rover: Rover) -> float:
    """The wheel span, m, by which marks are sized; a rover without one is taken as 1 m."""
    span = float(rover.wheel_span)
    return span if np.isfinite(span) and span > 1e-3 else 1.0


def draw_robot(visualizer: Any, rover: Rover) -> tuple[str, ...]:
    """The robot's looks in its tree of joints, the base and all joints at zero.

    Returns:
        Names of the meshes that could not be read.
    """
    nodes = {node.joint: node for node in joint_nodes(rover.model)}
    for node in nodes.values():
        if node.fixed:
            visualizer[node.fixed].set_transform(node.placement)
    count: Counter[int] = Counter()

    def put(joint: int, thing: Any, placement: Any) -> None:
        target = visualizer[f"{nodes[joint].path}/visuals/{count[joint]}"]
        count[joint] += 1
        target.set_object(thing)
        target.set_transform(placement)

    unread: list[str] = []
    for visual in rover.visuals:
        try:
            put(visual.joint, *visual_object(visual))
        except InputError:
            unread.append(Path(str(visual.mesh)).name)
    for shape in bare_shapes(rover):
        put(shape.joint, surface_object(ring_surface(shape)), np.eye(4))
    return tuple(dict.fromkeys(unread))


def pose_robot(visualizer: Any, stance: Stance) -> None:
    """Set the base and every joint."""
    for node in joint_nodes(stance.rover.model):
        if not node.fixed:
            matrix = base_matrix(stance.rover.model, stance.position, stance.rpy)
        else:
            matrix = turn(node, stance.joints.get(node.name, 0.0))
        visualizer[node.path].set_transform(matrix)


def draw(
    visualizer: Any,
    stance: Stance,
    *,
    limiting: str | None = None,
    region: Sequence[tuple[float, float]] = (),
) -> Drawn:
    """Write the whole scene of a stance.

    Args:
        visualizer: a meshcat.Visualizer, on a server or on a Recorder.
        stance: what to draw; one that did not settle has no loads, polygon or limiting edge.
        limiting: the edge to mark, "fl-ml"; else the one nearest the centre of mass.
        region: corners (x, y) m, world, of where the centre of mass may go (a margin's `outline`); drawn at
            the height of the contacts' mean.

    Returns:
        What a page should say of the picture.
    """
    span = span_of(stance.rover)
    visualizer.delete()
    unread = draw_robot(visualizer, stance.rover)
    pose_robot(visualizer, stance)
    ground, step = ground_surface(stance.terrain, float(stance.position[0]), float(stance.position[1]), span)
    visualizer["ground"].set_object(surface_object(ground))

    for path, surface in (
        ("tracks", tracks(stance.rover, stance.configuration, span, stance.terrain)),
        ("springs", struts(stance.rover, stance.configuration, span)),
    ):
        if len(surface.faces):
            visualizer[path].set_object(surface_object(surface))

    def put(path: str, surface: Surface, opacity: float) -> None:
        if len(surface.faces):
            visualizer[path].set_object(surface_object(surface, on_top=True, opacity=opacity))

    if stance.settled:
        put("support/area", support_area(stance), 0.14)
        put("support/edges", support_edges(stance, span, limiting), 0.9)
        put("support/region", region_edges(stance, span, region), 0.95)
        put("loads", load_arrows(stance, span), 0.95)
    put("com", com_marker(stance, span), 0.95)
    return Drawn(step, unread)
