"""Seconds between epochs in ISO 8601 text, exactly, with the leap seconds of UTC.

Two forms are read: 2024-01-31T12:00:00.5 and 2024-031T12:00:00.5, with or without a Z behind. datetime
rounds to microseconds and knows no second 60, and astropy rounds to a pair of doubles.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from datetime import datetime
from fractions import Fraction
from typing import Final

_EPOCH: Final = re.compile(
    r"(\d{4})-(\d{2}-\d{2}|\d{3})T(\d{2}):(\d{2}):(\d{2}(?:\.\d{0,40})?)Z?", re.ASCII
)
_DAY: Final = 86400
# Days of UTC that had a second 23:59:60, from the bulletins of the IERS; there was none after 2016.
_LEAP_DAYS: Final = tuple(
    datetime.fromisoformat(day).toordinal()
    for day in (
        "1972-06-30",
        "1972-12-31",
        "1973-12-31",
        "1974-12-31",
        "1975-12-31",
        "1976-12-31",
        "1977-12-31",
        "1978-12-31",
        "1979-12-31",
        "1981-06-30",
        "1982-06-30",
        "1983-06-30",
        "1985-06-30",
        "1987-12-31",
        "1989-12-31",
        "1990-12-31",
        "1992-06-30",
        "1993-06-30",
        "1994-06-30",
        "1995-12-31",
        "1997-06-30",
        "1998-12-31",
        "2005-12-31",
        "2008-12-31",
        "2012-06-30",
        "2015-06-30",
        "2016-12-31",
    )
)


def seconds(text: str, is_utc: bool) -> Fraction:
    """Return the seconds from a day of long ago to an epoch.

    Raises ValueError, whose text is what was expected.
    """
    match = _EPOCH.fullmatch(text.strip())
    if match is None:
        raise ValueError("an epoch like 2024-01-31T12:00:00.5")
    year, day, hour, minute, second = match.groups()
    try:
        date = datetime.strptime(f"{year}-{day}", "%Y-%j" if len(day) == 3 else "%Y-%m-%d")
    except ValueError:
        date = None
    # strptime takes day 366 of a common year for the first day of the next one.
    if date is None or date.year != int(year):
        raise ValueError("an epoch on a day of the calendar")
    ordinal = date.toordinal()
    leaps = is_utc and ordinal in _LEAP_DAYS and (hour, minute) == ("23", "59")
    if int(hour) > 23 or int(minute) > 59 or not Fraction(second) < 60 + leaps:
        raise ValueError("an epoch at a time of the day")
    before = bisect_left(_LEAP_DAYS, ordinal) if is_utc else 0
    return ordinal * _DAY + int(hour) * 3600 + int(minute) * 60 + Fraction(second) + before
