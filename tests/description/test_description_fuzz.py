"""Damaged files of every kind, seeded: a good load or one line of ours, never a traceback, never long."""

import io
import random
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from lxml import etree
from PIL import Image

import rover_pin as rp
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
STUDY = b"""robot: bot.urdf
terrain: {rough: {seed: 1, rms: 0.02, hurst: 0.8, size: 4, spacing: 0.1}}
cases: {n: 2}
vary: {x: [-1, 1], y: map, yaw_deg: [0, 360], friction: [0.5]}
measures: [tip, loads]
payload: [{kg: 5, at: [0, 0, 0.3]}]
"""
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


KINDS = {
    "bot.urdf": (URDF, elements_changed, rover),
    "rover.yaml": (SIDECAR, keys_changed, rover),
    "robot.yaml": (GEPETTO, keys_changed, lambda folder: rp.load(folder / "bot.urdf")),
    "bot.srdf": (SRDF, elements_changed, lambda folder: rover(folder, sidecar=folder / "bot.srdf")),
    "m.xml": (MJCF, elements_changed, lambda folder: rover(folder, "m.xml")),
    "m.asc": (ASC, bytes_changed, lambda folder: terrain(folder, "m.asc")),
    "m.png": (png(), bytes_changed, lambda folder: terrain(folder, "m.png", spacing=0.5, height_scale=1e-3)),
    "m.npy": (npy(), bytes_changed, lambda folder: terrain(folder, "m.npy", spacing=0.5)),
    "s.yaml": (STUDY, keys_changed, lambda folder: rp.analysis.Study.from_file(folder / "s.yaml").plan),
}


@pytest.mark.parametrize("name", KINDS)
def test_damage_is_told_in_one_line(name, tmp_path):
    data, change, use = KINDS[name]
    if name == "m.xml":
        (tmp_path / "m.xml").write_bytes(data)
    else:
        (tmp_path / "bot.urdf").write_bytes(URDF)
        if name in ("bot.urdf", "s.yaml"):
            (tmp_path / "rover.yaml").write_bytes(SIDECAR)
    (tmp_path / name).write_bytes(data)
    use(tmp_path)  # as it stands it is good
    rng, told = random.Random(name), []
    for k in range(24):
        damaged = (change if k % 3 else bytes_changed)(rng, data)
        (tmp_path / name).write_bytes(damaged)
        began = time.process_time()
        try:
            use(tmp_path)
        except InputError as error:
            told.append(str(error))
        assert time.process_time() - began < 5.0, damaged
    assert len(told) > 4
    assert not [words for words in told if "\n" in words or len(words) > 1500]


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
