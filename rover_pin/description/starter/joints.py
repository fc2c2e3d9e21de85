"""Which joints may be passive, and how they may be coupled."""

from __future__ import annotations

import re
from collections.abc import Collection

from rover_pin.description.couplings import as_coupling
from rover_pin.description.starter.subject import Guess, Subject, flow, flow_value

PASSIVE = re.compile(
    r"rocker|bogie|differential|suspension|susp(?![a-z])|caster|castor|pivot|passive|spring", re.I
)
ROCKER = re.compile(r"rocker", re.I)


def stated_actuation(subject: Subject) -> str | None:
    """`<ros2_control>` or `<transmission>`, where one says what is driven."""
    robot = subject.stated.robot
    if any(j.find("command_interface") is not None for j in robot.iterfind("ros2_control/joint")):
        return "<ros2_control>"
    return "<transmission>" if robot.find("transmission/joint") is not None else None


def guess_passive(subject: Subject, drives: Collection[str]) -> Guess | None:
    """The joints that nothing seems to drive; None where the URDF says itself what is driven."""
    if stated_actuation(subject) is not None:
        return None
    named, weak = [], []
    for name in subject.rover.joints:
        if name in drives:
            continue
        limit = subject.stated.joints[name].find("limit") if name in subject.stated.joints else None
        if PASSIVE.search(name):
            named.append(name)
        elif limit is not None and limit.get("effort") is not None and float(limit.get("effort")) == 0.0:
            weak.append(name)
    reasons = [*(["names"] if named else []), *(["an effort limit of 0"] if weak else [])]
    chosen = [name for name in subject.rover.joints if name in (*named, *weak)]
    reason = " and ".join(reasons) or "no name and no effort limit of 0 says that a joint hangs free"
    return Guess("passive", flow_value(chosen), f"{reason}; all else is then driven")


def stated_couplings(subject: Subject) -> list[Guess]:
    """Those of `<mimic>`, which are read already."""
    return [
        Guess(
            "couplings",
            _coupling(c.name, dict(c.joints), c.offset),
            f"<mimic> of {mimic.joint}, read already",
        )
        for mimic in subject.made.mimics
        for c in (as_coupling(mimic),)
    ]


def guess_differential(subject: Subject) -> Guess | None:
    """Two rockers on one link, not coupled yet, about one axis: as one goes up the other goes down."""
    coupled = {name for mimic in subject.made.mimics for name in (mimic.joint, mimic.of)}
    tree, axes = subject.made.tree, subject.made.turning_axes()
    rockers = [n for n in subject.rover.joints if ROCKER.search(n) and n in axes and n not in coupled]
    if len(rockers) != 2:
        return None
    first, second = rockers
    same_link = len({tree.joints[n].find("parent").get("link") for n in rockers}) == 1
    turn = float(subject.axis(first) @ subject.axis(second))
    if not same_link or abs(turn) < 0.99:
        return None
    line = _coupling("differential", {first: 1.0, second: 1.0 if turn > 0 else -1.0}, 0.0)
    return Guess("couplings", line, "two rockers on one link: a differential may connect them")


def _coupling(name: str, joints: dict[str, float], offset: float) -> str:
    said: dict[str, object] = {"name": name, "joints": joints}
    return flow(said if offset == 0.0 else {**said, "offset": offset})
