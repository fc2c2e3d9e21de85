"""`rover-pin robots`: what is bundled."""

from __future__ import annotations

from rover_pin.cli.options import Json


def robots(json: Json = False) -> None:
    """What is bundled."""
    from rover_pin.cli.output import new_table, print_json, print_table
    from rover_pin.description.catalogue import robots as catalogue

    entries = catalogue()
    if json:
        print_json([{"name": each.name, "summary": each.summary, "path": str(each.path)} for each in entries])
        return
    table = new_table("", "robot", "what it is", left=2)
    for each in entries:
        table.add_row(each.name, each.summary)
    print_table(table)
