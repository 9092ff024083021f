"""The name of a solver: `FAMILY:METHOD?KEY=VALUE&KEY=VALUE`, or `METHOD?KEY=VALUE` without a family."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction

from taylor_verify.scenes.reading.table import exact_number

# Below the roundoff of every rung, and beyond every span of time.
_LEAST = Fraction(sys.float_info.min)
_LARGEST = Fraction(sys.float_info.max)


@dataclass(frozen=True)
class Options:
    """A method of a family and what was set for it; the place of a fault is its key."""

    method: str
    values: Mapping[str, str]

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def positive(self, key: str, default: str) -> Fraction:
        """Return the positive number of that key, exactly as written; an empty ``default`` is no number.

        Raises ValueError for what is no number, is not positive, or is missing.
        """
        text = self.values.get(key, default)
        if not text:
            raise ValueError(f"expected ?{key}=NUMBER after {self.method}, got none")
        try:
            value = exact_number(text)
        except ValueError as error:
            raise ValueError(f"expected {error}, got {text!r:.60} @ {key}") from None
        if not value > 0:
            raise ValueError(f"expected a positive number, got {text!r:.60} @ {key}")
        if not _LEAST <= value <= _LARGEST:
            expected = "a positive number that a double holds"
            raise ValueError(f"expected {expected}, got {text!r:.60} @ {key}")
        return value

    def word(self, key: str, words: Sequence[str]) -> str:
        """Return the word of that key, the first where it was not set; ValueError for any other word."""
        word = self.values.get(key, words[0])
        if word not in words:
            raise ValueError(f"expected {' or '.join(words)}, got {word!r:.60} @ {key}")
        return word

    def whole(self, key: str, least: int, most: int) -> int:
        """Return the whole number of that key; ValueError for anything else, and outside the limits."""
        number = self.positive(key, default="")
        if number.denominator != 1 or not least <= number <= most:
            expected = f"a whole number from {least} to {most}"
            raise ValueError(f"expected {expected}, got {self.values[key]!r:.60} @ {key}")
        return int(number)


def options(name: str, methods: Iterable[str], keys: Iterable[str]) -> Options:
    """Take a name apart. Raises ValueError for a method or a key that there is not, or twice."""
    word, _, query = name.partition("?")
    method = word.partition(":")[2] if ":" in word else word
    _known(method, methods, "a method")
    values: dict[str, str] = {}
    for part in query.split("&") if query else ():
        key, _, value = part.partition("=")
        _known(key, keys, "a setting")
        if key in values:
            raise ValueError(f"expected each setting once, got {key} twice")
        values[key] = value
    return Options(method, values)


def _known(word: str, words: Iterable[str], what: str) -> None:
    words = tuple(words)
    if word not in words:
        near = get_close_matches(word, words, n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise ValueError(f"expected {what} ({', '.join(words)}), got {word!r}{hint}")
