"""`init`: what is guessed of a URDF, marked as guesses, and what becomes of them once uncommented."""

import json
import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml

import rover_pin as rp
from rover_pin.cli import main

HERE = Path(__file__).parents[2]
DATA = next(
    iter(Path(sys.prefix).glob("lib/python*/site-packages/cmeel.prefix/share/example-robot-data/robots"))
)
FIXTURES = [
    path for path in sorted((HERE / "tests" / "fixtures").iterdir()) if (path / f"{path.name}.urdf").is_file()
]
OTHERS = [
    "tiago_description/robots/tiago.urdf", "tiago_pro_description/robots/tiago_pro.urdf",
    "pr2_description/urdf/pr2.urdf", "centauro_description/urdf/centauro.urdf",
    "anymal_b_simple_description/robots/anymal.urdf", "hyq_description/robots/hyq_no_sensors.urdf",
    "laikago_description/urdf/laikago.urdf",
]  # fmt: skip


def begun(urdf, out):
    """The guesses, and the file's text."""
    assert main(["init", str(urdf), "-o", str(out)]) == 0
    return out.read_text()


def uncommented(path):
    path.write_text(re.sub(r"^# ", "", path.read_text(), flags=re.M))
    return path


@pytest.mark.parametrize("folder", FIXTURES, ids=lambda path: path.name)
def test_wheels_of_our_own_urdfs_are_found_again(folder, tmp_path):
    urdf = tmp_path / f"{folder.name}.urdf"
    shutil.copy(folder / urdf.name, urdf)
    before = rp.load(urdf)
    text = begun(urdf, tmp_path / "rover.yaml")
    assert yaml.safe_load(text) == {"schema": 1}  # nothing is said yet
    silent = rp.load(urdf)
    assert silent.actuated == before.actuated
    assert (silent.wheels, silent.feet, silent.couplings) == ((), (), before.couplings)
    guessed = rp.load(urdf, sidecar=uncommented(tmp_path / "rover.yaml"))
    stated = rp.load(folder / urdf.name)
    drives = {w.drive for w in stated.wheels if w.drive is not None}
    assert {w.drive for w in guessed.wheels} >= drives
    radii = {w.drive: w.radius for w in guessed.wheels}
    for wheel in stated.wheels:
        if wheel.drive is not None:
            assert radii[wheel.drive] == pytest.approx(wheel.radius)


@pytest.mark.parametrize("name", ["rocker_bogie", "hit_mrii"])
def test_a_bundled_xacro_without_its_sidecar(name, tmp_path):
    folder = tmp_path / "urdf" / name
    shutil.copytree(HERE / "urdf" / name, folder)
    for shared in (HERE / "urdf").glob("*.xacro"):
        shutil.copy(shared, tmp_path / "urdf")
    (folder / "rover.yaml").unlink()
    assert main(["init", str(folder / f"{name}.urdf.xacro")]) == 0
    guessed = rp.load(folder / f"{name}.urdf.xacro", sidecar=uncommented(folder / "rover.yaml"))
    stated = rp.load(name)
    assert {w.link for w in guessed.wheels} == {w.link for w in stated.wheels}
    assert guessed.mass == pytest.approx(stated.mass)


def test_the_guessed_rocker_bogie_stands_as_the_stated_one(tmp_path):
    out = tmp_path / "rover.yaml"
    begun(HERE / "urdf" / "rocker_bogie" / "rocker_bogie.urdf.xacro", out)
    guessed = rp.load(HERE / "urdf" / "rocker_bogie" / "rocker_bogie.urdf.xacro", sidecar=uncommented(out))
    stated = rp.load("rocker_bogie")
    assert set(guessed.passive) == set(stated.passive)
    loads = [list(rp.settle(rover, rp.Terrain.flat()).loads.values()) for rover in (guessed, stated)]
    np.testing.assert_allclose(*loads, rtol=1e-9)


@pytest.mark.parametrize("name", OTHERS)
def test_robots_of_others_load_once_uncommented(name, tmp_path):
    text = begun(DATA / name, tmp_path / "rover.yaml")
    for line in text.splitlines():
        entry = re.match(r"#   - |# \w+: \S", line)
        assert not entry or "# guess: " in line or "# <mimic>" in line, line
    rover = rp.load(DATA / name, sidecar=uncommented(tmp_path / "rover.yaml"))
    touching = {"tiago.urdf": 6, "pr2.urdf": 0}
    assert len(rover.shapes) == touching.get(Path(name).name, 4)
    if rover.shapes:
        assert str(rp.settle(rover, rp.Terrain.flat(), posture=None).status) in (
            "settled",
            "loose",
            "grounded",
            "tips",
        )


def test_loops_of_gazebo_tags_and_mimics(make, tmp_path):
    gazebo = (
        '<gazebo><joint name="shut" type="revolute"><parent>base</parent><child>b</child>'
        "<pose>0.1 0 0 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint></gazebo>"
        '<gazebo><joint name="odd" type="screw"><parent>base</parent><child>b</child></joint></gazebo>'
    )
    follows = '<mimic joint="rocker_a" multiplier="-2" offset="0.1"/>'
    parts = [
        make.link("base"), make.link("a"), make.link("b"),
        make.joint("rocker_a", "base", "a", xyz="0 0 0.2"),
        make.joint("j", "a", "b", xyz="0.3 0 0", extra=follows),
        gazebo,
    ]  # fmt: skip
    text = begun(make.write(*parts), tmp_path / "out.yaml")
    assert (
        "#   - {name: shut, frames: [{link: b, xyz: [0.1, 0, 0]}, base], type: hinge, axis: [0, 1, 0], "
        "at: zero}  # guess: joint shut of a <gazebo> tag, type revolute"
    ) in text
    assert (
        "#   - {name: mimic_j, joints: {j: 1, rocker_a: 2}, offset: 0.1}  # <mimic> of j, read already"
    ) in text
    assert "# passive: [rocker_a]  # guess: names; all else is then driven" in text
    assert "## Note: joint odd (b to base, screw) of a <gazebo> tag is no loop here." in text
    assert "## Note: no link looks like a wheel or a ball foot: list `wheels` or `contacts`." in text
    rover = rp.load(tmp_path / "bot.urdf", sidecar=uncommented(tmp_path / "out.yaml"))
    assert [loop.name for loop in rover.loops] == ["shut"]
    assert len(rover.couplings) == 1  # counted once
    at = rover.loops[0]
    assert at.second.translation == pytest.approx([0.4, 0.0, 0.2])  # the pin at zero, in the base


def test_a_gepetto_file_beside_is_named_as_it_is(make, tmp_path):
    parts = [*make.pair(), make.link("tip"), make.joint("k", "arm", "tip", xyz="0.2 0 0")]
    path = make.write(*parts)
    (tmp_path / "robot.yaml").write_text("closed_loop: [[tip, base]]\ntype: ['3d']\nname_mot: [j]\n")
    assert main(["init", str(path)]) == 0
    rover = rp.load(path)
    assert rover.sidecar_path.name == "rover.yaml"
    assert [loop.type for loop in rover.loops] == ["ball"]
    assert rover.actuated == ("j",)


@pytest.mark.parametrize("upper", [-0.6108652381980153, -12.3456789, 1.04719755])
def test_a_home_at_a_limit_is_rounded_to_the_inside(make, tmp_path, upper):
    lower, upper = (upper - 1.0, upper) if upper < 0 else (upper, upper + 1.0)
    path = make.write(*make.pair(kind="prismatic", limits=f"{lower!r} {upper!r}"))
    begun(path, tmp_path / "rover.yaml")
    home = rp.load(path, sidecar=uncommented(tmp_path / "rover.yaml")).postures["home"]["j"]
    assert lower <= home <= upper
    assert home == pytest.approx(min(lower, upper, key=abs), rel=1e-5)


def test_feet_without_a_shape_are_told(make, tmp_path):
    body = [make.link("base_footprint"), make.link("LF_FOOT"), make.joint("j", "base_footprint", "LF_FOOT")]
    text = begun(make.write(*body), tmp_path / "rover.yaml")
    assert "## Note: link LF_FOOT is named like a foot, but no sphere tells its radius.\n" in text
    assert "base_footprint is named" not in text


def test_a_root_that_points_down_and_floats(make, tmp_path):
    wheel = (
        '<collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1" length="0.06"/></geometry>'
        "</collision>"
    )
    body = [make.link("odom"), make.link("hull", 20), make.joint("free", "odom", "hull", "floating")]
    for name, x, y in (("fl", 0.3, -0.2), ("fr", 0.3, 0.2), ("bl", -0.3, -0.2), ("br", -0.3, 0.2)):
        body += [
            make.link(f"wheel_{name}", 1, wheel),
            make.joint(name, "hull", f"wheel_{name}", "continuous", xyz=f"{x} {y} 0.15"),
            f'<transmission name="t_{name}"><joint name="{name}"/></transmission>',
            f'<gazebo reference="wheel_{name}"><mu1>0.7</mu1></gazebo>',
        ]
    path = make.write(*body)
    text = begun(path, tmp_path / "rover.yaml")
    assert "# up: [0, 0, -1]  # guess: every wheel lies above the centre of mass along z\n" in text
    assert "## Note: <transmission> says what is driven: bl, br, fl, fr.\n" in text
    rover = rp.load(path, sidecar=uncommented(tmp_path / "rover.yaml"))
    assert [wheel.friction for wheel in rover.wheels] == [0.7] * 4
    stance = rp.settle(rover, rp.Terrain.flat())
    assert list(stance.loads.values()) == pytest.approx([24 * 9.81 / 4] * 4)
    assert all(contact.point[2] == pytest.approx(0.0, abs=1e-9) for contact in stance.contacts)


def test_nothing_is_overwritten(make, tmp_path, capsys):
    path = make.write(*make.pair(), sidecar="")
    assert main(["init", str(path)]) == 2
    assert capsys.readouterr().err == (
        f"error: {tmp_path}/rover.yaml: is there already; move it away, or name another file: -o FILE\n"
    )
    assert (tmp_path / "rover.yaml").read_text() == "schema: 1\n"
    assert main(["init", "rocker_bogie"]) == 2
    assert "has its sidecar already (got 'rocker_bogie')" in capsys.readouterr().err


def test_the_object(make, tmp_path, capsys):
    path = make.write(*make.pair())
    assert main(["init", str(path), "-o", str(tmp_path / "a.yaml"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["file"] == str(tmp_path / "a.yaml")
    assert {"key": "passive", "line": "[]"}.items() <= told["guesses"][0].items()


def exported(folder):
    """A URDF as a CAD exporter writes it: meshes in mm, names with blanks and colons, wheels about -y."""
    wheel = trimesh.creation.cylinder(100, 60, sections=64)
    wheel.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))
    (folder / "meshes").mkdir()
    inertial = (
        '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    parts = [f'<link name="base_link">{inertial}</link>']
    for k, (x, y) in enumerate(((0.3, 0.3), (0.3, -0.3), (-0.3, 0.3), (-0.3, -0.3))):
        moved = wheel.copy().apply_translation((1000 * x, 1000 * y, -100))
        moved.export(folder / f"meshes/Wheel v{k}.stl")
        parts.append(
            f'<link name="Wheel v{k}:1">{inertial}<visual><origin xyz="{-x} {-y} 0.1"/><geometry><mesh '
            f'filename="package://fusion/meshes/Wheel v{k}.stl" scale="0.001 0.001 0.001"/></geometry>'
            f'</visual></link><joint name="Revolute {k}" type="continuous"><origin xyz="{x} {y} -0.1"/>'
            f'<parent link="base_link"/>'
            f'<child link="Wheel v{k}:1"/><axis xyz="0.0 -1.0 0.0"/></joint>'
        )
    path = folder / "fusion.urdf"
    path.write_text(f'<?xml version="1.0" ?><robot name="fusion">{"".join(parts)}</robot>')
    return path


def test_a_cad_export_stands_once_its_guesses_are_taken(tmp_path, capsys):
    folder = tmp_path / "fusion"
    folder.mkdir()
    urdf = exported(folder)
    assert main(["settle", str(urdf)]) == 2
    assert capsys.readouterr().err.endswith("; rover-pin init URDF writes a sidecar to start from\n")
    assert main(["init", str(urdf)]) == 0
    assert capsys.readouterr().err.endswith("every guess is commented out\n")
    assert main(["settle", str(urdf)]) == 2
    assert capsys.readouterr().err == (
        f"error: {folder}/rover.yaml: wheels: nothing of this robot touches the ground: it has no wheels "
        "and no contacts; take `# ` away from its lines that are right: guesses of rover-pin init are not "
        "used before\n"
    )
    waiting = "guesses of rover-pin init are still commented out in rover.yaml: not used"
    assert any(note.endswith(waiting) for note in rp.load(urdf).notes)
    uncommented(folder / "rover.yaml")
    rover = rp.load(urdf)
    assert not any(note.endswith(waiting) for note in rover.notes)
    assert [wheel.link for wheel in rover.wheels] == [f"Wheel v{k}:1" for k in range(4)]
    assert [wheel.radius for wheel in rover.wheels] == pytest.approx([0.1] * 4, rel=0.01)
    stance = rp.settle(rover, rp.Terrain.flat())
    assert list(stance.loads.values()) == pytest.approx([9.81 * 10 / 4] * 4)
