"""Names, paths, xacro, packages and parameters."""

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.description.packages import Packages
from rover_pin.description.parameters import ParameterSpec, parameter_values

XACRO = """<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="size" default="2"/>
{include}
<link name="base"><inertial><mass value="$(arg size)"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
{more}
</robot>"""


def write(path, include="", more=""):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(XACRO.format(include=include, more=more))
    return path


def message(*args, **keywords):
    with pytest.raises(rp.errors.InputError) as caught:
        rp.load(*args, **keywords)
    return str(caught.value)


def test_bundled_robots_are_listed_with_their_summary():
    entries = {entry.name: entry for entry in rp.robots()}
    assert {"rocker_bogie", "hit_mrii"} <= set(entries)
    for entry in entries.values():
        assert entry.path.is_file()
        assert entry.summary.endswith(".")
        assert entry.name.islower()


@pytest.mark.parametrize("name", [entry.name for entry in rp.robots()])
def test_every_bundled_robot_loads_quietly(name):
    rover = rp.load(name)
    assert rover.name == name
    assert rover.mass > 0
    massless = [
        note for note in rover.notes if "have no inertial: no mass" in note
    ]  # arms of the paper's model
    assert list(rover.notes) == massless
    assert not massless or name in ("polibot", "polibot_half", "x_suspension")


def test_a_folder_stands_for_its_description(tmp_path):
    write(tmp_path / "bot" / "bot.urdf.xacro")
    assert rp.load(tmp_path / "bot").mass == 2.0
    empty = tmp_path / "empty"
    empty.mkdir()
    assert message(empty) == (
        f"{empty}: a folder without a description of its name; name the file, or put empty.urdf.xacro in it"
    )


def test_xacro_arguments_are_parameters(tmp_path):
    path = write(tmp_path / "a.urdf.xacro")
    (tmp_path / "rover.yaml").write_text(
        "schema: 1\nparameters: {size: {default: 3, unit: kg, bounds: [1, 5]}}\n"
    )
    assert rp.load(path).mass == 3.0
    rover = rp.load(path, size=4.5)
    assert rover.mass == 4.5
    assert dict(rover.parameters) == {"size": 4.5}
    assert rover.with_parameters(size=1).mass == 1.0
    assert message(path, siz=1) == "parameter siz: no parameter of that name; did you mean 'size'?"
    assert message(path, size=9) == "parameter size: out of bounds (got 9); stay between 1.0 and 5.0 kg"
    assert message(path, size=float("nan")) == (
        "parameter size: not a finite number (got nan); give a number kg"
    )


def test_an_undeclared_keyword(tmp_path):
    assert message(write(tmp_path / "a.urdf.xacro"), size=1) == (
        "parameter size: no parameter of that name; declare it under `parameters` in the sidecar"
    )


def test_a_parameter_that_is_no_argument(tmp_path):
    path = write(tmp_path / "a.urdf.xacro")
    (tmp_path / "rover.yaml").write_text("schema: 1\nparameters: {sise: {default: 3}}\n")
    assert message(path) == (
        f"{tmp_path}/rover.yaml: parameters.sise: no <xacro:arg> of that name "
        f"in a.urdf.xacro, and no formula of the sidecar uses it; did you mean 'size'?"
    )


def test_a_parameter_of_a_plain_urdf(make):
    assert make.refused(*make.pair(), sidecar="parameters: {t: {default: 1}}") == (
        "rover.yaml: parameters.t: bot.urdf is plain URDF without arguments, "
        "and no formula of the sidecar uses it; remove it"
    )


def test_parameters_in_bounds():
    declared = {"a": ParameterSpec(default=1), "b": ParameterSpec(default=2, bounds=(0, 4))}
    assert parameter_values(declared, {"b": np.float64(3)}) == {"a": 1.0, "b": 3.0}
    with pytest.raises(
        rp.errors.InputError, match=r"parameter a: not a finite number \(got 'wide'\); give a number"
    ):
        parameter_values(declared, {"a": "wide"})


def test_xacro_in_a_plain_urdf_runs(tmp_path):
    path = tmp_path / "a.urdf"
    write(
        path,
        more='<xacro:if value="${1 == 1}"><link name="b"/><joint name="j" type="fixed">'
        '<parent link="base"/><child link="b"/></joint></xacro:if>',
    )
    assert rp.load(path).model.existFrame("b")


def test_xacro_without_links(tmp_path):
    path = tmp_path / "m.urdf.xacro"
    path.write_text(
        '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:macro name="arm" params="side"><link name="${side}"/></xacro:macro></robot>'
    )
    assert message(path) == (
        f"{path}: the xacro expands to no link; it only defines the macro arm: name the file that calls it"
    )
    path.write_text('<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro"/>')
    assert message(path) == (
        f"{path}: the xacro expands to no link; check the arguments and the <xacro:if> conditions"
    )


def test_xacro_errors_name_the_file_and_a_cure(tmp_path):
    path = write(tmp_path / "a.urdf.xacro", more="<xacro:nothing/>")
    said = message(path)
    assert said.startswith(f"{path}: xacro: unknown macro name: xacro:nothing")
    assert said.endswith("include the file that defines the macro")
    said = message(write(tmp_path / "b.urdf.xacro", more='<link name="${nope}"/>'))
    assert "nope" in said
    assert said.endswith("mend the expression in the xacro file")


def test_relative_includes_from_anywhere(tmp_path, monkeypatch):
    path = write(
        tmp_path / "a.urdf.xacro", include='<xacro:include filename="parts/p.xacro"/>', more="<xacro:tip/>"
    )
    part = tmp_path / "parts" / "p.xacro"
    part.parent.mkdir()
    part.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="tip"><link name="tip"/>'
        '<joint name="t" type="fixed"><parent link="base"/><child link="tip"/></joint></xacro:macro></robot>'
    )
    monkeypatch.chdir("/")
    assert rp.load(path).model.existFrame("tip")


def test_missing_includes(tmp_path):
    path = write(tmp_path / "a.urdf.xacro", include='<xacro:include filename="no.xacro"/>')
    said = message(path)
    assert "No such file" in said
    assert said.endswith("put the file there, or skip missing includes")
    rover = rp.load(path, skip_missing_includes=True)
    assert rover.mass == 2.0
    assert "include no.xacro is missing: skipped" in rover.notes


def test_find_in_given_packages(tmp_path):
    path = write(tmp_path / "a.urdf.xacro", include='<xacro:include filename="$(find parts_pkg)/p.xacro"/>')
    said = message(path)
    assert said.endswith(
        "give its folder: packages={'parts_pkg': ...} or --package parts_pkg=..., or skip missing includes"
    )
    folder = tmp_path / "elsewhere" / "deep"
    folder.mkdir(parents=True)
    (folder / "p.xacro").write_text("<robot/>")
    assert rp.load(path, packages={"parts_pkg": folder}).mass == 2.0
    rover = rp.load(path, skip_missing_includes=True)
    assert "include $(find parts_pkg)/p.xacro is missing: skipped" in rover.notes


def test_a_package_folder_that_is_not_there(tmp_path):
    path = write(tmp_path / "a.urdf.xacro")
    assert message(path, packages={"p": tmp_path / "no"}) == (
        f"package p: no such folder (got '{tmp_path}/no'); give the package's folder"
    )


def test_packages_above_the_file(tmp_path):
    named = tmp_path / "some_folder"
    (named / "urdf").mkdir(parents=True)
    (named / "package.xml").write_text("<package><name> real_name </name></package>")
    mesh = named / "m.stl"
    mesh.write_text("")
    packages = Packages(named / "urdf" / "a.urdf")
    assert packages.find("real_name") == named
    assert packages.find("some_folder") == named
    assert packages.find("surely_not_there") is None
    assert packages.resolve("package://real_name/m.stl") == mesh
    assert packages.resolve("package:///real_name/m.stl") == mesh
    assert packages.resolve("../m.stl") == mesh
    assert packages.resolve(f"file://{mesh}") == mesh
    assert packages.resolve("package://real_name/n.stl") is None


def test_xacro_leaves_nothing_on_stderr(tmp_path, capfd):
    path = write(tmp_path / "a.urdf.xacro", include='<xacro:include filename="none_*.xacro"/>')
    rover = rp.load(path)
    assert capfd.readouterr() == ("", "")
    assert any("none_*.xacro" in note for note in rover.notes)


def test_a_whole_number_may_be_counted_with(tmp_path):
    path = write(tmp_path / "a.urdf.xacro", more='<link name="l${[n for n in range(size)][-1]}"/>')
    path.write_text(
        path.read_text().replace(
            '<link name="base">', '<xacro:property name="size" value="$(arg size)"/><link name="base">'
        )
    )
    (tmp_path / "rover.yaml").write_text("schema: 1\nparameters: {size: {default: 4}}\n")
    assert "2 root links: base, l3" in message(path)
