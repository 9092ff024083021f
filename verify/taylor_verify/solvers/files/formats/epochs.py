"""Seconds between epochs in text, exactly, with the leap seconds of UTC.

A message has 2024-01-31T12:00:00.5 or 2024-031T12:00:00.5, with or without a Z behind. A log may have a
blank for the T, an offset from UTC, a month by its name (31 Jan 2024 12:00:00.5), or the time of day alone.
datetime rounds to microseconds and knows no second 60, and astropy rounds to a pair of doubles.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from datetime import date
from fractions import Fraction
from functools import lru_cache
from typing import Final

_DAY: Final = 86400
_OF_DAY: Final = r"(?P<hour>\d{1,2}):(?P<minute>\d{2}):(?P<second>\d{2}(?:[.,]\d{0,40})?)"
_EPOCH: Final = re.compile(rf"(?P<date>\d{{4}}-(?:\d{{2}}-\d{{2}}|\d{{3}}))T{_OF_DAY}Z?", re.ASCII)
_ZONE: Final = r"\s*(?:Z|UTC|(?P<sign>[+-])(?P<hours>\d{2}):?(?P<minutes>\d{2}))?"
_DATE: Final = r"\d{4}[-/](?:\d{1,2}[-/]\d{1,2}|\d{3})|\d{1,2} [A-Za-z]{3} \d{4}"
_IN_A_LOG: Final = re.compile(rf"(?:(?P<date>{_DATE})(?:T|\s+))?{_OF_DAY}{_ZONE}", re.ASCII)
_MONTHS: Final = "jan feb mar apr may jun jul aug sep oct nov dec"
# Halves of years whose last day had a second 23:59:60, in bulletins of the IERS; none after 2016.
_LEAP_HALVES: Final = (
    "1972-1 1972-2 1973-2 1974-2 1975-2 1976-2 1977-2 1978-2 1979-2 1981-1 1982-1 1983-1 1985-1 1987-2 "
    "1989-2 1990-2 1992-1 1993-1 1994-1 1995-2 1997-1 1998-2 2005-2 2008-2 2012-1 2015-1 2016-2"
)


def _last_day(half: str) -> int:
    year, which = half.split("-")
    return date(int(year), *((6, 30) if which == "1" else (12, 31))).toordinal()


_LEAP_DAYS: Final = tuple(map(_last_day, _LEAP_HALVES.split()))


def seconds(text: str, is_utc: bool) -> Fraction:
    """Return the seconds from a day of long ago to an epoch of a message.

    Raises ValueError, whose text is what was expected.
    """
    match = _EPOCH.fullmatch(text.strip())
    if match is None:
        raise ValueError("an epoch like 2024-01-31T12:00:00.5")
    return _seconds(match, is_utc)


def is_epoch(text: str) -> bool:
    """Return True for a text in the form of a time of a calendar or of a day."""
    return _IN_A_LOG.fullmatch(text) is not None


def seconds_in_log(text: str) -> Fraction:
    """Return the seconds from a day of long ago, or from midnight, to a time of a log.

    Raises ValueError, whose text is what was expected.
    """
    match = _IN_A_LOG.fullmatch(text.strip())
    if match is None:
        raise ValueError("a time like 2024-01-31T12:00:00.5Z, as in the first row")
    ahead = int(match["hours"] or 0) * 3600 + int(match["minutes"] or 0) * 60
    since = _seconds(match, is_utc=match["date"] is not None)
    return since + ahead if match["sign"] == "-" else since - ahead


def _seconds(match: re.Match[str], is_utc: bool) -> Fraction:
    ordinal = _ordinal(match["date"]) if match["date"] else 0
    hour, minute, second = int(match["hour"]), int(match["minute"]), match["second"]
    leaps = is_utc and ordinal in _LEAP_DAYS and (hour, minute) == (23, 59)
    since_minute = Fraction(second.replace(",", "."))
    if hour > 23 or minute > 59 or not since_minute < 60 + leaps:
        raise ValueError("an epoch at a time of the day")
    before = bisect_left(_LEAP_DAYS, ordinal) if is_utc else 0
    return ordinal * _DAY + hour * 3600 + minute * 60 + since_minute + before


@lru_cache
def _ordinal(text: str) -> int:
    """Return the number of a day: 2024-01-31, 2024-031 or 31 Jan 2024."""
    parts = re.split(r"[-/ ]", text)
    try:
        if len(parts) == 2:
            day = date(int(parts[0]), 1, 1).toordinal() + int(parts[1]) - 1
            if date.fromordinal(day).year != int(parts[0]):
                raise ValueError
            return day
        if parts[1].isalpha():
            parts = [parts[2], str(_MONTHS.split().index(parts[1].lower()) + 1), parts[0]]
        return date(*map(int, parts)).toordinal()
    except (ValueError, OverflowError):
        raise ValueError("an epoch on a day of the calendar") from None
