"""Where tokens stand in a traced URDF: in numbers that are read, in what nobody reads, or in the way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rover_pin.compiled.design_rows import Row, Sheet, read_row, refs
from rover_pin.description.checks import COUNTS, ROUNDING, label
from rover_pin.description.trace import TOKEN, Trace, UntraceableError
from rover_pin.description.tree import Element, Tree

_DRAWN = frozenset({"visual", "material", "sensor", "dynamics", "safety_controller", "calibration"})
"""Elements of links and joints that do not move a rover at rest."""

_WORDS = frozenset({"mimic", "multiplier", "offset"})
"""Parameters under `<ros2_control>` that are read."""


@dataclass(frozen=True)
class Scanned:
    """Rows that the loader looks at beside those of the plan.

    Attributes:
        finite: numbers that have to be finite.
        positive: numbers that must not be negative, and how much below zero counts as none.
    """

    finite: tuple[Row, ...]
    positive: tuple[tuple[Row, float], ...]

    def check(self, sheet: Sheet) -> None:
        """Leave to the loader designs that it would refuse for one of these."""
        for row, slack in self.positive:
            sheet.require(np.all(sheet.row(row) >= -slack, axis=1))


def scan(tree: Tree, trace: Trace) -> Scanned:
    """All numbers with tokens.

    Raises:
        UntraceableError: a token in a name, or in another text that the loader reads.
    """
    _outside(tree)
    finite: list[Row] = []
    positive: list[tuple[Row, float]] = []
    for top in (*tree.links.values(), *tree.joints.values()):
        for element, key, text in _marked(top):
            count = COUNTS.get((element.tag, key))
            if count is None:
                if not _drawn(element, top):
                    _refuse(top, f"<{element.tag}> {key or 'text'}")
                continue
            row = read_row(text, trace, label(top))
            if len(row) != count:
                raise UntraceableError(
                    f"<{element.tag} {key}> needs {count} number{'s' * (count > 1)}", element=label(top)
                )
            finite.append(row)
            if (element.tag, key) == ("mass", "value") or key in ("effort", "velocity"):
                positive.append((row, 0.0))
            elif key in ("ixx", "iyy", "izz"):
                positive.append((row, ROUNDING))
    return Scanned(tuple(finite), tuple(positive))


def finite_nodes(scanned: Scanned) -> set[int]:
    """Nodes that have to be finite."""
    return refs(scanned.finite)


def _outside(tree: Tree) -> None:
    """What stands beside links and joints: only names and `<ros2_control>` mimics are read."""
    if TOKEN.search(tree.name):
        _refuse(tree.robot, "name")
    for top in tree.robot:
        if top.tag in ("link", "joint"):
            continue
        for element, key, _ in _marked(top):
            spoken = top.tag == "transmission" and element.tag == "joint"
            if top.tag == "ros2_control" and element.tag == "param":
                spoken = bool(key) or element.get("name") == "mimic"
            elif top.tag in ("ros2_control", "transmission"):
                spoken = spoken or bool(key)
            if spoken:
                _refuse(top, f"<{element.tag}> {key or 'text'}")


def _marked(top: Element) -> Iterator[tuple[Element, str, str]]:
    """Elements, attributes (empty of the text) and texts that hold a token."""
    for element in top.iter():
        if TOKEN.search(str(element.tag)):
            _refuse(top, f"<{element.tag}>")
        for key, text in element.attrib.items():
            if TOKEN.search(key):
                _refuse(top, f"<{element.tag}> attribute")
            if TOKEN.search(text):
                yield element, key, text
        for text in (element.text, element.tail):
            if text and TOKEN.search(text):
                yield element, "", text


def _drawn(element: Element | None, top: Element) -> bool:
    while element is not None and element is not top:
        if element.tag in _DRAWN:
            return True
        element = element.getparent()
    return False


def _refuse(top: Element, where: str) -> None:
    name = TOKEN.sub("...", str(top.get("name") or ""))
    raise UntraceableError("a parameter stands where no number is read", element=f"{top.tag} {name}: {where}")
