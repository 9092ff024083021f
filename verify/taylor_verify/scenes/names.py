"""Names as they may be shown anywhere: a file's name may hold characters that steer a terminal."""

from __future__ import annotations

import re
from typing import Final

# Control characters of both sets but tab and line break, separators of lines, turns of the direction.
_CONTROL: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]"
)


def escaped(text: str) -> str:
    """Return the text with an escape for each character that would steer a terminal."""
    return _CONTROL.sub(lambda match: ascii(match[0])[1:-1], text)
