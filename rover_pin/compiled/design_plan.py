"""What of a traced description the arrays of a design are made from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rover_pin.compiled.design_rows import Row, Stated, read_row, stated_row
from rover_pin.description.prepare import Prepared
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.trace import Trace
from rover_pin.description.tree import MOVING, Element, Tree, child_of, parent_of

if TYPE_CHECKING:
    from rover_pin.rover import Rover

_SHAPES = ("box", "cylinder", "sphere")
_SIZES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}


@dataclass(frozen=True)
class Shape:
    """A collision shape: where it sits on its link, and its size as in `Visual`."""

    kind: str
    xyz: Row
    rpy: Row
    size: Row


@dataclass(frozen=True)
class Link:
    """A link's mass [kg], its centre [m] and its collision shapes."""

    mass: Row
    center: Row
    shapes: tuple[Shape, ...]


@dataclass(frozen=True)
class Stops:
    """A joint's limits as stated [rad or m]; None where it has none."""

    lower: Row
    upper: Row


@dataclass(frozen=True)
class Branch:
    """A joint of the tree.

    Attributes:
        name: its name.
        parent: link.
        child: link.
        xyz: m, of its origin in the parent link.
        rpy: rad.
        axis: as stated, of a joint that moves by its type; None of a fixed one.
        sliding: whether it is prismatic.
        stops: its limits, or None where they are none.
        joint: Pinocchio's id, or 0 where it does not move.
    """

    name: str
    parent: str
    child: str
    xyz: Row
    rpy: Row
    axis: Row | None
    sliding: bool
    stops: Stops | None
    joint: int


@dataclass(frozen=True)
class Plan:
    """The tree of every design of a rover.

    Attributes:
        root: the link that is nobody's child.
        links: by name, in the URDF's order.
        branches: each after the one that carries it.
    """

    root: str
    links: Mapping[str, Link]
    branches: tuple[Branch, ...]

    def rows(self) -> Iterator[Row]:
        """Every row of numbers."""
        for link in self.links.values():
            yield from (link.mass, link.center)
            for shape in link.shapes:
                yield from (shape.xyz, shape.rpy, shape.size)
        for branch in self.branches:
            yield from (branch.xyz, branch.rpy)
            if branch.axis is not None:
                yield branch.axis
            if branch.stops is not None:
                yield from (branch.stops.lower, branch.stops.upper)


@dataclass(frozen=True)
class Reader:
    """Reads a plan: structure from the prepared URDF, numbers from the traced one.

    Attributes:
        rover: the nominal rover.
        made: its prepared URDF.
        traced: the URDF with tokens, as xacro gave it.
        sidecar: corrects it.
        trace: what the tokens stand for.
        stated: the sidecar's formulas.
    """

    rover: Rover
    made: Prepared
    traced: Tree
    sidecar: Sidecar
    trace: Trace
    stated: Stated

    def plan(self) -> Plan:
        """The plan.

        Raises:
            UntraceableError: a number that is put together from pieces of text.
        """
        tree = self.made.tree
        links = {name: self._link(name) for name in tree.links}
        below: dict[str, list[str]] = {}
        for name, joint in tree.joints.items():
            below.setdefault(parent_of(joint), []).append(name)
        branches: list[Branch] = []
        stack = [tree.root]
        while stack:
            for name in below.get(stack.pop(), ()):
                branches.append(self._branch(name))
                stack.append(branches[-1].child)
        return Plan(tree.root, links, tuple(branches))

    def _row(self, element: Element | None, key: str, default: str, owner: str) -> Row:
        text = default if element is None else element.get(key, default)
        return read_row(text, self.trace, owner)

    def _link(self, name: str) -> Link:
        owner = f"link {name}"
        corrected = name in self.sidecar.inertials or name not in self.traced.links
        link: Element = (self.made.tree if corrected else self.traced).links[name]
        inertial = link.find("inertial")
        mass = None if inertial is None else inertial.find("mass")
        center = None if inertial is None else inertial.find("origin")
        found = [self._shape(e, owner) for e in link.findall("collision")]
        shapes = tuple(shape for shape in found if shape is not None)
        spec = self.sidecar.inertials.get(name)
        if spec is not None:
            kg = self.stated.get(("inertials", name, "mass"), float(spec.mass))
            return Link((kg,), stated_row(self.stated, spec.com, "inertials", name, "com"), shapes)
        return Link(self._row(mass, "value", "0", owner), self._row(center, "xyz", "0 0 0", owner), shapes)

    def _shape(self, element: Element, owner: str) -> Shape | None:
        found = element.find("geometry/*")
        if found is None or found.tag not in _SHAPES:
            return None
        origin = element.find("origin")
        size = sum((self._row(found, key, "0", owner) for key in _SIZES[found.tag]), ())
        return Shape(
            str(found.tag),
            self._row(origin, "xyz", "0 0 0", owner),
            self._row(origin, "rpy", "0 0 0", owner),
            size,
        )

    def _branch(self, name: str) -> Branch:
        owner = f"joint {name}"
        prepared: Element = self.made.tree.joints[name]
        joint: Element = self.traced.joints.get(name, prepared)
        origin, freed = joint.find("origin"), self.sidecar.free.get(name)
        kind = joint.get("type") if freed is None else freed.type
        axis: Row | None = None
        stops: Stops | None = None
        if freed is not None:
            axis = stated_row(self.stated, freed.axis, "free", name, "axis")
            if freed.limits is not None and kind != "continuous":
                low, high = stated_row(self.stated, freed.limits, "free", name, "limits")
                stops = Stops((low,), (high,))
        elif kind in MOVING:
            axis = self._row(joint.find("axis"), "xyz", "1 0 0", owner)
            stops = None if kind == "continuous" else self._stops(joint, owner)
        return Branch(
            name,
            parent_of(prepared),
            child_of(prepared),
            self._row(origin, "xyz", "0 0 0", owner),
            self._row(origin, "rpy", "0 0 0", owner),
            axis,
            kind == "prismatic",
            stops,
            int(self.rover.model.getJointId(name)) if name in self.made.limits else 0,
        )

    def _stops(self, joint: Element, owner: str) -> Stops | None:
        limit = joint.find("limit")
        if limit is None or (limit.get("lower") is None and limit.get("upper") is None):
            return None
        return Stops(self._row(limit, "lower", "0", owner), self._row(limit, "upper", "0", owner))
