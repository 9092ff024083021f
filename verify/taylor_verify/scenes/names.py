"""Names of files as they are shown: characters that would steer a terminal are escaped."""

from __future__ import annotations

import re
from typing import Final

# The C0 and C1 control characters but tab and line feed, separators of lines, and marks that change
# the direction of text.
_CONTROL: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]"
)


def escaped(text: str) -> str:
    """Return the text with an escape for each character that would steer a terminal."""
    return _CONTROL.sub(lambda match: ascii(match[0])[1:-1], text)
