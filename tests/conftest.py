import textwrap

import pytest
from hypothesis import settings

import rover_pin as rp

settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile("seeded")  # whatever machine it is, the same cases

UNIT = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'


def link(name, mass=1.0, extra="", com="0 0 0"):
    inertial = (
        "" if mass is None else f'<inertial><origin xyz="{com}"/><mass value="{mass}"/>{UNIT}</inertial>'
    )
    return f'<link name="{name}">{inertial}{extra}</link>'


def joint(name, parent, child, kind="revolute", axis="0 1 0", xyz="0 0 0", extra="", limits="-1 1"):
    limit = ""
    if kind in ("revolute", "prismatic") and limits:
        lower, upper = limits.split()
        limit = f'<limit lower="{lower}" upper="{upper}" effort="10" velocity="2"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>{limit}{extra}</joint>'
    )


class Maker:
    """Writes a URDF (and a sidecar) into a fresh folder and loads it."""

    link = staticmethod(link)
    joint = staticmethod(joint)

    def __init__(self, folder):
        self.folder = folder

    def write(self, *parts, sidecar=None, name="bot.urdf"):
        path = self.folder / name
        path.write_text(f'<robot name="bot">{"".join(parts)}</robot>')
        if sidecar is not None:
            (self.folder / "rover.yaml").write_text("schema: 1\n" + textwrap.dedent(sidecar))
        return path

    def load(self, *parts, sidecar=None, **keywords):
        return rp.load(self.write(*parts, sidecar=sidecar), **keywords)

    def refused(self, *parts, sidecar=None, error=rp.errors.InputError, **keywords):
        """The message with which it is refused, without the folder."""
        with pytest.raises(error) as caught:
            self.load(*parts, sidecar=sidecar, **keywords)
        return str(caught.value).replace(f"{self.folder}/", "")

    def pair(self, kind="revolute", **keywords):
        """Two links and a joint j."""
        return [link("base"), link("arm"), joint("j", "base", "arm", kind, **keywords)]


@pytest.fixture
def make(tmp_path):
    return Maker(tmp_path)
