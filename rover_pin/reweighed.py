"""A rover with other masses than its files say, as Pinocchio's model has them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.description.masses import ROBOT, Masses
from rover_pin.description.tree import numbers, parse
from rover_pin.errors import InputError, nearest
from rover_pin.weighing import NONE, Body, Changes, weigh_anew

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def bodies_of(model: pin.Model, urdf: str, file: str) -> dict[str, Body]:
    """Every link as it is fixed to its joint, as the URDF says, payload left out."""
    found = {}
    for name, link in parse(urdf, file).links.items():
        frame = model.frames[model.getFrameId(name, pin.FrameType.BODY)]
        mass, origin = link.find("inertial/mass"), link.find("inertial/origin")
        place = frame.placement
        own = numbers((origin.get("xyz") if origin is not None else None) or "0 0 0")
        found[name] = Body(
            int(frame.parentJoint),
            np.array([0.0 if mass is None else float(mass.get("value"))]),
            np.array([place.act(np.array(own))]),
            np.array([place.rotation]),
            np.array([place.translation]),
        )
    return found


def check_masses(masses: Masses, bodies: Mapping[str, Body]) -> None:
    """Refuse links there are not, and numbers that no mass has.

    Raises:
        InputError: so it is.
    """
    for kind, told in (("mass", masses.kg), ("mass", masses.scale), ("com", masses.com)):
        for name, value in told.items():
            element = f"{kind} of {name}"
            check_link(name, bodies, element, moved=kind == "com" or told is masses.scale)
            given = np.array(value, dtype=float)
            wanted = (3,) if kind == "com" else ()
            if given.shape != wanted or not np.isfinite(given).all():
                cure = "give x, y, z in m" if kind == "com" else "give a number"
                raise InputError("is no such thing", element=element, value=value, cure=cure)
            if kind == "mass" and given < 0:
                raise InputError("must not be below zero", element=element, value=value)
    both = sorted(set(masses.kg) & set(masses.scale))
    if both:
        raise InputError("has both kg and a scale", element=f"mass of {both[0]}", cure="give one of them")


def check_link(name: str, bodies: Mapping[str, Body], element: str, *, moved: bool) -> None:
    """Refuse a link that is not there, or one without mass that is to be `moved` or scaled.

    Raises:
        InputError: so it is.
    """
    if name == ROBOT:
        if name in bodies:
            what = "is both a link here and the word for the whole robot"
            raise InputError(what, element=element, value=name, cure="rename the link")
        return
    if name not in bodies:
        raise InputError("no such link", element=element, value=name, cure=nearest(name, [*bodies, ROBOT]))
    if moved and float(bodies[name].mass[0]) < NONE:
        raise InputError("has no mass of its own", element=element, value=name, cure="give it kg")


def reweigh(rover: Rover, masses: Masses) -> pin.Model:
    """The rover's model with other masses; inertias about the centres of mass grow with the masses.

    Raises:
        InputError: a link that is not there, a number that no mass has, or masses that no rover can have.
    """
    bodies = rover.bodies
    check_masses(masses, bodies)
    model = rover.model.copy()
    inertias = list(model.inertias)
    changes = Changes(
        {name: np.array([float(value)]) for name, value in masses.kg.items()},
        {name: np.array([float(value)]) for name, value in masses.scale.items()},
        {name: np.array([value], dtype=float) for name, value in masses.com.items()},
    )
    kg, moments, valid = weigh_anew(
        np.array([[each.mass for each in inertias]]),
        np.array([[each.mass * each.lever for each in inertias]]),
        bodies,
        rover.root,
        rover.recipe.payload,
        changes,
    )
    if not valid[0]:
        raise InputError("the masses leave nothing to weigh or to move", element="mass", cure="give more kg")
    for j, before in enumerate(inertias):
        after = float(kg[0, j])
        if after > NONE:
            about = before.inertia * (after / before.mass if before.mass > NONE else 1.0)
            model.inertias[j] = pin.Inertia(after, moments[0, j] / after, about)
        else:
            model.inertias[j] = pin.Inertia.Zero()
    return model
