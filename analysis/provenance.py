"""What a result came from: versions, git state, digests."""

from __future__ import annotations

import hashlib
import platform
import subprocess
from importlib import metadata
from pathlib import Path

PACKAGES = {
    "rover_pin": "rover-pin",
    "pin": "pin",
    "proxsuite": "proxsuite",
    "numpy": "numpy",
    "scipy": "scipy",
    "numba": "numba",
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
