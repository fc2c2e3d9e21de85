"""`<mimic>` tags: one joint follows another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rover_pin.description.notes import Notes
from rover_pin.description.tree import MOVING, Tree
from rover_pin.errors import nearest


@dataclass(frozen=True)
class Mimic:
    """joint = multiplier * of + offset."""

    joint: str
    of: str
    multiplier: float
    offset: float

    def __str__(self) -> str:
        """The relation, for messages."""
        return f"{self.multiplier:g} {self.of} + {self.offset:g}"


def read_mimics(tree: Tree, notes: Notes) -> list[Mimic]:
    """All mimics of moving joints, once each; `<mimic>` tags and those under `<ros2_control>`.

    Raises:
        DescriptionError: a joint that is not there or does not move, two different mimics of one joint,
            or a circle.
    """
    found: dict[str, Mimic] = {}
    for mimic in _stated(tree):
        where = f"joint {mimic.joint}"
        if tree.joints[mimic.joint].get("type") not in MOVING:
            notes.each(
                mimic.joint,
                "joint {name}: <mimic> on a fixed joint dropped",
                "<mimic> on {n} fixed joints dropped ({names})",
            )
            continue
        if mimic.of not in tree.joints:
            raise tree.error(
                "it mimics a joint that does not exist", where, mimic.of, nearest(mimic.of, tree.joints)
            )
        if tree.joints[mimic.of].get("type") not in MOVING:
            raise tree.error(
                "it mimics a joint that does not move", where, mimic.of, "drop the <mimic> or free that joint"
            )
        earlier = found.setdefault(mimic.joint, mimic)
        if earlier != mimic:
            raise tree.error("it mimics in two ways", where, f"{earlier} and {mimic}", "keep one <mimic>")
    _refuse_circle(tree, found)
    return list(found.values())


def _stated(tree: Tree) -> Iterator[Mimic]:
    for name, joint in tree.joints.items():
        for tag in joint.findall("mimic"):
            yield Mimic(
                name, tag.get("joint", ""), float(tag.get("multiplier", 1.0)), float(tag.get("offset", 0.0))
            )
    for joint in tree.robot.iterfind("ros2_control/joint"):
        said = {p.get("name"): (p.text or "").strip() for p in joint.findall("param")}
        name = joint.get("name", "")
        if "mimic" in said and name in tree.joints:
            try:
                numbers = float(said.get("multiplier") or 1.0), float(said.get("offset") or 0.0)
            except ValueError:
                raise tree.error(
                    "<ros2_control> mimic: not a number", f"joint {name}", cure="mend it"
                ) from None
            yield Mimic(name, said["mimic"], *numbers)


def _refuse_circle(tree: Tree, mimics: dict[str, Mimic]) -> None:
    for start in mimics:
        path = [start]
        while path[-1] in mimics:
            following = mimics[path[-1]].of
            if following in path:
                circle = " -> ".join([*path[path.index(following) :], following])
                raise tree.error(
                    f"a coupling cycle: {circle}",
                    f"joint {following}",
                    cure="drop the <mimic> of one of them",
                )
            path.append(following)
