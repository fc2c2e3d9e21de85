"""What a URDF is refused for, word for word."""

import pytest

import rover_pin as rp


def test_no_such_file(tmp_path):
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load(tmp_path / "no.urdf")
    assert (
        str(caught.value)
        == f"{tmp_path}/no.urdf: no such file; check the path; a bundled robot goes by its bare name"
    )


def test_unknown_bundled_name():
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load("rocker_bogy")
    assert str(caught.value) == (
        "no bundled robot of that name (got 'rocker_bogy'); did you mean 'rocker_bogie'?; "
        "a path to a URDF or xacro works too"
    )


def test_not_xml(tmp_path):
    path = tmp_path / "a.urdf"
    path.write_text("<robot><link></robot>")
    with pytest.raises(
        rp.errors.DescriptionError, match=r"a\.urdf: not XML: Opening and ending tag mismatch.*mend it"
    ):
        rp.load(path)


def test_not_text(tmp_path):
    path = tmp_path / "a.urdf"
    path.write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(rp.errors.DescriptionError, match="cannot be read"):
        rp.load(path)


def test_not_a_robot(tmp_path):
    path = tmp_path / "a.urdf"
    path.write_text("<sdf version='1.7'/>")
    with pytest.raises(rp.errors.DescriptionError, match="not a URDF: its outermost element is <sdf>"):
        rp.load(path)


def test_no_link(make):
    assert make.refused() == "bot.urdf: a robot without a link; give it at least one <link>"


def test_entities_do_not_read_files(tmp_path):
    secret = tmp_path / "secret"
    secret.write_text("hidden")
    path = tmp_path / "a.urdf"
    path.write_text(
        f'<!DOCTYPE robot [<!ENTITY x SYSTEM "file://{secret}">]><robot '
        f'name="a"><link name="b">&x;</link></robot>'
    )
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load(path)
    assert "hidden" not in str(caught.value)


def test_two_roots(make):
    assert make.refused(make.link("a"), make.link("b")) == (
        "bot.urdf: robot: 2 root links: a, b; connect them with a joint, or remove all but one"
    )


def test_circle(make):
    said = make.refused(
        make.link("r"),
        make.link("a"),
        make.link("b"),
        make.joint("x", "a", "b"),
        make.joint("y", "b", "a"),
    )
    assert said == (
        "bot.urdf: robot: links in a circle: a, b; open it at one joint and "
        "close the loop in the sidecar under `loops`"
    )


def test_two_parents(make):
    said = make.refused(
        make.link("a"),
        make.link("b"),
        make.link("c"),
        make.joint("x", "a", "b"),
        make.joint("y", "a", "c"),
        make.joint("z", "c", "b"),
    )
    assert said == (
        "bot.urdf: link b: child of two joints, x and z; keep one and close "
        "the loop in the sidecar under `loops`"
    )


def test_duplicate_names(make):
    assert make.refused(make.link("a"), make.link("a")) == (
        "bot.urdf: link a: the name stands twice; rename one <link>"
    )
    said = make.refused(make.link("a"), make.link("b"), make.joint("x", "a", "b"), make.joint("x", "a", "b"))
    assert said == "bot.urdf: joint x: the name stands twice; rename one <joint>"


def test_nameless(make):
    assert make.refused("<link/>") == "bot.urdf: a link: no name; name every <link>"


def test_unknown_parent(make):
    assert make.refused(make.link("base"), make.link("arm"), make.joint("j", "bse", "arm")) == (
        "bot.urdf: joint j: its parent link does not exist (got 'bse'); did you mean 'base'?"
    )


def test_unknown_type(make):
    assert make.refused(*make.pair("revolut")) == (
        "bot.urdf: joint j: unknown joint type (got 'revolut'); did you mean 'revolute'?"
    )


def test_planar(make):
    assert make.refused(*make.pair("planar")) == (
        "bot.urdf: joint j: planar joints are not supported; use two prismatic joints and a revolute one"
    )


def test_zero_axis(make):
    assert make.refused(*make.pair(axis="0 0 0")) == (
        "bot.urdf: joint j: a zero axis (got '0 0 0'); give the direction it moves about or along"
    )


def test_a_fixed_joint_needs_no_axis(make):
    assert make.load(*make.pair("fixed", axis="0 0 0")).joints == ()


def test_unexpanded(make):
    assert make.refused(*make.pair(xyz="${r} 0 0")) == (
        "bot.urdf: joint j: an unexpanded expression in <origin xyz> (got '${r} 0 0'); "
        "give the .xacro file, or expand it first"
    )


@pytest.mark.parametrize("text", ["nan", "inf", "-inf"])
def test_mass_not_finite(make, text):
    assert make.refused(make.link("a", mass=text)) == (
        f"bot.urdf: link a: <mass value> is not finite (got '{text}'); give finite numbers"
    )


def test_inertia_not_finite(make):
    body = '<link name="a"><inertial><mass value="1"/><inertia ixx="nan"/></inertial></link>'
    assert (
        make.refused(body) == "bot.urdf: link a: <inertia ixx> is not finite (got 'nan'); give finite numbers"
    )


def test_not_a_number(make):
    assert make.refused(make.link("a", mass="heavy")) == (
        "bot.urdf: link a: <mass value> is not a number (got 'heavy'); give plain numbers"
    )


def test_wrong_count(make):
    assert make.refused(*make.pair(xyz="1 2")) == (
        "bot.urdf: joint j: <origin xyz> needs 3 numbers (got '1 2'); mend it"
    )


def test_negative_mass(make):
    assert (
        make.refused(make.link("a", mass=-2))
        == "bot.urdf: link a: negative mass (got '-2'); give its mass in kg"
    )


def test_negative_inertia(make):
    body = '<link name="a"><inertial><mass value="1"/><inertia ixx="-1" iyy="1" izz="1"/></inertial></link>'
    assert make.refused(body) == (
        "bot.urdf: link a: negative moment of inertia ixx (got '-1'); give "
        "moments about the centre of mass in kg m2"
    )


def test_no_mass_at_all(make):
    assert make.refused(make.link("a", mass=0), make.link("b", mass=None), make.joint("j", "a", "b")) == (
        "bot.urdf: the robot has no mass; give its links <inertial>, or masses "
        "under `inertials` in the sidecar"
    )


def test_lower_above_upper(make):
    assert make.refused(*make.pair(limits="1 -1")) == (
        "bot.urdf: joint j: lower limit above the upper (got '1.0 > -1.0'); swap them"
    )


def test_negative_effort(make):
    body = [
        make.link("a"),
        make.link("b"),
        make.joint("j", "a", "b", "continuous", extra='<limit effort="-1"/>'),
    ]
    assert make.refused(*body) == "bot.urdf: joint j: negative effort limit (got '-1'); give its size"


def test_reserved_name(make):
    assert make.refused(make.link("a"), make.link("b"), make.joint("base_x", "a", "b")) == (
        "bot.urdf: joint base_x: a name kept for the base; rename the joint"
    )
