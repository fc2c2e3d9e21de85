"""A URDF as an lxml tree with its links and joints by name."""

from __future__ import annotations

from typing import Any

from rover_pin.errors import DescriptionError

Element = Any  # lxml publishes no types

TURNING = frozenset({"revolute", "continuous"})
MOVING = TURNING | {"prismatic"}
HUGE = 1e12  # no length, mass, moment or angle of a robot, whatever its unit
JOINT_TYPES = MOVING | {"fixed", "floating", "planar"}


class Tree:
    """Links and joints of a URDF.

    Attributes:
        robot: the outermost element.
        file: named in errors.
    """

    def __init__(self, robot: Element, file: str) -> None:
        self.robot = robot
        self.file = file
        self.refresh()

    def refresh(self) -> None:
        """Read the names anew after an edit."""
        self.links: dict[str, Element] = {e.get("name", ""): e for e in self.robot.findall("link")}
        self.joints: dict[str, Element] = {e.get("name", ""): e for e in self.robot.findall("joint")}
        self._above = {child_of(j): name for name, j in self.joints.items()}

    @property
    def name(self) -> str:
        """The robot's name."""
        return str(self.robot.get("name") or "")

    @property
    def root(self) -> str:
        """The link that is nobody's child."""
        return next(name for name in self.links if name not in self._above)

    def joint_above(self, link: str) -> str | None:
        """The joint whose child `link` is."""
        return self._above.get(link)

    def moving(self) -> list[str]:
        """Names of the joints that turn or slide, in the file's order."""
        return [n for n, j in self.joints.items() if j.get("type") in MOVING]

    def error(
        self, what: str, element: str, value: object = None, cure: str | None = None
    ) -> DescriptionError:
        """An error that names this file."""
        return DescriptionError(what, file=self.file, element=element, value=value, cure=cure)


def parent_of(joint: Element) -> str:
    """The parent link's name."""
    found = joint.find("parent")
    return "" if found is None else str(found.get("link") or "")


def child_of(joint: Element) -> str:
    """The child link's name."""
    found = joint.find("child")
    return "" if found is None else str(found.get("link") or "")


def parse(text: str, file: str) -> Tree:
    """The tree of a URDF text; entities and the network are left alone.

    Raises:
        DescriptionError: not XML, not a `<robot>`, or without a link.
    """
    from lxml import etree

    robot = parse_xml(text, file, "give a URDF or xacro file, or mend it there")
    if robot.tag != "robot":
        raise DescriptionError(
            f"not a URDF: its outermost element is <{etree.QName(robot).localname}>",
            file=file,
            cure="give a file whose outermost element is <robot>",
        )
    if robot.find("link") is None:
        raise DescriptionError("a robot without a link", file=file, cure="give it at least one <link>")
    return Tree(robot, file)


def parse_xml(text: str, file: object, cure: str) -> Element:
    """The outermost element of an XML text, comments left out. Nothing else is opened; bombs are refused.

    Raises:
        DescriptionError: not XML, or text behind entities.
    """
    from lxml import etree

    parser = etree.XMLParser(remove_comments=True, remove_pis=True, resolve_entities=False, no_network=True)
    try:
        found = etree.fromstring(text.encode("utf-8"), parser)
        entity = next(found.iter(etree.Entity), None)
        if entity is not None:
            raise DescriptionError("entities are not read", file=file, value=entity.text, cure="write it out")
        # It lets names pass (`a:`) that no parser takes again, and what is built on the tree reads it anew.
        etree.fromstring(etree.tostring(found), parser)
    except etree.XMLSyntaxError as problem:
        raise DescriptionError(f"not XML: {str(problem.msg)[:300]}", file=file, cure=cure) from problem
    return found


def numbers(text: str) -> list[float]:
    """The numbers of an attribute, blank-separated."""
    return [float(part) for part in text.split()]


def written(values: Any) -> str:
    """Numbers as an attribute, without loss."""
    return " ".join(repr(float(v)) for v in values)
