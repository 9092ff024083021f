"""SHA-256 of stored verdicts: of a file's bytes, and of a printed document's content.

A document that `run --json` printed may have been laid out anew since, by `jq` for one. Its sum is that of
its content, in which the order of keys and the spelling of a number do not matter.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any, Final

KEY: Final = "sha256"


def line(content: bytes, named: str) -> str:
    """Return the line that `sha256sum --check` reads, with the name of the file from its own place."""
    return f"{hashlib.sha256(content).hexdigest()}  {named}\n"


def with_sum(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a JSON document with the sum of its content, in place of an earlier one."""
    content = {key: value for key, value in document.items() if key != KEY}
    return {**content, KEY: _of(json.dumps(content))}


def is_edited(text: bytes) -> bool | None:
    """Return True for a document whose content is not that of its sum; None for one without a sum.

    The text is a JSON object. Raises ValueError for what is not JSON.
    """
    content = json.loads(text, parse_int=float)
    stated = content.pop(KEY, None)
    return None if stated is None else stated != _of(json.dumps(content))


def _of(text: str) -> str:
    content = json.dumps(json.loads(text, parse_int=float), sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()
