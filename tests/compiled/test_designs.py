"""Designs from one traced run, against rovers that the loader makes one by one."""

import pickle

import numpy as np
import pytest
import yaml

import rover_pin as rp
from rover_pin.compiled.designs import Designs, difference
from rover_pin.compiled.machine import machine_of, pick
from rover_pin.description.trace import UntraceableError
from rover_pin.errors import InputError

XACRO = """<?xml version="1.0"?>
<robot name="kit" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="0.6"/>
  <xacro:arg name="lift" default="0.2"/>
  <xacro:arg name="heavy" default="12"/>
  <xacro:arg name="gear" default="0.5"/>
  <xacro:arg name="stop" default="0.4"/>
  <xacro:arg name="lean" default="0.3"/>
  <xacro:property name="reach" value="$(arg reach)"/>
  <xacro:property name="lean" value="$(arg lean)"/>
  <xacro:property name="pair" value="${reach/2} ${-lean}"/>
  <xacro:property name="short" value="${min(reach, 3*$(arg lift))}"/>
  <xacro:macro name="plain" params="name mass:=${$(arg heavy)/4} com:='0 0 0'">
    <link name="${name}"><inertial><origin xyz="${com}"/><mass value="${mass}"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  </xacro:macro>
  <xacro:macro name="joint" params="name parent child kind:=revolute xyz:='0 0 0' rpy:='0 0 0' axis:='0 1 0'
                                    *limit">
    <joint name="${name}" type="${kind}"><parent link="${parent}"/><child link="${child}"/>
      <origin xyz="${xyz}" rpy="${rpy}"/><axis xyz="${axis}"/><xacro:insert_block name="limit"/></joint>
  </xacro:macro>

  <link name="base"><inertial><origin xyz="${pair} $(arg lift)"/><mass value="$(arg heavy)"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 ${reach/3} 0" rpy="0 ${lean} 0.2"/><geometry>
      <box size="${reach} 0.2 ${max(0.1, $(arg lift))}"/></geometry></collision>
    <collision><geometry><cylinder radius="${reach/4}" length="$(arg lift)"/></geometry></collision>
    <collision><geometry><sphere radius="${short/5}"/></geometry></collision>
    <collision><geometry><mesh filename="none.stl"/></geometry></collision>
  </link>
  <xacro:plain name="mast" com="0 0 ${lean}"/>
  <xacro:plain name="head" mass="2"/>
  <xacro:plain name="arm" com="${short} 0 0"/>
  <xacro:plain name="hand"/>
  <xacro:plain name="fore"/>
  <xacro:plain name="slider" mass="1"/>
  <xacro:plain name="spun" mass="3"/>
  <xacro:plain name="wheel" mass="3"/>
  <xacro:plain name="stuck" mass="1.5"/>
  <joint name="fix1" type="fixed"><parent link="base"/><child link="mast"/>
    <origin xyz="0.1 ${reach} 0" rpy="${lean} ${-lean/2} ${atan2(reach, 2)}"/></joint>
  <joint name="fix2" type="fixed"><parent link="mast"/><child link="head"/>
    <origin xyz="0 0 ${short}" rpy="0.1 0 ${lean}"/></joint>
  <xacro:joint name="swing" parent="head" child="arm" xyz="${pair} 0" rpy="0 0 ${lean}" axis="1 ${lean} 0">
    <limit lower="${-$(arg stop)}" upper="$(arg stop)" effort="${10*reach}" velocity="1"/></xacro:joint>
  <xacro:joint name="follow" parent="base" child="fore" xyz="-$(arg reach) 0 0" axis="0 1 0">
    <limit lower="-1" upper="${radians(50) + lean}" effort="1" velocity="1"/></xacro:joint>
  <joint name="fix3" type="fixed"><parent link="arm"/><child link="hand"/>
    <origin xyz="0 0 -0.3" rpy="0 ${lean} 0"/></joint>
  <xacro:joint name="slide" kind="prismatic" parent="hand" child="slider" xyz="0 ${short} 0" axis="0 0 -1">
    <limit lower="-0.1" upper="${0.1 + $(arg lift)}" effort="1" velocity="1"/></xacro:joint>
  <joint name="spin" type="fixed"><parent link="slider"/><child link="spun"/>
    <origin xyz="0 0 ${-reach}" rpy="${lean} 0 0"/></joint>
  <xacro:joint name="roll" kind="continuous" parent="spun" child="wheel" xyz="0 ${lean} 0" rpy="0 0 ${lean}">
    <limit effort="1" velocity="1"/></xacro:joint>
  <xacro:joint name="lock" parent="base" child="stuck" xyz="0 0 ${reach}" rpy="${lean} 0 0" axis="1 1 0">
    <limit lower="${lean}" upper="${lean}" effort="1" velocity="1"/></xacro:joint>
  <xacro:if value="${reach &gt; 0.45}">
    <link name="tail"><inertial><mass value="${reach}"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="fix4" type="fixed"><parent link="base"/><child link="tail"/></joint>
  </xacro:if>
  <ros2_control name="c" type="system"><joint name="follow"><param name="mimic">swing</param>
    <param name="multiplier">${-$(arg gear)}</param><param name="offset">${lean/10}</param></joint>
  </ros2_control>
</robot>
"""

SIDECAR = """
schema: 1
up: [0.1, 0.2, 1]
free: {spin: {type: revolute, axis: [0, 1, 0.5], limits: [-0.5, 0.5]}}
inertials: {hand: {mass: 2.5, com: [0.1, 0.2, 0]}}
wheels:
  - {name: w, frame: wheel, radius: 0.1, width: 0.05}
  - {name: v, frame: stuck, center: [0, 0, -0.1], axis: [0, 1, 0], radius: 0.1, width: 0.05}
contacts: [{name: f, frame: fix3, center: [0, 0.1, 0], radius: 0.03}]
belly: [{frame: head, point: [0, 0, -0.4]}, {frame: slider, point: [0.1, 0, 0]}]
springs:
  - {name: s, frames: [{link: mast, xyz: [0, 0, 0.1], rpy: [0.1, 0, 0]}, fore], stiffness: 100, length_max: 3}
loops:
  - {name: a, frames: [hand, fore], type: weld, at: zero}
  - {name: b, frames: [slider, base], type: distance, at: zero}
  - {name: c, frames: [{link: arm, rpy: [0, 0.2, 0]}, fore], type: hinge, axis: [0, 1, 0]}
couplings: [{name: k, joints: {slide: 2, spin: -1, lock: 3}, offset: 0.1}]
postures: {home: {swing: 0.25}}
parameters:
  reach: {default: 0.6, bounds: [0.3, 0.9]}
  lift: {default: 0.2, bounds: [0.05, 0.4]}
  heavy: {default: 12, bounds: [1, 30]}
  gear: {default: 0.5, bounds: [-1, 1]}
  stop: {default: 0.4, bounds: [0.1, 0.8]}
  lean: {default: 0.3, bounds: [0.1, 0.5]}
"""

STATED = """
schema: 1
up: [0.1, 0.2, 1]
free: {spin: {type: revolute, axis: [0, "${5 * size}", 0.5], limits: ["${-stop - 0.1}", "${0.5 + size}"]}}
inertials:
  hand: {mass: "${heavy / 5}", com: ["${size}", 0.2, "${-lean}"], inertia: ["${size}", 1, 1, 0, 0, 0]}
wheels:
  - {name: w, frame: wheel, radius: "${size}", width: "${size / 3}", friction: "${lift + 0.5}"}
  - {name: v, frame: stuck, center: [0, "${lift}", "${-size}"], axis: ["${lean}", 1, 0],
     radius: "${size + 0.02}", width: 0.05, tread: "${0.01 if size > 0.02 and not lean > 1 else 0.03}"}
contacts:
  - {name: f, frame: fix3, center: [0, "${size * cos(pi / 3)}", 0], radius: "${round(lift / 7, 3)}",
     friction: "${gear**2}"}
belly: [{frame: head, point: [0, 0, "${-reach}"]}, {frame: slider, point: [0.1, 0, 0]}]
springs:
  - {name: s, frames: [{link: mast, xyz: [0, "${size}", 0.1], rpy: [0.1, "${lean}", 0]}, fore],
     stiffness: "${1000 * size}", preload: "${heavy}", length_max: "${3 + size}"}
  - {name: t, joint: swing, stiffness: "${hypot(heavy, 3)}", rest: "${-lean}", preload: "${gear}"}
loops:
  - {name: a, frames: [{link: hand, xyz: [0, 0, "${size}"]}, fore], type: weld, at: zero}
  - {name: b, frames: [slider, base], type: distance, length: "${max(size, lift)}"}
  - {name: c, frames: [{link: arm, rpy: [0, "${lean}", "${size}"]}, fore], type: hinge,
     axis: [0, 1, "${size}"]}
  - {name: d, frame: {link: mast, rpy: ["${lean}", 0, 0]}, type: level, axis: ["${size}", 1, 0]}
couplings:
  - {name: k, joints: {slide: "${2 + size}", spin: -1, lock: "${heavy}"}, offset: "${math.sin(lean)}"}
tracks:
  - {name: belt, wheels: [v,
      {frame: stuck, center: ["${-reach}", 0.3, "${lift}"], axis: ["${2 * lean}", 2, 0], radius: "${size}"},
      {frame: lock, center: [0, 0, "${2 + lift}"], axis: ["${lean}", 1, 0], radius: 0.1, side: outside}],
     length: "${4 + lift}"}
postures: {home: {swing: 0.25}}
parameters:
  reach: {default: 0.6, bounds: [0.3, 0.9]}
  lift: {default: 0.2, bounds: [0.05, 0.4]}
  heavy: {default: 12, bounds: [1, 30]}
  gear: {default: 0.5, bounds: [-1, 1]}
  stop: {default: 0.4, bounds: [0.1, 0.8]}
  lean: {default: 0.3, bounds: [0.1, 0.5]}
  size: {default: 0.1, bounds: [0.05, 0.2]}
"""


def kit(folder, xacro=XACRO, sidecar=SIDECAR):
    path = folder / "kit.urdf.xacro"
    path.write_text(xacro)
    (folder / "rover.yaml").write_text(sidecar)
    return rp.load(path)


@pytest.fixture(params=["rocker_bogie", "hit_mrii", "kit", "stated"])
def rover(request, tmp_path):
    if request.param == "stated":
        return kit(tmp_path, sidecar=STATED)
    if request.param == "kit":
        return kit(tmp_path).with_payload([(3.0, (0.1, 0.2, 0.3))])
    return rp.load(request.param)


def within_bounds(rover, n, seed=0):
    rng = np.random.default_rng(seed)
    declared = yaml.safe_load(rover.recipe.sidecar_text)["parameters"]
    return {name: rng.uniform(*declared[name]["bounds"], n) for name in rover.parameters}


def test_the_nominal_design_is_the_rover(rover):
    designs = Designs(rover, list(rover.parameters))
    assert designs.refusal == ""
    made = designs.machines({name: [value] for name, value in rover.parameters.items()})
    assert made.valid.all()
    assert difference(made.machine, machine_of(rover), 2e-15) == ""


def test_designs_are_the_loaders(rover):
    designs = Designs(rover, list(rover.parameters))
    values = within_bounds(rover, 20)
    made = designs.machines(values)
    assert made.valid.any()
    for i in range(20):
        given = {name: array[i] for name, array in values.items()}
        one = pick(made.machine, slice(i, i + 1))
        if made.valid[i]:
            assert difference(one, machine_of(rover.with_parameters(**given)), 1e-12) == ""
        else:
            assert np.isnan(one.masses).all()


def test_which_designs_of_the_kit_are_left_to_the_loader(tmp_path):
    rover = kit(tmp_path)
    designs = Designs(rover, list(rover.parameters))
    values = within_bounds(rover, 200, seed=1)
    valid = designs.machines(values).valid
    # the link under the condition, and the posture's joint within its limits
    np.testing.assert_array_equal(valid, (values["reach"] > 0.45) & (values["stop"] >= 0.25 - 1e-9))


def test_a_design_is_the_same_whatever_is_beside_it(rover):
    designs = Designs(rover, list(rover.parameters))
    values = within_bounds(rover, 37, seed=2)
    whole = designs.machines(values)
    for which in ([5], [30, 3, 11], list(range(36, -1, -1))):
        part = designs.machines({name: array[which] for name, array in values.items()})
        for array, other in zip(part.machine, pick(whole.machine, np.array(which)), strict=True):
            assert array.tobytes() == other.tobytes()


def test_one_parameter_varies_and_the_others_stay(rover):
    name = next(iter(rover.parameters))
    changed = rover.with_parameters(
        **{list(rover.parameters)[-1]: within_bounds(rover, 1)[list(rover.parameters)[-1]][0]}
    )
    designs = Designs(changed, [name])
    value = within_bounds(rover, 3, seed=4)[name].max()
    made = designs.machines({name: [value]})
    assert difference(made.machine, machine_of(changed.with_parameters(**{name: value})), 1e-12) == ""


def test_values_that_the_loader_refuses_are_left_to_it(tmp_path):
    rover = kit(tmp_path)
    designs = Designs(rover, ["reach", "lift"])
    made = designs.machines({"reach": [0.6, 5.0, np.nan, 0.6], "lift": [0.2, 0.2, 0.2, -1.0]})
    assert made.valid.tolist() == [True, False, False, False]
    assert np.isnan(made.machine.masses[1:]).all()


def small(folder, mass="1", upper="0.5", axis="0 1 0", effort="1", offset="0 0 0", extra="", sidecar=""):
    inertia = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    text = f"""<robot name="small" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:arg name="b" default="0.1"/><xacro:property name="b" value="$(arg b)"/>
      <link name="base"><inertial><mass value="1"/>{inertia}</inertial></link>
      <link name="arm"><inertial><mass value="{mass}"/>{inertia}</inertial></link>
      <link name="rim"><inertial><mass value="1"/>{inertia}</inertial></link>
      <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="{axis}"/>
        <limit lower="-0.5" upper="{upper}" effort="{effort}" velocity="1"/>{extra}</joint>
      <joint name="r" type="fixed"><parent link="arm"/><child link="rim"/><origin xyz="{offset}"/></joint>
    </robot>"""
    return kit(folder, text, f"schema: 1\nparameters: {{b: {{default: 0.1}}}}\n{sidecar}")


WRONG = {
    "a negative mass": ({"mass": "${1 - b}"}, 2.0, "negative mass"),
    "an overflow": ({"mass": "${b**200 * 1e140}"}, 100.5, "out of range"),
    "a root of less than nothing": ({"mass": "${sqrt(1 - b)}"}, 2.0, "math domain error"),
    "a division by zero": ({"mass": "${1 / (1 - b)}"}, 1.0, "division by zero"),
    "limits upside down": ({"upper": "${0.5 - b}"}, 2.0, "lower limit above the upper"),
    "a zero axis": ({"axis": "0 ${1 - b} 0"}, 1.0, "a zero axis"),
    "a negative effort": ({"effort": "${1 - b}"}, 2.0, "negative effort limit"),
    "two signs": ({"offset": "0 -${1 - b} 0"}, 2.0, "is not a number"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_design_that_is_no_rover_is_left_to_the_loader(tmp_path, case):
    changes, value, message = WRONG[case]
    rover = small(tmp_path, **changes)
    designs = Designs(rover, ["b"])
    assert designs.refusal == ""
    assert designs.machines({"b": [0.1, value, 0.2]}).valid.tolist() == [True, False, True]
    with pytest.raises(InputError, match=message):
        rover.with_parameters(b=value)


def test_a_wheel_that_leaves_its_joints_axis_is_left_to_the_loader(tmp_path):
    wheels = "wheels: [{name: w, frame: rim, axis: [0, 1, 0], radius: 0.1, width: 0.1}]\n"
    rover = small(tmp_path, offset="${b - 0.1} 0 0", sidecar=wheels)
    assert rover.wheels[0].drive == "j"
    made = Designs(rover, ["b"]).machines({"b": [0.1, 0.3]})
    assert made.valid.tolist() == [True, False]
    assert rover.with_parameters(b=0.3).wheels[0].drive is None


def test_limits_that_lock_in_some_designs_only(tmp_path):
    rover = small(tmp_path, upper="${b - 0.6}")
    assert rover.joints == ()  # locked as loaded
    made = Designs(rover, ["b"]).machines({"b": [0.1, 0.3]})
    assert made.valid.tolist() == [True, False]


REFUSED = {
    "a name": (
        {"extra": '<foo bar="${b}"/>'},
        "joint j: <foo> bar: a parameter stands where no number is read",
    ),
    "a pieced number": (
        {"mass": "1${b}"},
        "link arm: a number is put together from pieces of text (got '1[b]')",
    ),
    "a text": (
        {"extra": "<foo>${b}</foo>"},
        "joint j: <foo> text: a parameter stands where no number is read",
    ),
    "a lost trace": (
        {"mass": "${[1, 2][int(10*b)]}"},
        "a number that depends on b is used as an index or a count in",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_followed_is_a_refusal(tmp_path, case):
    changes, reason = REFUSED[case]
    designs = Designs(small(tmp_path, **changes), ["b"])
    assert reason in designs.refusal
    with pytest.raises(UntraceableError) as caught:
        designs.machines({"b": [0.1]})
    assert reason in str(caught.value)


TWINS = {  # each says of the nominal mimic what it says itself: follow = 0.03 - 0.5 swing
    "a twin": "{name: n, joints: {follow: 1, swing: 0.5}, offset: 0.03}",
    "a circle": "{name: n, joints: {follow: 1, spin: 1}}, "
    "{name: m, joints: {spin: 1, swing: -0.5}, offset: -0.03}",
}


@pytest.mark.parametrize("case", TWINS)
def test_a_mimic_that_others_may_contradict_is_a_refusal(tmp_path, case):
    rover = kit(tmp_path, sidecar=SIDECAR.replace("couplings: [", f"couplings: [{TWINS[case]}, "))
    assert (
        "couplings.mimic_follow: depends on a parameter, and other couplings"
        in Designs(rover, ["gear"]).refusal
    )
    assert Designs(rover, ["reach"]).refusal == ""


def test_the_sample_finds_a_file_that_changed(tmp_path):
    rover = small(tmp_path, mass="${1 + b}")
    designs = Designs(rover, ["b"])
    path = rover.source
    path.write_text(path.read_text().replace("${1 + b}", "${2 + b}"))
    with pytest.raises(
        UntraceableError, match=r"the design b 0\.2 is another than the loader's: masses by 1"
    ):
        designs.machines({"b": [0.2, 0.3]})
    assert "masses by 1" in designs.refusal


def test_a_traced_text_serves_without_the_files(tmp_path):
    rover = small(tmp_path, mass="${1 + b}")
    here = Designs(rover, ["b"])
    wanted = here.machines({"b": [0.2, 0.3]})
    traced = pickle.loads(pickle.dumps(here.traced))
    rover.source.unlink()
    there = Designs(rover, ["b"], traced)
    assert there.refusal == ""
    assert difference(there.machines({"b": [0.2, 0.3]}).machine, wanted.machine, 0.0) == ""


def test_bad_values_are_told(tmp_path):
    designs = Designs(small(tmp_path), ["b"])
    with pytest.raises(InputError, match=r"other parameters than those that vary \(got 'c'\); give b"):
        designs.machines({"c": [1.0]})
    with pytest.raises(InputError, match=r"not one list of values per parameter.*b: \(1, 1\)"):
        designs.machines({"b": [[1.0]]})
    assert designs.machines({"b": []}).valid.shape == (0,)
    assert designs.machines({"b": []}).machine.masses.shape[0] == 0
    assert "no parameter varies" in Designs(small(tmp_path), []).refusal
    assert "no parameter of that name" in Designs(small(tmp_path), ["c"]).refusal
