"""`rover-pin info`: what a robot is made of, and what the loader dropped or guessed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rover_pin.cli.options import (
    Gravity,
    Json,
    Packages,
    Parameters,
    Payload,
    Robot,
    Sidecar,
    SkipIncludes,
    load_rover,
    loaded,
)


def info(
    robot: Robot,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    param: Parameters = None,
    gravity: Gravity = "earth",
    payload: Payload = None,
    json: Json = False,
) -> None:
    """Mass and weight, joints, loops, rank and mobility, wheels, what the loader dropped."""
    from rover_pin.analysis.words import gravity as parse_gravity
    from rover_pin.cli.output import print_json

    pull = parse_gravity(gravity)
    rover = loaded(load_rover(robot, sidecar, package, skip_missing_includes, param), payload)
    facts = {**rover.info(), "gravity": pull, "weight_n": rover.mass * pull}
    if json:
        print_json(facts)
    else:
        _print(facts)


def _print(facts: Mapping[str, Any]) -> None:
    """The facts for people."""
    from rover_pin.cli.output import figure, line, new_table, print_table

    line(
        f"{facts['robot']}: {facts['mass_kg']:.6g} kg "
        f"({facts['weight_n']:.6g} N at {facts['gravity']:g} m/s2), "
        f"mobility {facts['mobility']}, rank {facts['rank']}"
    )
    if facts["payload"]:
        line(f"payload: {facts['payload']}")
    joints = new_table("", "joint", "", "lower", "upper", left=2)
    for name, joint in facts["joints"].items():
        limits = (figure(joint["lower"]), figure(joint["upper"]))
        joints.add_row(name, "driven" if joint["actuated"] else "passive", *limits)
    print_table(joints)
    shapes = new_table("", "wheel", "link", "drive", "radius m", "width m", "tread m", "friction", left=3)
    for name, shape in {**facts["wheels"], **facts["contacts"]}.items():
        sizes = (figure(shape.get(key)) for key in ("radius_m", "width_m", "tread_m", "friction"))
        shapes.add_row(name, shape["link"], shape.get("drive") or "-", *sizes)
    print_table(shapes)
    for key in ("couplings", "loops", "springs"):
        line(f"{key}: {', '.join(facts[key]) or 'none'}")
    if facts["parameters"]:
        line("parameters: " + ", ".join(f"{name} {value:g}" for name, value in facts["parameters"].items()))
    for note in facts["notes"]:
        line(f"note: {note}")
