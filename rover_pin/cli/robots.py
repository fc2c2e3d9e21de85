"""`rover-pin robots`: what is bundled."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from rover_pin.cli.options import Json

if TYPE_CHECKING:
    from rover_pin.description.catalogue import Entry


def _examples() -> list[Entry]:
    """Robots of example-robot-data that are installed."""
    from rover_pin.description.catalogue import Entry
    from rover_pin.description.examples import EXAMPLES, PREFIX, description_of
    from rover_pin.errors import DescriptionError

    found = []
    for each in EXAMPLES:
        with contextlib.suppress(DescriptionError):
            found.append(Entry(PREFIX + each.name, description_of(each.name), each.summary))
    return found


def robots(json: Json = False) -> None:
    """What is bundled."""
    from rover_pin.cli.output import new_table, print_json, print_table
    from rover_pin.description.catalogue import robots as catalogue

    entries = [*catalogue(), *_examples()]
    if json:
        print_json([{"name": each.name, "summary": each.summary, "path": str(each.path)} for each in entries])
        return
    table = new_table("", "robot", "what it is", left=2)
    for each in entries:
        table.add_row(each.name, each.summary)
    print_table(table)
