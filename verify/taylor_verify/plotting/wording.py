"""Words of pictures: names of files, and numbers in plain text."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import log10
from typing import Any, Final

_RAISED: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def stem_of(document: Mapping[str, Any], what: str) -> str:
    """Return a file's name without its ending: ``euler-generic-time``."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", f"{document['scene']}-{what}").strip("-.")


def plain(error: float) -> str:
    """Return a number in two digits: 0.0034, 2.6e-14."""
    return f"{error:.2g}"


def times(ratio: float) -> str:
    """Return a ratio in three digits, as a multiple: 1.00 times, 12.3 times, 0.520 times."""
    return f"{float(f'{ratio:.2e}'):#.3g}".rstrip(".") + " \N{MULTIPLICATION SIGN}"


def power_of_ten(value: float) -> str:
    """Return a power of ten in plain text with a raised exponent, which readers of SVG can search."""
    return "10" + str(round(log10(value))).translate(_RAISED)
