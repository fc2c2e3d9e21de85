"""From the parts on disk to the result: the form worked out from what they have in common, then written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import xarray as xr

from rover_pin.analysis.dataset import attributes, opened
from rover_pin.analysis.disk import check_room, result_bytes
from rover_pin.analysis.found import found_in
from rover_pin.analysis.netcdf import BLOCK, write
from rover_pin.analysis.parts import Parts
from rover_pin.analysis.rows import count_of
from rover_pin.analysis.schema import Block, schema
from rover_pin.analysis.trial import Trial

if TYPE_CHECKING:
    from rover_pin.analysis.study import Study


def check_disk(study: Study, parts: Parts, tried: Trial) -> None:
    """Refuse a study whose parts and result do not fit on the disk.

    Raises:
        StudyError: so it is, with the figures.
    """
    job = study.plan.job
    count = len(job.cases)
    block = Block(job.cases.drawer().run(0, count_of(tried.columns)), tried.columns)
    each = result_bytes(schema(job.layout, block.cases, found_in(tried.columns)), block)
    to_come = count - parts.found.cases
    check_room(parts.out.parent, to_come * tried.part_bytes + count * each, count)


def save_result(study: Study, parts: Parts) -> xr.Dataset:
    """The result, moved to its place when it is whole, and opened lazily.

    Raises:
        StudyError: the disk is full, or a part cannot be read; the parts are kept.
    """
    job = study.plan.job
    drawer = job.cases.drawer()
    form = schema(job.layout, drawer.run(0, 1), parts.found)

    def blocks() -> Iterator[Block]:
        start = 0
        for columns in parts.blocks(BLOCK):
            stop = start + count_of(columns)
            yield Block(drawer.run(start, stop), columns)
            start = stop

    about = attributes(study, parts.found)
    parts.finish(lambda path: write(path, form, blocks(), len(job.cases), about))
    return opened(parts.out)
