"""A formula that changed is never run from an old compilation."""

import os

from rover_pin.kernel_cache import discard_stale


def test_compiled_formulas_older_than_any_source_go(tmp_path):
    cache = tmp_path / "contact" / "__pycache__"
    cache.mkdir(parents=True)
    (tmp_path / "terrain").mkdir()
    changed = tmp_path / "terrain" / "surface.py"
    for path, when in (
        (changed, 200),
        (cache / "old.nbc", 100),
        (cache / "new.nbc", 300),
        (cache / "old.nbi", 100),
    ):
        path.write_text("")
        os.utime(path, (when, when))
    assert discard_stale(tmp_path) == 2
    assert sorted(path.name for path in cache.iterdir()) == ["new.nbc"]


def test_no_cache_is_no_matter(tmp_path):
    assert discard_stale(tmp_path) == 0
