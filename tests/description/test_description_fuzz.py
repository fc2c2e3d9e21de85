"""Damaged files of every kind, by hypothesis: a good load or one line of ours, no traceback, never long."""

import io
import json
import random
import time
from pathlib import Path

import numpy as np
import pytest
import tifffile
import trimesh
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from PIL import Image

import rover_pin as rp
from rover_pin.cli import main
from rover_pin.control.plan import load_plan
from rover_pin.errors import InputError

FOUR_BAR = Path(__file__).parents[1] / "fixtures" / "four_bar"
URDF, SIDECAR = (FOUR_BAR / "four_bar.urdf").read_bytes(), (FOUR_BAR / "rover.yaml").read_bytes()
GEPETTO = b"closed_loop: [[knuckle_l, lower_l]]\ntype: ['3d']\nname_mot: [drive_bl]\njoint_name: []\n"
SRDF = b"""<robot name="b"><group_state name="up" group="g"><joint name="upper_l" value="0.1"/></group_state>
<passive_joint name="upper_l"/></robot>"""
MJCF = b"""<mujoco model="m"><compiler eulerseq="xyz"/><default><default class="w"><geom size="0.1"/></default></default>
<worldbody><body name="a"><freejoint/><geom type="box" size="0.1 0.2 0.3" euler="0 10 0"/>
<body name="b" pos="0 0 1" quat="1 0 0 1" childclass="w"><joint name="j" range="-10 10" axis="0 1 0" stiffness="2"/><geom/></body>
<body name="c"><joint name="k"/><geom size="0.1" mass="2"/></body></body></worldbody>
<equality><connect body1="b" body2="c" anchor="0 0 0.1"/><joint joint1="j" joint2="k" polycoef="0 1 0 0 0"/></equality>
</mujoco>"""  # noqa: E501
ASC = b"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 1\ncellsize 0.5\n1 2 3\n4 5 6\n7 8 9\n"
LEVEL = b"ncols 5\nnrows 5\nxllcorner -4\nyllcorner -4\ncellsize 2\n" + b"0 0 0.01 0 0\n" * 5
STUDY = b"""robot: bot.urdf
terrain: {rough: {seed: 1, rms: 0.02, hurst: 0.8, size: 4, spacing: 0.1}}
cases: {n: 2}
vary: {x: [-1, 1], y: map, yaw_deg: [0, 360], friction: [0.5]}
measures: [tip, loads]
payload: [{kg: 5, at: [0, 0, 0.3]}]
"""
XACRO = b"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="t" default="0.5"/>
<xacro:property name="t" value="$(arg t)"/><xacro:macro name="w" params="n *o"><link name="${n}"><inertial><mass value="${2*t}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" type="continuous"><parent link="b"/>
<child link="${n}"/><xacro:insert_block name="o"/><axis xyz="0 1 0"/></joint></xacro:macro><link name="b"/>
<xacro:if value="${t > 0.1}"><xacro:w n="a"><origin xyz="${t} 0 ${-t**2}"/></xacro:w></xacro:if></robot>"""  # noqa: E501
MESHED = b"""<robot name="r"><link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="wheel"><visual><geometry><mesh filename="w.stl" scale="1 1 1"/></geometry></visual></link>
<joint name="j" type="continuous"><parent link="b"/><child link="wheel"/><axis xyz="0 1 0"/></joint></robot>"""  # noqa: E501
PLAN = (Path(rp.__file__).parents[1] / "urdf" / "hit_mrii" / "control.yaml").read_bytes()
ODD = [
    "nan",
    "inf",
    "-1",
    "0",
    "1e300",
    "1e999",
    "",
    "abc",
    "1,5",
    "1_0",
    "\u0661",
    "1 2",
    "${9**9**9}",
    "a" * 3000,
]
VALUES = [
    None,
    True,
    0,
    -1,
    1.5,
    float("nan"),
    float("inf"),
    1e300,
    10**400,
    "",
    "abc",
    [],
    {},
    [1],
    {"a": 1},
]


def png():
    out = io.BytesIO()
    Image.fromarray(np.arange(25, dtype=np.uint16).reshape(5, 5) * 999).save(out, "PNG")
    return out.getvalue()


def npy():
    out = io.BytesIO()
    np.save(out, np.arange(25.0).reshape(5, 5))
    return out.getvalue()


def npz():
    out = io.BytesIO()
    np.savez_compressed(out, heights=np.arange(25.0).reshape(5, 5), spacing=0.5, origin=[0.0, 1.0])
    return out.getvalue()


def tif():
    out = io.BytesIO()
    tifffile.imwrite(out, np.arange(25, dtype=np.float32).reshape(5, 5), compression="zlib")
    return out.getvalue()


def stl():
    wheel = trimesh.creation.cylinder(0.1, 0.06, sections=16)
    return wheel.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])).export(
        file_type="stl"
    )


def bytes_changed(rng, data):
    data, k = bytearray(data), rng.randrange(4)
    at = rng.randrange(len(data))
    if k == 0:
        return bytes(data[:at])
    if k == 1:
        data[at] ^= 1 << rng.randrange(8)
    elif k == 2:
        del data[at : at + rng.choice([1, 8, 64])]
    else:
        data[at:at] = data[at : at + 32]
    return bytes(data)


def elements_changed(rng, data):
    root = etree.fromstring(data)
    every = list(root.iter())
    one, k = rng.choice(every), rng.randrange(4)
    if k == 0 and one is not root:
        one.getparent().remove(one)
    elif k == 1 and one is not root:
        one.addnext(etree.fromstring(etree.tostring(one)))
    elif k == 2 and one.attrib:
        del one.attrib[rng.choice(list(one.attrib))]
    elif one.attrib:
        one.set(rng.choice(list(one.attrib)), rng.choice(ODD))
    return etree.tostring(root)


def keys_changed(rng, data):
    data = yaml.safe_load(data)
    at = data
    while True:
        keys = list(at) if isinstance(at, dict) else list(range(len(at)))
        key = rng.choice(keys)
        if rng.random() < 0.3 or not isinstance(at[key], (dict, list)) or not at[key]:
            break
        at = at[key]
    if rng.random() < 0.3:
        del at[key]
    else:
        at[key] = rng.choice(VALUES)
    return yaml.safe_dump(data).encode()


def rover(folder, name="bot.urdf", sidecar=None):
    loaded = rp.load(folder / name, sidecar=sidecar)
    assert loaded.info()["mass_kg"] > 0
    assert np.isfinite(loaded.model.inertias[1].mass)


def terrain(folder, name, **more):
    assert np.isfinite(rp.Terrain.from_file(folder / name, **more).height(0.6, 1.6))


def begun(folder, name="bot.urdf"):
    out = folder / "begun.yaml"
    out.unlink(missing_ok=True)
    if main(["init", str(folder / name), "-o", str(out)]) == 0:
        assert yaml.safe_load(out.read_text()) == {"schema": 1}


KINDS = {
    "bot.urdf": (URDF, elements_changed, rover),
    "bot.urdf.xacro": (XACRO, elements_changed, lambda folder: rover(folder, "bot.urdf.xacro")),
    "rover.yaml": (SIDECAR, keys_changed, rover),
    "robot.yaml": (GEPETTO, keys_changed, lambda folder: rp.load(folder / "bot.urdf")),
    "bot.srdf": (SRDF, elements_changed, lambda folder: rover(folder, sidecar=folder / "bot.srdf")),
    "m.xml": (MJCF, elements_changed, lambda folder: rover(folder, "m.xml")),
    "m.asc": (ASC, bytes_changed, lambda folder: terrain(folder, "m.asc")),
    "m.png": (png(), bytes_changed, lambda folder: terrain(folder, "m.png", spacing=0.5, height_scale=1e-3)),
    "m.npy": (npy(), bytes_changed, lambda folder: terrain(folder, "m.npy", spacing=0.5)),
    "m.npz": (npz(), bytes_changed, lambda folder: terrain(folder, "m.npz")),
    "m.tif": (tif(), bytes_changed, lambda folder: terrain(folder, "m.tif", spacing=0.5)),
    "m.csv": (
        b"1,2,3,4\n4,5,6,7\n7,8,9,1\n1,1,1,1\n",
        bytes_changed,
        lambda folder: terrain(folder, "m.csv", spacing=1.0),
    ),
    "s.yaml": (STUDY, keys_changed, lambda folder: rp.analysis.Study.from_file(folder / "s.yaml").plan),
    "control.yaml": (PLAN, keys_changed, lambda folder: load_plan(CRAWLER, folder / "control.yaml")),
}
CRAWLER = rp.load("hit_mrii")
BESIDE = {"bot.urdf": "rover.yaml", "s.yaml": "rover.yaml"}  # whose words may be at odds with a damaged one
EXAMPLES = settings(max_examples=30, derandomize=True, deadline=None, database=None)
CHANCE = st.integers(0, 2**32).map(random.Random)


def laid_out(folder, name, data):
    """A folder with that file and, but for an MJCF, with a URDF."""
    if name not in ("bot.urdf", "m.xml"):
        (folder / "bot.urdf").write_bytes(URDF)
    if name in BESIDE:
        (folder / "rover.yaml").write_bytes(SIDECAR)
    (folder / name).write_bytes(data)


def damaged(rng, data, change):
    return (change if rng.random() < 0.7 else bytes_changed)(rng, data)


@pytest.mark.parametrize("name", KINDS)
def test_damage_is_told_in_one_line_that_names_the_file(name, tmp_path):
    data, change, use = KINDS[name]
    laid_out(tmp_path, name, data)
    use(tmp_path)  # as it stands it is good
    names = [str(tmp_path / each) for each in (name, BESIDE.get(name)) if each]
    told = []

    @EXAMPLES
    @given(rng=CHANCE)
    def used(rng):
        changed = damaged(rng, data, change)
        (tmp_path / name).write_bytes(changed)
        began = time.process_time()
        try:
            use(tmp_path)
        except InputError as error:
            told.append(str(error))
            assert told[-1].startswith(tuple(names))
            assert "\n" not in told[-1]
            assert len(told[-1]) < 1500
        assert time.process_time() - began < 5.0

    used()
    assert len(told) > 4


COMMANDS = {
    "bot.urdf": ["settle", "bot.urdf", "--json"],
    "rover.yaml": ["settle", "bot.urdf", "--json"],
    "m.asc": ["settle", "bot.urdf", "--terrain", "m.asc", "--json"],
    "m.xml": ["info", "m.xml", "--json"],
    "s.yaml": ["study", "s.yaml", "--engine", "serial", "--json"],
    "init": ["init", "bot.urdf", "-o", "begun.yaml", "--json"],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_end_with_one_line_or_an_object(command, tmp_path, monkeypatch, capsys):
    name = "bot.urdf" if command == "init" else command
    data, change, _ = KINDS[name]
    data = LEVEL if name == "m.asc" else data
    laid_out(tmp_path, name, data)
    if name != "m.xml":
        (tmp_path / "rover.yaml").write_bytes(SIDECAR)
    monkeypatch.chdir(tmp_path)
    endings = [main(COMMANDS[command])]
    capsys.readouterr()

    @settings(EXAMPLES, max_examples=6 if name == "s.yaml" else 15)  # a study takes its time
    @given(rng=CHANCE)
    def run(rng):
        (tmp_path / name).write_bytes(damaged(rng, data, change))
        (tmp_path / "begun.yaml").unlink(missing_ok=True)
        endings.append(main(COMMANDS[command]))  # whatever is not refused on purpose is raised
        out, err = capsys.readouterr()
        if endings[-1] == 2:
            assert out == ""
            assert err.startswith("error: ")
            assert err.count("\n") == 1
        else:
            assert isinstance(json.loads(out), dict)

    run()
    assert endings[0] == 0
    assert 2 in endings


@pytest.mark.parametrize("name", ["w.stl", "bot.urdf"])
def test_init_writes_yaml_whatever_is_damaged(name, tmp_path, capsys):
    files = {"bot.urdf": MESHED, "w.stl": stl()}
    for each, data in files.items():
        (tmp_path / each).write_bytes(data)
    begun(tmp_path)  # as they stand they are good
    assert "the round mesh w.stl" in (tmp_path / "begun.yaml").read_text()
    capsys.readouterr()

    @EXAMPLES
    @given(rng=CHANCE)
    def run(rng):
        change = elements_changed if name == "bot.urdf" else bytes_changed
        (tmp_path / name).write_bytes(damaged(rng, files[name], change))
        begun(tmp_path)
        assert capsys.readouterr().err.count("\n") == 1

    run()


BOMB = '<!DOCTYPE robot [<!ENTITY a0 "lolololol">' + "".join(
    f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 10)
)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (BOMB + ']><robot name="r">&a9;<link name="l"/></robot>', "not XML: Maximum entity amplification"),
        (
            '<!DOCTYPE robot [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot>&x;<link name="l"/></robot>',
            "entities are not read (got '&x;'); write it out",
        ),
        ('<robot name="r">' + "<a>" * 5000 + "</a>" * 5000 + "</robot>", "not XML: Excessive depth"),
        ('<robot name="r"><link name="l"><inertial><mass value="1_0"/></inertial></link></robot>',
         "link l: <mass value> is not a plain number (got '1_0'); write 0 to 9 only"),
        ('<robot name="r"><link name="l"><inertial><mass value="1e200"/></inertial></link></robot>',
         "link l: <mass value> is too large to be meant (got '1e200'); give SI units"),
        ('<robot name="r"><link name="l"><visual><geometry><box/></geometry></visual></link></robot>',
         "link l: <box> has no size; state it"),
    ],
)  # fmt: skip
def test_bombs_and_numbers_that_only_python_reads(tmp_path, text, told):
    path = tmp_path / "bot.urdf"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        rp.load(path)
    assert str(caught.value).removeprefix(f"{path}: ").startswith(told)


LAUGHS = "a0: &a0 {x: 1}\n" + "".join(
    f"a{k}: &a{k} {{{', '.join(f'k{j}: *a{k - 1}' for j in range(10))}}}\n" for k in range(1, 10)
)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (LAUGHS, "s.yaml:7: a6: more by aliases than a file holds; write it out"),
        ("wheels: &a [*a]\n", "s.yaml:1: wheels[0]: an alias of itself; write it out"),
        ("x: " + "[" * 500 + "]" * 500, "s.yaml:1: nested too deeply; at most 60 levels"),
        ("x: " + "9" * 5000, "s.yaml: not YAML: Exceeds the limit"),
        ("x: 2020-13-45", "s.yaml: not YAML: month must be in 1..12; put words in quotes"),
        (
            "x: [0, 1:30]",
            "s.yaml:1: x[1]: '1:30' is another number to YAML than it looks; write plain digits",
        ),
        ("x: 010", "s.yaml:1: x: '010' is another number to YAML than it looks"),
    ],
)
def test_yaml_that_is_more_than_it_seems(text, told):
    from rover_pin.analysis.yaml_file import parse_mapping
    from rover_pin.description.reading import parse_yaml

    for read in (parse_yaml, parse_mapping):
        with pytest.raises(InputError) as caught:
            read(text, "s.yaml")
        assert str(caught.value).startswith(told)


def test_a_power_tower_in_a_xacro_is_refused_at_once(tmp_path):
    path = tmp_path / "bot.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:property name="p" value="${9**9**9}"/>'
        '<link name="l"><inertial><mass value="${p}"/></inertial></link></robot>'
    )
    with pytest.raises(InputError) as caught:
        rp.load(path)
    assert str(caught.value).startswith(f"{path}: xacro: a power in an exponent may not end")
