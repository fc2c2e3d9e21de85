"""Bytes in a page: named segments, one gzip stream, base64 in blocks that a browser can read back."""

from __future__ import annotations

import base64
import gzip
import json
from dataclasses import dataclass, field
from typing import Any

BLOCK = 48_000_000  # characters; one block over some 536 million would read back empty


@dataclass
class Pack:
    """What a page carries.

    Attributes:
        header: plain values for the page, as JSON.
        segments: named runs of bytes.
    """

    header: dict[str, Any]
    segments: dict[str, bytes] = field(default_factory=dict)

    def scripts(self) -> str:
        """The script elements that hold everything: `#header` in JSON, then `.block` elements in base64."""
        places = [[name, len(data)] for name, data in self.segments.items()]
        body = base64.b64encode(gzip.compress(b"".join(self.segments.values()), 6, mtime=0)).decode("ascii")
        header = json_text({**self.header, "segments": places, "packed": len(body)})
        blocks = [body[i : i + BLOCK] for i in range(0, len(body), BLOCK)]
        return "\n".join(
            [f'<script type="application/json" id="header">{header}</script>']
            + [f'<script type="text/plain" class="block">{block}</script>' for block in blocks]
        )


def json_text(value: Any) -> str:
    """JSON that stands safely inside a script element; a number that is not finite becomes null."""
    text = json.dumps(_plain(value), ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not -float("inf") < value < float("inf"):
        return None
    return value
