"""`rover-pin bench`: how many cases a second this machine answers, beside the peers that are installed."""

from __future__ import annotations

from typing import Annotated

import typer

from rover_pin.cli.options import Json


def bench(
    quick: Annotated[bool, typer.Option("--quick", help="Under a minute: fewer cases, no growth.")] = False,
    json: Json = False,
) -> int:
    """Measure the compiled path, the plain path and the peers that are installed, answers compared."""
    import sys

    from rover_pin.analysis.benchmarks import bench as measure
    from rover_pin.cli.bench_report import print_bench
    from rover_pin.cli.output import announce_compilation, aside, print_json

    announce_compilation(batch=True)
    report = measure(quick=quick, progress=aside if sys.stderr.isatty() else None)
    if json:
        print_json([row.as_object() for row in report.rows])
        for why in report.left_out:
            aside(f"left out: {why}")
    else:
        print_bench(report)
    return 0
