"""Stand-ins for a rover, a terrain and a stance: just what the pictures read, posed by a small solve."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
from scipy.optimize import least_squares

RADIUS, TREAD = 0.13, 0.05
SIDES = {"l": 1.0, "r": -1.0}


class Hills:
    """Smooth hills with a label; without bounds unless told."""

    label = "hills"
    spacing = 0.05
    digest = "0"

    def __init__(self, height=0.12, extent=(-np.inf, np.inf, -np.inf, np.inf)):
        self.tall, self.extent = height, extent

    def height(self, x, y):
        return self.tall * (
            np.sin(1.3 * np.asarray(x)) * np.cos(1.1 * np.asarray(y)) + 0.3 * np.sin(3.1 * np.asarray(x) + 1)
        )

    def gradient(self, x, y):
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        dx = self.tall * (1.3 * np.cos(1.3 * x) * np.cos(1.1 * y) + 0.93 * np.cos(3.1 * x + 1))
        return np.stack([dx, -self.tall * 1.1 * np.sin(1.3 * x) * np.sin(1.1 * y)], axis=-1)

    def normal(self, x, y):
        slope = self.gradient(x, y)
        n = np.concatenate([-slope, np.ones((*slope.shape[:-1], 1))], axis=-1)
        return n / np.linalg.norm(n, axis=-1, keepdims=True)

    def covers(self, x, y):
        a, b, c, d = self.extent
        return (np.asarray(x) >= a) & (np.asarray(x) <= b) & (np.asarray(y) >= c) & (np.asarray(y) <= d)


def _model():
    model = pin.Model()
    base = pin.JointModelComposite(pin.JointModelTranslation())
    base.addJoint(pin.JointModelSphericalZYX())
    root = model.addJoint(0, base, pin.SE3.Identity(), "base")
    model.appendBodyToJoint(
        root, pin.Inertia(30.0, np.array([0.05, 0, 0.05]), 0.5 * np.eye(3)), pin.SE3.Identity()
    )
    slide = model.addJoint(root, pin.JointModelPZ(), pin.SE3(np.eye(3), np.array([0.2, 0, 0.2])), "mast")
    model.appendBodyToJoint(
        slide, pin.Inertia(1.0, np.array([0, 0, 0.2]), 0.01 * np.eye(3)), pin.SE3.Identity()
    )
    for side, sign in SIDES.items():
        tilt = pin.SE3(pin.rpy.rpyToMatrix(0, 0, 0.02 * sign), np.array([0.05, 0.42 * sign, 0.0]))
        rocker = model.addJoint(root, pin.JointModelRY(), tilt, f"rocker_{side}")
        model.appendBodyToJoint(
            rocker, pin.Inertia(3.0, np.array([0.2, 0, -0.1]), 0.1 * np.eye(3)), pin.SE3.Identity()
        )
        bogie = model.addJoint(
            rocker,
            pin.JointModelRevoluteUnaligned(np.array([0.0, -1.0, 0.0])),
            pin.SE3(np.eye(3), np.array([-0.42, 0.05 * sign, -0.12])),
            f"bogie_{side}",
        )
        model.appendBodyToJoint(
            bogie, pin.Inertia(2.0, np.array([0, 0, -0.1]), 0.1 * np.eye(3)), pin.SE3.Identity()
        )
    return model


def _box(link, joint, xyz, size, rgba):
    placement = np.eye(4)
    placement[:3, 3] = xyz
    return SimpleNamespace(
        link=link, joint=joint, placement=placement, kind="box", size=size, mesh=None, rgba=rgba
    )


def rover():
    """A six-wheeled rover whose wheels have no looks of their own."""
    model = _model()
    ids = {name: model.getJointId(name) for name in model.names}
    visuals = [_box("body", ids["base"], (0.05, 0, 0.12), (0.85, 0.6, 0.28), (0.82, 0.81, 0.77, 1.0))]
    wheels = []
    for side, sign in SIDES.items():
        y = 0.06 * sign
        rocker, bogie = ids[f"rocker_{side}"], ids[f"bogie_{side}"]
        for arm, joint, a, b in (
            ("rocker", rocker, (0, 0, 0), (0.55, 0, -0.22)),
            ("rocker", rocker, (0, 0, 0), (-0.42, 0, -0.12)),
            ("bogie", bogie, (-0.3, 0, -0.1), (0.3, 0, -0.1)),
        ):
            a, b = np.array(a), np.array(b)
            part = _box(
                f"{arm}_{side}",
                joint,
                (a + b) / 2,
                (np.linalg.norm(b - a), 0.05, 0.06),
                (0.45, 0.5, 0.55, 1.0),
            )
            part.placement[:3, :3] = pin.rpy.rpyToMatrix(0, -np.arctan2(b[2] - a[2], b[0] - a[0]), 0)
            visuals.append(part)
        for name, joint, at in (
            (f"f{side}", rocker, (0.55, y, -0.22)),
            (f"m{side}", bogie, (0.3, y, -0.1)),
            (f"b{side}", bogie, (-0.3, y, -0.1)),
        ):
            wheels.append(
                SimpleNamespace(
                    name=name,
                    link=f"wheel_{name}",
                    joint=joint,
                    center=np.array(at),
                    axis=np.array([0.0, 1.0, 0.0]),
                    ring=RADIUS - TREAD,
                    tread=TREAD,
                    radius=RADIUS,
                    friction=0.6,
                    form=0,
                    free=False,
                )
            )
    return SimpleNamespace(
        name="stand-in",
        model=model,
        visuals=tuple(visuals),
        shapes=tuple(wheels),
        wheels=tuple(wheels),
        feet=(),
        springs=(),
        tracks=(),
        wheel_span=1.6,
        mass=float(sum(i.mass for i in model.inertias)),
        notes=(),
        parameters={},
        joints=tuple(str(n) for n in model.names[2:]),
    )


def stance(terrain=None, x=0.4, y=-0.3, yaw=0.5, status="settled"):
    """The stand-in with its six wheels on the ground; loads are made up."""
    terrain, robot = terrain or Hills(), rover()
    model = robot.model
    data = model.createData()
    names = robot.joints

    def q_of(free):
        z, roll, pitch, rocker, left, right = free
        values = dict(zip(names, [0.1, rocker, left, -rocker, right], strict=True))
        return np.array([x, y, z, yaw, pitch, roll, *(values[n] for n in names)]), values

    def touches(free):
        pin.forwardKinematics(model, data, q_of(free)[0])
        rows = []
        for wheel in robot.wheels:
            center = data.oMi[wheel.joint].act(wheel.center)
            axis = data.oMi[wheel.joint].rotation @ wheel.axis
            n = terrain.normal(center[0], center[1])
            down = -(n - (n @ axis) * axis)
            point = center + wheel.ring * down / np.linalg.norm(down) - wheel.tread * n
            rows.append((point, n, point[2] - float(terrain.height(point[0], point[1]))))
        return rows

    found = least_squares(
        lambda f: [row[2] for row in touches(f)], [float(terrain.height(x, y)) + 0.45, 0, 0, 0, 0, 0]
    )
    q, values = q_of(found.x)
    share = np.array([1.0, 0.7, 0.9, 1.25, 0.95, 1.1])
    loads = robot.mass * 9.81 * share / share.sum()
    contacts = tuple(
        SimpleNamespace(
            wheel=w.name,
            joint=w.joint,
            point=p,
            normal=n,
            load=float(load),
            gap=0.0,
            friction=0.6,
            free=False,
        )
        for w, (p, n, _), load in zip(robot.wheels, touches(found.x), loads, strict=True)
    )
    settled = status == "settled"
    return SimpleNamespace(
        rover=robot,
        terrain=terrain,
        status=status,
        settled=settled,
        reason="" if settled else "wheel 'fl' would pull",
        limiting=None,
        position=q[:3],
        rpy=np.array([q[5], q[4], q[3]]),
        joints=values,
        contacts=contacts if settled else (),
        loads={w.name: c.load for w, c in zip(robot.wheels, contacts, strict=True)} if settled else {},
        gaps={},
        com=np.array(pin.centerOfMass(model, data, q)),
        gravity=9.81,
        configuration=q,
        weight=robot.mass * 9.81,
        residuals={"equilibrium": 1e-12, "gap_m": 3e-10},
        redundant=0,
    )


def margin(measure, value, unit, limiting=None, better="high", note=""):
    """A result of a measure."""
    return SimpleNamespace(
        measure=measure, value=value, unit=unit, limiting=limiting, edges={}, better=better, note=note
    )


MARGINS = {
    "polygon": margin("polygon", 0.231, "m", "fl-fr"),
    "tip": margin("tip", 0.61, "rad", "fl-fr"),
    "force_angle": margin("force_angle", 48.0, "N m", "fl-fr"),
    "energy": margin("energy", 0.083, "m", "fl-fr"),
    "zmp": margin("zmp", 0.231, "m", "fl-fr"),
    "loads": margin("loads", 1.32, "-", "mr", "low"),
    "clearance": margin("clearance", -0.012, "m", "body", note="the belly touches"),
    "friction": margin("friction", 0.31, "-", "bl", "low"),
    "torque": margin("torque", 6.2, "N m", "drive_bl", "low"),
}


def dataset(n=40, seed=3, extent=4.0):
    """A study's dataset over the hills with the words a Study writes; margins made up, some cases failed."""
    import xarray as xr

    random = np.random.default_rng(seed)
    ground = Hills(extent=(-extent - 1, extent + 1, -extent - 1, extent + 1))
    x, y, yaw = (
        random.uniform(-extent, extent, n),
        random.uniform(-extent, extent, n),
        random.uniform(-3.1, 3.1, n),
    )
    stances = [stance(ground, *place) for place in zip(x, y, yaw, strict=True)]
    status = np.array(["settled"] * n, dtype=object)
    status[::17], status[5::41] = "tips", "off_map"
    ok = status == "settled"
    slope = np.linalg.norm(ground.gradient(x, y), axis=-1)
    nan = np.where(ok, 1.0, np.nan)
    tip = (0.9 - 1.5 * slope + 0.05 * random.normal(size=n)) * nan
    polygon = (0.4 - 0.9 * slope + 0.02 * random.normal(size=n)) * nan
    clearance = (0.05 + 0.2 * random.normal(size=n)) * nan
    torque = 6 * np.exp(random.normal(size=n)) * nan
    share = random.dirichlet(np.full(6, 40.0), n)
    robot = stances[0].rover
    edges = np.array(["fl-fr", "fl-bl", "bl-br", "br-fr"], dtype=object)
    polygon[ok.nonzero()[0][0]] = -np.inf

    def case(values, units="", **attrs):
        return ("case", values, {"units": units, **attrs})

    each = {
        "status": case(status),
        "reason": case(np.where(ok, "", "bogie_l folds")),
        "x_m": case(x, "m", varied=1),
        "y_m": case(y, "m", varied=1),
        "yaw_rad": case(yaw, "rad", varied=1),
        "z_m": case([s.position[2] for s in stances] * np.where(status == "off_map", np.nan, 1.0), "m"),
        "roll_rad": case([s.rpy[0] for s in stances], "rad"),
        "pitch_rad": case([s.rpy[1] for s in stances], "rad"),
        "load_n": (("case", "wheel"), share * robot.mass * 9.81 * nan[:, None], {"units": "N"}),
        "joint_rad": (
            ("case", "joint"),
            np.array([[s.joints[j] for j in robot.joints] for s in stances]),
            {"units": "rad"},
        ),
        "tip": case(tip, "rad", better="high", long_name="tip angle"),
        "tip_limiting": case(edges[random.integers(0, 4, n)]),
        "polygon": case(polygon, "m", better="high"),
        "polygon_limiting": case(edges[random.integers(0, 4, n)]),
        "clearance": case(clearance, "m", better="high"),
        "clearance_limiting": case(np.full(n, "body", dtype=object)),
        "torque": case(torque, "N m", better="low"),
        "polygon_edge": (("case", "edge"), np.zeros((n, 4)), {"better": "high"}),
        "friction": case(random.uniform(0.3, 0.8, n), "1", varied=1),
    }
    coords = {
        "wheel": [w.name for w in robot.wheels],
        "joint": list(robot.joints),
        "edge": edges,
        "case": np.arange(n),
    }
    about = {
        "title": "Stand-in on hills",
        "seed": np.int64(3),
        "gravity": 9.81,
        "study": "robot: a </script> b\ncases: {n: 40}",
        "created": "2026-11-22T16:00:00+00:00",
        "rover_pin_version": "0.1.0",
    }
    return xr.Dataset(each, coords=coords, attrs=about), robot, ground, stances
