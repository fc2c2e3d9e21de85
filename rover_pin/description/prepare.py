"""From a recipe's texts to a URDF tree that means what its author meant, and what was found on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.description import checks, retype, rewrite, suspects
from rover_pin.description.limits import Limits
from rover_pin.description.mimic import Mimic, read_mimics
from rover_pin.description.notes import Notes
from rover_pin.description.recipe import Recipe
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.tree import Tree, numbers, parse
from rover_pin.numerics import Array


@dataclass(frozen=True)
class Prepared:
    """A URDF ready to be built on.

    Attributes:
        tree: rewritten, shapes and foreign tags still in it.
        urdf: the bare text for Pinocchio.
        root: the URDF's own root link (a link that turns `up` to z may stand above it).
        limits: per moving joint.
        held: joints that their limits lock, and where.
        mimics: joints that follow another.
        continuous: joints that the URDF lets turn without end.
    """

    tree: Tree
    urdf: str
    root: str
    limits: Mapping[str, Limits]
    held: Mapping[str, float]
    mimics: tuple[Mimic, ...]
    continuous: frozenset[str]

    def turning_axes(self) -> dict[str, Array]:
        """Axis of every turning joint, unit, in its own frame."""
        return {
            name: np.array(numbers(joint.find("axis").get("xyz")))
            for name, joint in self.tree.joints.items()
            if joint.get("type") == "revolute"
        }


def prepare(recipe: Recipe, sidecar: Sidecar, notes: Notes) -> Prepared:
    """Check the URDF, let the sidecar correct it, and write it anew for Pinocchio.

    Raises:
        DescriptionError: something in the URDF that cannot be used.
        SidecarError: a correction of a joint or link that is not there.
    """
    file = recipe.sidecar_path
    tree = parse(recipe.text, str(recipe.source))
    checks.check(tree)
    retype.refuse_unknown(tree, sidecar.retype, file)
    rewrite.free_joints(tree, sidecar.free, file)
    rewrite.override_inertials(tree, sidecar.inertials, file)
    rewrite.drop_floating_root(tree, notes)
    suspects.tell_masses(tree, notes)
    suspects.tell_inertias(tree, notes)
    suspects.tell_gazebo_loops(tree, notes)
    suspects.tell_dynamics(tree, notes)
    continuous = suspects.continuous_joints(tree)
    retype.retype_joints(tree, sidecar.retype)
    mimics = read_mimics(tree, notes)
    limits, held = rewrite.settle_joints(tree, notes)
    root = tree.root
    rewrite.turn_up(tree, sidecar.up)
    return Prepared(tree, rewrite.bare_text(tree), root, limits, held, tuple(mimics), continuous)
