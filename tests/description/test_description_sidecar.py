"""The sidecar: what it refuses, with the line, the key's path and the cure."""

import pytest

import rover_pin as rp
from rover_pin.description.sidecar import Sidecar, read_sidecar


def refused(text):
    with pytest.raises(rp.errors.SidecarError) as caught:
        read_sidecar(text, "rover.yaml")
    return str(caught.value)


def test_all_silent():
    sidecar = read_sidecar("schema: 1\n", "rover.yaml")
    assert sidecar == Sidecar()
    assert sidecar.up == (0, 0, 1)


def test_a_key_left_empty_is_silent():
    assert read_sidecar("schema: 1\nwheels:\npassive:\n", "rover.yaml") == Sidecar()


def test_unknown_key():
    assert refused("schema: 1\nwheel: []\n").startswith(
        "rover.yaml:2: wheel: unknown key; did you mean 'wheels'"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "wheels:\n  - {frame: w, radius: 0.1}\n  - {frame: w, radus: 0.1}\n",
            "rover.yaml:4: wheels[1].radus: unknown key; did you mean 'radius'",
        ),
        (
            "springs: [{name: s, joint: j, stifness: 3}]\n",
            "rover.yaml:2: springs[0].stifness: unknown key; did you mean 'stiffness'",
        ),
        (
            "springs: [{name: s, frames: [a, b], stiffness: 3, lenght_max: 1}]\n",
            "rover.yaml:2: springs[0].lenght_max: unknown key; did you mean 'length_max'",
        ),
        (
            "loops: [{name: l, frames: [a, {link: b, xzy: [0, 0, 0]}]}]\n",
            "rover.yaml:2: loops[0].frames[1].xzy: unknown key; did you mean 'xyz'?",
        ),
        (
            "parameters:\n  track: {defalt: 1}\n",
            "rover.yaml:3: parameters.track.defalt: unknown key; did you mean 'default'?",
        ),
    ],
)
def test_unknown_key_inside(text, said):
    assert refused("schema: 1\n" + text).startswith(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("wheels: [{frame: w}]\n", "rover.yaml:2: wheels[0].radius: missing; state it"),
        (
            "wheels: [{frame: w, radius: -1}]\n",
            "rover.yaml:2: wheels[0].radius: not above 0 (got -1); give a number above 0",
        ),
        (
            "wheels: [{frame: w, radius: .nan}]\n",
            "rover.yaml:2: wheels[0].radius: not a finite number (got nan); give a finite number",
        ),
        (
            "wheels: [{frame: w, radius: 1, axis: [0, 0, 0]}]\n",
            "rover.yaml:2: wheels[0].axis: a zero vector points nowhere",
        ),
        (
            "tracks: [{name: t}]\n",
            "rover.yaml:2: tracks[0].wheels: missing; state it",
        ),
        ("up: [0, 0]\n", "rover.yaml:2: up[2]: missing; state it"),
        (
            "postures: {home: {a: fast}}\n",
            "rover.yaml:2: postures.home.a: not a number (got 'fast'); give a number",
        ),
        (
            "free: {j: {type: ball}}\n",
            "rover.yaml:2: free.j.type: not one of its words (got 'ball'); "
            "use 'revolute', 'prismatic' or 'continuous'",
        ),
        ("wheels: {frame: b}\n", "rover.yaml:2: wheels: not a list; write [a, b, ...]"),
        (
            "parameters: {j: 3}\n",
            "rover.yaml:2: parameters.j: not a mapping (got 3); write {key: value, ...}",
        ),
        ("postures: {up: [1]}\n", "rover.yaml:2: postures.up: not a mapping; write {key: value, ...}"),
        (
            "loops: [{name: l, frames: [a, b, c]}]\n",
            "rover.yaml:2: loops[0].frames: too many entries; at most 2",
        ),
        (
            "loops: [{name: l, frames: [a, 3]}]\n",
            "rover.yaml:2: loops[0].frames[1]: not a name (got 3); give a name",
        ),
        (
            "wheels: [{frame: w, radius: 1, free: maybe}]\n",
            "rover.yaml:2: wheels[0].free: neither true nor false (got 'maybe'); give true or false",
        ),
        (
            "inertials: {a: {mass: 1, inertia: [1, -1, 1, 0, 0, 0]}}\n",
            "rover.yaml:2: inertials.a.inertia[1]: below 0 (got -1); give a number of 0 or more",
        ),
        (
            "parameters: {t: {default: 3, bounds: [1, 2]}}\n",
            "rover.yaml:2: parameters.t: default 3.0 is outside its bounds [1.0, 2.0]",
        ),
    ],
)
def test_values_that_do_not_fit(text, said):
    assert refused("schema: 1\n" + text) == said


def test_schema():
    assert refused("up: [0, 0, 1]\n") == "rover.yaml: schema: missing; start with `schema: 1`"
    assert refused("schema: 2\n") == "rover.yaml: schema: another schema (got 2); this version reads schema 1"
    assert refused("schema: true\n").startswith("rover.yaml: schema: another schema")


def test_not_yaml():
    said = refused("schema: 1\nwheels: [\n")
    assert said.startswith("rover.yaml:3: not YAML: ")
    assert said.endswith("check indentation, colons and brackets")


@pytest.mark.parametrize("text", ["", "- 1\n- 2\n", "hello"])
def test_not_a_mapping(text):
    assert refused(text) == "rover.yaml: not a mapping of keys to values; start with `schema: 1`"


def test_duplicate_key():
    assert refused("schema: 1\npostures: {home: {a: 1, a: 2}}\n") == (
        "rover.yaml:2: postures.home.a: stated twice, first in line 2; keep one"
    )


def test_duplicate_name():
    assert refused("schema: 1\ncouplings: [{name: a, joints: {x: 1}}, {name: a, joints: {y: 1}}]\n") == (
        "rover.yaml: couplings[1]: the name stands twice (got 'a'); rename one of them"
    )


def test_yaml_tags_run_nothing():
    assert "not YAML" in refused("schema: 1\nup: !!python/object/apply:os.getcwd []\n")


def test_scientific_numbers_without_a_point():
    sidecar = read_sidecar("schema: 1\nloops: [{name: l, frames: [a, b], tolerance: 1e-6}]\n", "rover.yaml")
    assert sidecar.loops[0].tolerance == 1e-6


def test_robot_yaml_of_parallel_robots_is_read():
    sidecar = read_sidecar("closed_loop: [[a, b], [c, d]]\ntype: [6d, 3d]\nname_mot: [m]\n", "robot.yaml")
    assert [(loop.type, loop.frames) for loop in sidecar.loops] == [
        ("weld", ("a", "b")),
        ("ball", ("c", "d")),
    ]
    assert sidecar.actuated == ("m",)


def test_robot_yaml_with_other_keys():
    assert "add `schema: 1` to use the keys of a rover.yaml with them" in refused(
        "closed_loop: [[a, b]]\nwheels: []\n"
    )
    assert "needs one of 6d, 3d for each closed loop" in refused("closed_loop: [[a, b]]\ntype: [5d]\n")


def test_no_such_sidecar(make, tmp_path):
    path = make.write(*make.pair())
    with pytest.raises(rp.errors.SidecarError) as caught:
        rp.load(path, sidecar=tmp_path / "no.yaml")
    assert str(caught.value) == f"{tmp_path}/no.yaml: no such file; give the path of a rover.yaml"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "wheels: [{frame: arn, radius: 1}]",
            "rover.yaml: wheels[0]: no link or joint of this name (got 'arn'); did you mean 'arm'?",
        ),
        (
            "contacts: [{frame: arn}]",
            "rover.yaml: contacts[0]: no link or joint of this name (got 'arn'); did you mean 'arm'?",
        ),
        (
            "belly: [{frame: arn, point: [0, 0, 0]}]",
            "rover.yaml: belly[0]: no link or joint of this name (got 'arn'); did you mean 'arm'?",
        ),
        ("locks: [jj]", "rover.yaml: locks[0]: no moving joint of that name (got 'jj'); did you mean 'j'?"),
        (
            "{locks: [j], actuated: [j]}",
            "rover.yaml: locks[0]: a driven joint is held anyway (got 'j'); list passive joints only",
        ),
        ("actuated: [jj]", "rover.yaml: actuated[0]: no such joint (got 'jj'); did you mean 'j'?"),
        ("actuated: [f]", "rover.yaml: actuated[0]: this joint is fixed (got 'f'); free it or drop it here"),
        (
            "{actuated: [j], passive: [j]}",
            "rover.yaml: both `actuated` and `passive` are given; keep one: the rest follows",
        ),
        (
            "postures: {up: {jj: 0}}",
            "rover.yaml: postures.up.jj: no moving joint of that name (got 0.0); did you mean 'j'?",
        ),
        (
            "postures: {up: {j: 2}}",
            "rover.yaml: postures.up.j: posture outside limits: Joint j: -1 <= 2 "
            "<= 1; stay within the limits",
        ),
        (
            "wheels: [{frame: base, radius: 1}]",
            "rover.yaml: wheels[0]: no turning joint right above it to take the "
            "axis from (got 'base'); state its `axis`",
        ),
        (
            "wheels: [{frame: arm, radius: 1, tread: 2}]",
            "rover.yaml: wheels[0]: tread is more than the radius 1 m (got 2.0); "
            "give at most the radius, which makes the wheel a sphere",
        ),
        (
            "wheels: [{frame: arm, radius: 1}, {frame: arm, radius: 1}]",
            "rover.yaml: wheels: two wheels or contacts bear one name (got 'arm'); give each its own `name`",
        ),
        (
            "springs: [{name: s, joint: jj, stiffness: 1}]",
            "rover.yaml: springs.s: no moving joint of this name (got 'jj'); did you mean 'j'?",
        ),
        (
            "loops: [{name: l, frames: [base, arn]}]",
            "rover.yaml: loops.l: no link or joint of this name (got 'arn'); did you mean 'arm'?",
        ),
    ],
)
def test_names_that_are_not_there(make, text, said):
    body = [*make.pair(), make.link("tip"), make.joint("f", "arm", "tip", "fixed")]
    if text.startswith("{"):
        text = text.strip("{}").replace("], ", "]\n")
    assert make.refused(*body, sidecar=text) == said
