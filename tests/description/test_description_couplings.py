"""Mimic tags and couplings: once each, no circles, no contradictions."""

import numpy as np


def chain(make, *mimics, limits=("-1 1", "-1 1", "-1 1")):
    """a, b, c on one base; `mimics` are the extra tags of each."""
    extra = [*mimics, "", "", ""]
    parts = [make.link("base")]
    for i, name in enumerate("abc"):
        parts += [
            make.link(f"l{name}"),
            make.joint(name, "base", f"l{name}", extra=extra[i], limits=limits[i]),
        ]
    return parts


def test_mimic_is_a_coupling(make):
    rover = make.load(*chain(make, '<mimic joint="b" multiplier="2" offset="0.5"/>'))
    (coupling,) = rover.couplings
    assert coupling.name == "mimic_a"
    assert dict(coupling.joints) == {"a": 1.0, "b": -2.0}
    assert coupling.offset == 0.5
    row = np.zeros(9)
    row[rover.column["a"]], row[rover.column["b"]] = 1, -2
    np.testing.assert_array_equal(coupling.row, row)


def test_mimic_of_nothing(make):
    assert make.refused(*chain(make, '<mimic joint="bb"/>')) == (
        "bot.urdf: joint a: it mimics a joint that does not exist (got 'bb'); did you mean 'b'?"
    )


def test_mimic_of_a_fixed_joint(make):
    said = make.refused(
        *chain(make, '<mimic joint="f"/>'), make.link("t"), make.joint("f", "base", "t", "fixed")
    )
    assert said == (
        "bot.urdf: joint a: it mimics a joint that does not move (got 'f'); "
        "drop the <mimic> or free that joint"
    )


def test_mimic_on_a_fixed_joint_is_dropped(make):
    rover = make.load(
        *chain(make), make.link("t"), make.joint("f", "base", "t", "fixed", extra='<mimic joint="a"/>')
    )
    assert rover.couplings == ()
    assert "joint f: <mimic> on a fixed joint dropped" in rover.notes


def test_stated_twice_alike_counts_once(make):
    assert len(make.load(*chain(make, '<mimic joint="b"/><mimic joint="b" multiplier="1"/>')).couplings) == 1
    rover = make.load(
        *chain(make, '<mimic joint="b"/>'), sidecar="couplings: [{name: gear, joints: {a: -3, b: 3}}]"
    )
    assert [c.name for c in rover.couplings] == ["mimic_a"]
    assert "coupling gear says the same as mimic_a; counted once" in rover.notes


def test_stated_twice_differently(make):
    assert make.refused(*chain(make, '<mimic joint="b"/><mimic joint="b" multiplier="2"/>')) == (
        "bot.urdf: joint a: it mimics in two ways (got '1 b + 0 and 2 b + 0'); keep one <mimic>"
    )
    said = make.refused(
        *chain(make, '<mimic joint="b"/>'), sidecar="couplings: [{name: gear, joints: {a: 1, b: 1}}]"
    )
    assert said == (
        "rover.yaml: couplings.gear: couples the same joints as mimic_a, but differently "
        "(got '1 a + -1 b = 0 and 1 a + 1 b = 0'); keep one"
    )


def test_mimic_of_ros2_control_counts_once(make):
    rover = make.load(
        *chain(make, '<mimic joint="b" multiplier="2"/>'),
        '<ros2_control name="x" type="system"><joint name="a"><param name="mimic">b</param>'
        '<param name="multiplier">2</param></joint></ros2_control>',
    )
    assert len(rover.couplings) == 1


def test_circle_of_mimics_names_the_cycle(make):
    said = make.refused(*chain(make, '<mimic joint="b"/>', '<mimic joint="c"/>', '<mimic joint="a"/>'))
    assert said == "bot.urdf: joint a: a coupling cycle: a -> b -> c -> a; drop the <mimic> of one of them"


def test_circle_of_couplings_that_contradicts_itself(make):
    said = make.refused(
        *chain(make),
        sidecar="""
        couplings:
          - {name: ab, joints: {a: 1, b: -1}}
          - {name: bc, joints: {b: 1, c: -1}}
          - {name: ca, joints: {c: 1, a: -2}}
        """,
    )
    assert said.startswith("rover.yaml: couplings.")
    assert "a coupling cycle that contradicts itself: " in said
    assert said.endswith("drop one of its couplings, or make their ratios agree")


def test_circle_of_couplings_that_agrees_is_redundant(make):
    rover = make.load(
        *chain(make),
        sidecar="""
        couplings:
          - {name: ab, joints: {a: 1, b: -2}}
          - {name: bc, joints: {b: 1, c: -1}, offset: 0.1}
          - {name: ca, joints: {a: 1, c: -2}, offset: 0.2}
        """,
    )
    assert (rover.mobility.rows, rover.mobility.rank, rover.mobility.redundancy) == (3, 2, 1)
    assert rover.mobility.mobility == 1


def test_a_held_joint_goes_to_the_right_hand_side(make):
    rover = make.load(
        *chain(make, limits=("0.25 0.25", "-1 1", "-1 1")),
        sidecar="couplings: [{name: d, joints: {a: 2, b: 1, c: -1}, offset: 1}]",
    )
    (coupling,) = rover.couplings
    assert dict(coupling.joints) == {"b": 1.0, "c": -1.0}
    assert coupling.offset == 0.5


def test_held_joints_that_contradict(make):
    said = make.refused(
        *chain(make, limits=("0.25 0.25", "0.5 0.5", "-1 1")),
        sidecar="couplings: [{name: d, joints: {a: 1, b: 1}}]",
    )
    assert said == (
        "rover.yaml: couplings.d: the limits that hold its joints contradict it, residual -0.75; "
        "open the limits or drop the coupling"
    )


def test_unknown_joint_in_a_coupling(make):
    said = make.refused(*chain(make), sidecar="couplings: [{name: d, joints: {a: 1, bb: 1}}]")
    assert said == "rover.yaml: couplings.d: no moving joint of this name (got 'bb'); did you mean 'b'?"
