"""Sides of HIT-MRII, and rovers made from its files by changing them."""

import shutil
from pathlib import Path

import rover_pin as rp
from rover_pin.control.layout import Layout, Side

SIDES = Layout(
    Side("left", ("LF", "LM", "LB"), "L_diff", "L_act", "L_bogie"),
    Side("right", ("RF", "RM", "RB"), "R_diff", "R_act", "R_bogie"),
)


def changed(folder, urdf=(), sidecar=()):
    """HIT-MRII's files in a folder, with texts replaced; every text must be there."""
    source = Path(rp.load("hit_mrii").source).parent
    shutil.copytree(source.parent, folder / "urdf", ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    path = folder / "urdf" / "hit_mrii" / "hit_mrii.urdf.xacro"
    for file, words in ((path, urdf), (path.parent / "rover.yaml", sidecar)):
        text = file.read_text()
        for old, new in words:
            assert old in text, old
            text = text.replace(old, new)
        file.write_text(text)
    return rp.load(path)
