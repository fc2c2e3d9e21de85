"""A window for Meshcat's Visualizer that keeps the commands instead of sending them.

One scene code serves every picture: what it writes is recorded here, and a page, live or saved, replays it.
"""

from __future__ import annotations

import struct
from typing import Any, Protocol


class Command(Protocol):
    """What Meshcat calls a command: `set_object`, `set_transform`, `set_property`, `delete`."""

    def lower(self) -> dict[str, Any]:
        """The command as plain values."""


class Recorder:
    """Stands where Meshcat's ViewerWindow stands; `commands` holds what was written, in order."""

    def __init__(self) -> None:
        self.commands: list[dict[str, Any]] = []

    def send(self, command: Command) -> None:
        """Keep one command."""
        self.commands.append(command.lower())

    def packed(self) -> list[bytes]:
        """Each command in msgpack, as Meshcat's viewer reads it."""
        import umsgpack

        return [umsgpack.packb(command) for command in self.commands]

    def stream(self) -> bytes:
        """All commands in one run of bytes: length (4 bytes, little-endian), msgpack, and so on."""
        return b"".join(struct.pack("<I", len(data)) + data for data in self.packed())


def recording() -> tuple[Any, Recorder]:
    """A Meshcat Visualizer that writes into a Recorder, and that Recorder."""
    from meshcat import Visualizer

    recorder = Recorder()
    return Visualizer(window=recorder), recorder
