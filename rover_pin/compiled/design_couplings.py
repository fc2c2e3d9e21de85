"""Couplings of many designs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.compiled.design_rows import Row, Sheet, Stated, read_row, refs
from rover_pin.compiled.design_tree import Walked
from rover_pin.description.prepare import Prepared
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.trace import Ref, Trace, UntraceableError
from rover_pin.description.tree import Tree
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover

_SLACK = 1e-6  # residual of a coupling whose joints are all held, as the loader grants


@dataclass(frozen=True)
class Coupled:
    """One coupling as stated: coefficients by joint and the right-hand side, one number each."""

    name: str
    joints: Mapping[str, Row]
    offset: Row
    ratio: Row | None

    @property
    def varies(self) -> bool:
        """Whether it depends on a parameter."""
        return bool(refs([*self.joints.values(), self.offset]))


def read_couplings(
    made: Prepared, traced: Tree, sidecar: Sidecar, trace: Trace, formulas: Stated
) -> tuple[Coupled, ...]:
    """Every coupling before the loader drops any.

    Raises:
        UntraceableError: a varied one that shares its joints with other couplings, round a circle or not.
    """
    stated: dict[str, tuple[Row, Row]] = {}
    for joint, numbers in _stated(traced, trace):
        earlier = stated.setdefault(joint, numbers)
        if earlier != numbers and refs([*earlier, *numbers]):
            raise UntraceableError(
                "a mimic that depends on a parameter is stated twice", element=f"joint {joint}"
            )
    found: list[Coupled] = []
    for mimic in made.mimics:
        ratio, offset = stated[mimic.joint]
        of = {} if mimic.multiplier == 0.0 else {mimic.of: _minus(ratio, trace)}
        found.append(Coupled(f"mimic_{mimic.joint}", {mimic.joint: (1.0,), **of}, offset, ratio))
    for i, spec in enumerate(sidecar.couplings):
        joints: dict[str, Row] = {
            name: (formulas.get(("couplings", i, "joints", name), float(c)),)
            for name, c in spec.joints.items()
        }
        right = formulas.get(("couplings", i, "offset"), float(spec.offset))
        found.append(Coupled(spec.name, joints, (right,), None))
    for coupled in found:
        others = [other for other in found if other is not coupled]
        if coupled.varies and _meet(set(coupled.joints) - set(made.held), others, set(made.held)):
            raise UntraceableError(
                "depends on a parameter, and other couplings of its joints may contradict it",
                element=f"couplings.{coupled.name}",
            )
    return tuple(found)


def _minus(row: Row, trace: Trace) -> Row:
    return tuple(Ref((-trace.of(entry.index)).index) if isinstance(entry, Ref) else -entry for entry in row)


def _stated(tree: Tree, trace: Trace) -> Iterator[tuple[str, tuple[Row, Row]]]:
    """Multiplier and offset of every mimic, in the order in which the loader reads them."""
    for name, joint in tree.joints.items():
        for tag in joint.findall("mimic"):
            yield name, _numbers(tag.get("multiplier", "1"), tag.get("offset", "0"), name, trace)
    for joint in tree.robot.iterfind("ros2_control/joint"):
        said = {p.get("name"): (p.text or "").strip() for p in joint.findall("param")}
        name = joint.get("name", "")
        if "mimic" in said and name in tree.joints:
            yield name, _numbers(said.get("multiplier") or "1", said.get("offset") or "0", name, trace)


def _numbers(multiplier: str, offset: str, name: str, trace: Trace) -> tuple[Row, Row]:
    return read_row(multiplier, trace, f"joint {name}"), read_row(offset, trace, f"joint {name}")


def _meet(joints: set[str], others: list[Coupled], held: set[str]) -> bool:
    """Whether other couplings of one or two joints tie the same joint, or the same pair, once more."""
    group = {name: name for other in others for name in other.joints} | {name: name for name in joints}

    def root(name: str) -> str:
        while group[name] != name:
            name = group[name]
        return name

    for other in others:
        free = sorted(set(other.joints) - held)
        if free == sorted(joints):
            return True
        if len(free) == 2:
            group[root(free[0])] = root(free[1])
    return len(joints) == 2 and len({root(name) for name in joints}) == 1


def coupling_rows(
    couplings: tuple[Coupled, ...], rover: Rover, walked: Walked, sheet: Sheet
) -> tuple[Array, Array]:
    """(n, c, nv) rows and (n, c) right-hand sides, held joints on the right."""
    kept = {coupling.name: i for i, coupling in enumerate(rover.couplings)}
    rows = np.zeros((sheet.values.count, len(kept), rover.model.nv))
    offsets = np.zeros((sheet.values.count, len(kept)))
    for coupled in couplings:
        offset = sheet.row(coupled.offset)[:, 0]
        free = False
        for joint, row in coupled.joints.items():
            factor = sheet.row(row)[:, 0]
            if joint in walked.held:
                offset = offset - factor * walked.held[joint]
                continue
            free = True
            if coupled.name in kept:
                rows[:, kept[coupled.name], rover.column[joint]] = factor
        if coupled.ratio is not None:
            sheet.require((sheet.row(coupled.ratio)[:, 0] == 0.0) == (len(coupled.joints) == 1))
        if coupled.name in kept:
            offsets[:, kept[coupled.name]] = offset
        elif not free:
            sheet.require(np.abs(offset) <= _SLACK)
    return rows, offsets
