"""What a result came from: versions, git state, digests."""

from __future__ import annotations

import datetime
import hashlib
import platform
import subprocess
from collections.abc import Iterable, Mapping
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.payload import told

if TYPE_CHECKING:
    from rover_pin.rover import Rover

PACKAGES = {
    "rover_pin": "rover-pin",
    "pin": "pin",
    "proxsuite": "proxsuite",
    "numpy": "numpy",
    "scipy": "scipy",
    "numba": "numba",
}


def made_by() -> dict[str, str]:
    """Attributes of a result: the state of this package, versions of what computes the numbers, the time."""
    commit, state = git_state(Path(__file__).resolve().parent)
    return {
        "rover_pin_git_commit": commit,
        "rover_pin_git_state": state,
        **{f"{name}_version": text for name, text in versions().items()},
        "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
    }


def stands_how(
    rover: Rover,
    posture: str | Mapping[str, float] | None,
    gravity: float,
    joints: Mapping[str, float] | None = None,
    locks: Iterable[str] = (),
) -> dict[str, Any]:
    """Attributes of a result: which rover stood, and how it was held and loaded."""
    return {
        "robot": rover.name,
        "robot_file": str(rover.source),
        "parameters": ", ".join(f"{name}={value!r}" for name, value in rover.parameters.items()),
        "posture": "home" if posture is None else str(posture),
        "joints": ", ".join(f"{name}={value!r}" for name, value in (joints or {}).items()),
        "locks": ", ".join(locks),
        "gravity": float(gravity),
        "payload": told(rover.recipe.payload),
    }


def versions() -> dict[str, str]:
    """Versions of what computes the numbers; empty where a package is not installed as one."""
    found = {name: _version(package) for name, package in PACKAGES.items()}
    return {**found, "python": platform.python_version()}


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""


def git_state(folder: Path) -> tuple[str, str]:
    """Commit of the git tree that `folder` lies in, and `clean` or `dirty`; empty outside of one."""
    commit = _git(folder, "rev-parse", "HEAD")
    if not commit:
        return "", ""
    return commit, "dirty" if _git(folder, "status", "--porcelain") else "clean"


def _git(folder: Path, *words: str) -> str:
    try:
        done = subprocess.run(
            ["git", "-C", str(folder), *words], capture_output=True, text=True, timeout=20, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def digest(text: str | bytes) -> str:
    """Short hex of a text."""
    return hashlib.sha256(text.encode() if isinstance(text, str) else text).hexdigest()[:32]
