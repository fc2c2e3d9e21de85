"""The variables of a study's result, and how each comes from a block of cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis import weights
from rover_pin.analysis.carrying import load_spread, touching
from rover_pin.analysis.cases import POSTURE, Cases
from rover_pin.analysis.found import Found
from rover_pin.analysis.measures import title
from rover_pin.analysis.rows import BOUNDS, EDGES, PLAIN, POSE, RESIDUALS, TENSION, Columns, Layout, words
from rover_pin.analysis.vocabulary import Words, longest
from rover_pin.numerics import Array
from rover_pin.stability.registry import MEASURES

CASE, WHEEL, EDGE, JOINT, TRACK = "case", "wheel", "edge", "joint", "track"

ABOUT: dict[str, tuple[str, str]] = {
    "z_m": ("m", "height of the root link's origin"),
    "roll_rad": ("rad", "roll of the root link, R = Rz(yaw) Ry(pitch) Rx(roll)"),
    "pitch_rad": ("rad", "pitch of the root link"),
    "redundant": ("1", "supports more than equilibrium determines"),
    "equilibrium": (
        "1",
        "largest residual of forces over weight, moments over weight times largest wheel distance",
    ),
    "gap_m": ("m", "largest distance of a contact from the surface"),
    "loop_m": ("m", "largest opening of a loop or coupling"),
    "complementarity": ("1", "largest product of a gap and a load, scaled"),
    "load_n": ("N", "load against gravity; zero where the wheel does not touch"),
    "load_low_n": ("N", "least load that equilibrium and friction allow"),
    "load_high_n": ("N", "greatest load that equilibrium and friction allow"),
    "joint_rad": ("rad", "joint position; m where the joint slides"),
    "tension_n": ("N", "tension of the track; zero where it is slack"),
    "touching": ("1", "wheels that carry more than 1e-3 N, auxiliary ones left out"),
    "load_spread": ("1", "standard deviation of the wheels' loads over their mean, auxiliary ones left out"),
    "x_m": ("m", "x of the root link's origin"),
    "y_m": ("m", "y of the root link's origin"),
    "yaw_rad": ("rad", "heading of the root link"),
    "friction_given": ("1", "coefficient of Coulomb friction under every wheel"),
}
ACROSS = {"load_n": WHEEL, "load_low_n": WHEEL, "load_high_n": WHEEL, "joint_rad": JOINT, TENSION: TRACK}
CARRYING = {"touching": (touching, "high"), "load_spread": (load_spread, "low")}
"""What follows from the loads alone, and which way is better."""
INTERVALS = ("load_low_n", "load_high_n")


@dataclass(frozen=True)
class Block:
    """Cases in a row, and their answers."""

    cases: Cases
    columns: Columns


@dataclass(frozen=True)
class Variable:
    """One variable of the result.

    Attributes:
        dims: the case first.
        take: from a block, its numbers or its words.
        width: bytes the longest word takes; 0 for numbers.
        asked: whether it was asked for, and not answered.
        sparse: whether most of it is NaN.
    """

    name: str
    dims: tuple[str, ...]
    attrs: dict[str, Any]
    take: Callable[[Block], NDArray[Any] | Words]
    kind: str = "f8"
    width: int = 0
    asked: bool = False
    sparse: bool = False


@dataclass(frozen=True)
class Schema:
    """All variables, and the names along each dimension but the case."""

    variables: tuple[Variable, ...]
    labels: dict[str, list[str]] = field(default_factory=dict)


def schema(layout: Layout, cases: Cases, found: Found) -> Schema:
    """The result's form: `cases` says what was asked (its length does not matter), `found` what came."""
    on_edges = [name for name in layout.margins if not _on_wheels(found.edges[name], layout)]
    edges = sorted({edge for name in on_edges for edge in found.edges[name]})
    answers = [*_plain_answers(layout, found)]
    for name in layout.margins:
        answers += _measure(name, layout, found, edges)
    taken = {variable.name for variable in answers} | {CASE, WHEEL, EDGE, JOINT}
    labels = {WHEEL: list(layout.wheels), JOINT: list(layout.joints), EDGE: edges}
    if layout.tracks:
        labels[TRACK] = list(layout.tracks)
        taken.add(TRACK)
    return Schema((*answers, *_asked(cases, taken, layout.units)), labels)


def _on_wheels(names: set[str], layout: Layout) -> bool:
    """Whether what a measure calls edges are wheels."""
    return names <= set(layout.wheels)


def _plain_answers(layout: Layout, found: Found) -> Iterator[Variable]:
    """How the case ended and how the rover stands."""
    for name, text in (("status", "how the case ended"), ("reason", "why it did not settle")):
        yield _words(name, text, found)
    text = "which path answered: 0 the compiled one, 1 the plain one"
    yield Variable(PLAIN, (CASE,), {"long_name": text}, _column(PLAIN), kind="i1")
    numbers = (*POSE, "redundant", *RESIDUALS, "load_n", "joint_rad")
    tensions = (TENSION,) if layout.tracks else ()
    for name in (*numbers, *tensions, *(INTERVALS if BOUNDS in layout.measures else ())):
        unit, text = ABOUT[name]
        dims = (CASE, ACROSS[name]) if name in ACROSS else (CASE,)
        idle = {"auxiliary": ", ".join(layout.auxiliary)} if name == "load_n" and layout.auxiliary else {}
        yield Variable(name, dims, {"units": unit, "long_name": text, **idle}, _column(name))
    for name, (formula, better) in CARRYING.items():
        unit, text = ABOUT[name]
        attrs = {"units": unit, "long_name": text, "better": better}
        yield Variable(name, (CASE,), attrs, _carrying(formula, layout.bearing))


def _words(name: str, text: str, found: Found) -> Variable:
    attrs = {"long_name": text}
    return Variable(name, (CASE,), attrs, lambda block: words(block.columns, name), "S", found.width[name])


def _carrying(formula: Callable[[Array], Array], bearing: list[int]) -> Callable[[Block], Array]:
    return lambda block: formula(block.columns["load_n"][:, bearing])


def _column(name: str) -> Callable[[Block], NDArray[Any]]:
    return lambda block: block.columns[name]


def _measure(name: str, layout: Layout, found: Found, edges: list[str]) -> Iterator[Variable]:
    """A measure's value, what limits it, and its values along the edges or wheels."""
    kind = MEASURES[name]
    about = {"units": kind.unit, "better": kind.better}
    yield Variable(name, (CASE,), {**about, "long_name": title(name)}, _column(name))
    yield _words(f"{name}_limiting", f"what limits {name}", found)
    if not found.edges[name]:
        return
    on_wheels = _on_wheels(found.edges[name], layout)
    labels, dim = (list(layout.wheels), WHEEL) if on_wheels else (edges, EDGE)
    place = {label: k for k, label in enumerate(labels)}

    def take(block: Block) -> NDArray[Any]:
        own = block.columns[f"{name}_edge"]
        wide = np.full((len(own), len(labels)), np.nan)
        wide[:, [place[str(each)] for each in block.columns[EDGES + name]]] = own
        return wide

    attrs = {**about, "long_name": f"{title(name)}, each {dim}"}
    yield Variable(f"{name}_{dim}", (CASE, dim), attrs, take, sparse=not on_wheels)


def _asked(cases: Cases, taken: set[str], units: Mapping[str, str]) -> Iterator[Variable]:
    """What was asked: one variable per quantity."""

    def number(name: str, take: Callable[[Cases], NDArray[Any]], **more: str) -> Variable:
        unit, text = ABOUT.get(name, ("", f"{name} asked for"))
        attrs = {**({"units": unit} if unit else {}), "long_name": text, **more}
        return Variable(name, (CASE,), attrs, lambda block: take(block.cases), asked=True)

    yield number("x_m", lambda drawn: drawn.x)
    yield number("y_m", lambda drawn: drawn.y)
    yield number("yaw_rad", lambda drawn: drawn.yaw)
    taken = taken | {"x_m", "y_m", "yaw_rad"}
    if cases.friction is not None:
        yield number("friction_given", lambda drawn: np.asarray(drawn.friction))
        taken = taken | {"friction_given"}
    if cases.postures:
        known = list(cases.postures)
        attrs = {"long_name": f"{POSTURE} asked for"}
        width = longest(np.asarray(known))
        taken = taken | {POSTURE}
        yield Variable(
            POSTURE, (CASE,), attrs, lambda block: Words.picked(block.cases.posture, known), "S", width, True
        )
    for name in cases.weights:
        spoken, measured_in, meaning = weights.about(name)
        own = spoken if spoken not in taken else f"vary_{spoken}"
        yield number(own, lambda drawn, name=name: drawn.weights[name], units=measured_in, long_name=meaning)  # type: ignore[misc]
        taken = taken | {own}
    for name in cases.parameters:
        own = name if name not in taken else f"parameter_{name}"
        unit = {"units": units[name]} if units.get(name) else {}
        yield number(own, lambda drawn, name=name: drawn.parameters[name], parameter=name, **unit)  # type: ignore[misc]
    for name in cases.joints:
        yield number(f"joint_{name}", lambda drawn, name=name: drawn.joints[name])  # type: ignore[misc]
