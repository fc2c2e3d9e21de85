"""Masses that vary: what the study file says of them as columns, and columns as changes of a rover.

Columns are `mass/LINK` (kg), `com/LINK/x` (m, along the link's axes) and `payload/kg`, `payload/x` (m, in
the root link's frame); LINK may be `robot`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.quantities import Choice, Quantity
from rover_pin.description.masses import ROBOT, Masses
from rover_pin.description.recipe import Payload
from rover_pin.errors import InputError, StudyError
from rover_pin.numerics import Array
from rover_pin.reweighed import check_link
from rover_pin.weighing import Changes

if TYPE_CHECKING:
    from rover_pin.analysis.spec import VarySpec
    from rover_pin.rover import Rover

AXES = ("x", "y", "z")


def weights_of(vary: VarySpec) -> dict[str, Quantity]:
    """The columns that the study file asks for; axes that it does not name stay."""
    zero = Choice((0.0,))
    out: dict[str, Quantity] = {f"mass/{link}": asked for link, asked in vary.mass.items()}
    for link, shift in vary.com.items():
        out |= {f"com/{link}/{axis}": getattr(shift, axis) or zero for axis in AXES}
    if vary.payload is not None:
        out["payload/kg"] = vary.payload.kg
        out |= {f"payload/{axis}": getattr(vary.payload, axis) or zero for axis in AXES}
    return out


def check_weights(weights: Mapping[str, Quantity], rover: Rover) -> None:
    """Refuse links that the rover does not have.

    Raises:
        StudyError: so it is.
    """
    for name in weights:
        kind, link, _ = _split(name)
        if kind == "payload":
            continue
        element = f"vary.{kind}.{link}"
        try:
            check_link(link, rover.bodies, element, moved=kind == "com")
        except InputError as error:
            raise StudyError(error.what, element=element, value=error.value, cure=error.cure) from None


def masses_of(weights: Mapping[str, float]) -> tuple[Masses, tuple[Payload, ...]]:
    """One case's masses, and what it carries."""
    kg = {_split(name)[1]: value for name, value in weights.items() if name.startswith("mass/")}
    com = {
        link: (weights[f"com/{link}/x"], weights[f"com/{link}/y"], weights[f"com/{link}/z"])
        for link in _moved(weights)
    }
    if "payload/kg" not in weights:
        return Masses(kg=kg, com=com), ()
    x, y, z = (weights[f"payload/{axis}"] for axis in AXES)
    return Masses(kg=kg, com=com), ((weights["payload/kg"], (x, y, z)),)


def changes_of(weights: Mapping[str, Array]) -> Changes:
    """The masses of many cases."""
    payload: tuple[tuple[Array, Array], ...] = ()
    if "payload/kg" in weights:
        payload = ((weights["payload/kg"], np.stack([weights[f"payload/{axis}"] for axis in AXES], axis=1)),)
    return Changes(
        kg={_split(name)[1]: values for name, values in weights.items() if name.startswith("mass/")},
        com={
            link: np.stack([weights[f"com/{link}/{axis}"] for axis in AXES], axis=1)
            for link in _moved(weights)
        },
        payload=payload,
    )


def about(name: str) -> tuple[str, str, str]:
    """The name in a result, the unit and the meaning of a column."""
    kind, link, axis = _split(name)
    what = "the robot" if link == ROBOT else link
    own = link.replace("/", "_")
    if kind == "mass":
        return f"mass_{own}", "kg", f"mass of {what}"
    if kind == "com":
        return f"com_{own}_{axis}", "m", f"shift of the centre of mass of {what} along {axis}"
    if axis == "kg":
        return "payload_kg", "kg", "mass carried"
    return f"payload_{axis}", "m", f"{axis} of the mass carried, in the root link's frame"


def _split(name: str) -> tuple[str, str, str]:
    """Kind, link and axis of a column's name; a link's name may hold strokes itself."""
    kind, _, rest = name.partition("/")
    if kind == "mass":
        return kind, rest, ""
    link, _, axis = rest.rpartition("/")
    return kind, link, axis


def _moved(weights: Mapping[str, Any]) -> list[str]:
    """Links whose centre of mass is moved."""
    return [_split(name)[1] for name in weights if name.startswith("com/") and name.endswith("/x")]
