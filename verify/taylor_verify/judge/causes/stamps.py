"""Rows of the right motion at other times than those that are written beside them."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.lateness import (
    at_other_times,
    columns_of,
    part_of,
    true_states,
)
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import CAPS

_ROUNDS: Final = 5
_MOST_ROWS: Final = 6.0
_ROUNDINGS: Final = 10.0
# A file that is a whole number of rows ahead is so much nearer to the truth of those rows.
_NEARER: Final = 0.1
# What other times leave of the error, at most, and where there is no rounding to reach.
_LEAVES: Final = 1e-2
_NEAR: Final = 1e-5
_PATTERN: Final = 1e-3
# Stamps that are a running sum in float32 may leave this, as no number is fitted; of rows at such times the
# rounding may hide so much.
_LEFT_BY_SUMS: Final = CAPS[0]
_BLUR: Final = 0.03
# Offsets are in proportion to time, or steps are equal, to these parts of the largest offset.
_STRAIGHT: Final = 1e-2
_EQUAL: Final = 0.1
# Rows are off the motion if most of their error is across it, where a small part of a row would explain the
# rest. So many rows tell it, whose error is so many roundings.
_ACROSS: Final = 0.5
_SHORT: Final = 0.1
_CLEAR: Final = 30.0
_FEWEST: Final = 6
# Rates in a second direction so much smaller than those in the first leave the motion on a line.
_ON_A_LINE: Final = 1e-6
# Times of a file may be rounded to so many decimals.
_MOST_DECIMALS: Final = 6
_SUMS: Final = "times are a running sum in float32"
_SCATTER: Final = "times scatter"
_DRIFTS: Final = "the clock drifts"
_PACE: Final = "the pace changes smoothly"
# Offsets of a smooth pace bend by no more than this part from row to row.
_SMOOTH: Final = 0.05


def other_times(answer: Answer) -> Cause | None:
    """Return the cause of rows that are exact at other times; the factor of a clock is another question."""
    if answer.has_states:
        return None
    late, left, pace, is_line = _offsets(answer)
    units = _units(answer)
    largest = max(worst / units.get(name, 1.0) for name, worst in answer.worst.items())
    noise = _noise(answer)
    remains = float(np.max(left))
    is_rounding = remains <= max(_ROUNDINGS * noise, _NEAR * largest)
    if not (is_rounding and remains < _LEFT_BY_SUMS * largest):
        return None
    words = _pattern(answer, late, _ROUNDINGS * noise / max(pace, 1e-300))
    if words != _SUMS and not remains < _LEAVES * largest:
        return None
    is_telling = (answer.n == 6 or answer.file.q is not None) and not is_line
    of_rows = (_SCATTER, _DRIFTS, _PACE)
    if words is None or not answer.failed or (words.startswith(of_rows) and not is_telling):
        return None  # one number for each row explains much of three, and all of a motion on a line
    worst = answer.worst
    leaves = {name: remains * units.get(name, 1.0) / worst[name] for name in answer.failed}
    return Cause(words, "stamps", leaves)


def _units(answer: Answer) -> dict[str, float]:
    """Return the units of errors that are no part of the motion's size."""
    return {"attitude": 2.0, "centre": answer.reach}


def _noise(answer: Answer) -> float:
    """Return the rounding of the rows, as a part of the motion's size."""
    return max(answer.roundings[name] / _units(answer).get(name, 1.0) for name in answer.worst)


def _are_off(apart: Floats, along: Floats, is_short: Floats, noise: float) -> bool:
    """Return True if rows that are near to the motion are beside it, at whatever time."""
    size = np.linalg.norm(apart, axis=0)
    tell = is_short & (size > _CLEAR * noise)
    across = np.linalg.norm(apart - along, axis=0)[tell] / size[tell]
    return len(across) >= _FEWEST and bool(np.median(across) > _ACROSS)


def _offsets(answer: Answer) -> tuple[Floats, Floats, float, bool]:
    """Return for each row the time from its stamp to that at which it is exact, and what is left there.

    With the median of the rates of the compared states, in their sizes; True if these move on a line, on
    which every state is one of another time.
    """
    right, parts = answer.right, {name: part_of(answer, name) for name in answer.error}
    z = true_states(answer, max(part.stop for part, _ in parts.values()))
    rows = np.vstack([columns_of(answer, name, z) for name in parts])
    compared = np.concatenate([np.r_[part] for part, _ in parts.values()])
    sizes = [np.full((part.stop - part.start, 1), size) for part, size in parts.values()]
    scale, spacing = np.concatenate(sizes), answer.spacing
    late = np.full(answer.count, spacing * _whole_rows(rows / scale, z[0, compared] / scale))
    at, noise = at_other_times(answer, z, late) if late.any() else z, _noise(answer)
    for _ in range(_ROUNDS):
        slopes = right.rates(answer.times + late, at)[0, compared] / scale
        apart = (rows - at[0, compared]) / scale
        square = np.sum(slopes**2, axis=0)
        step = np.sum(slopes * apart, axis=0) / np.where(square > 0, square, np.inf)
        if _are_off(apart, step * slopes, np.abs(step) < _SHORT * spacing, noise):
            break
        late = np.clip(
            late + np.clip(step, -2 * spacing, 2 * spacing),
            -_MOST_ROWS * spacing,
            _MOST_ROWS * spacing,
        )
        at = at_other_times(answer, z, late)
    paces = np.linalg.svd(slopes, compute_uv=False)
    is_line = len(paces) < 2 or bool(paces[1] < _ON_A_LINE * paces[0])
    left = np.linalg.norm((rows - at[0, compared]) / scale, axis=0)
    return late, left, float(np.sqrt(np.median(square))), is_line


def _whole_rows(rows: Floats, true: Floats) -> int:
    """Return the number of rows by which a file is ahead, where it is clearly nearer to the truth so."""
    count = rows.shape[1]

    def apart(ahead: int) -> float:
        first, last = max(0, -ahead), min(count, count - ahead)
        off = rows[:, first:last] - true[:, first + ahead : last + ahead]
        return float(np.median(np.linalg.norm(off, axis=0)))

    most = min(int(_MOST_ROWS), count // 2)
    nearest = min(range(-most, most + 1), key=lambda ahead: (apart(ahead), abs(ahead)))
    return nearest if apart(nearest) < _NEARER * apart(0) else 0


def _pattern(answer: Answer, late: Floats, unsure: float) -> str | None:
    """Return the pattern of the offsets in words; None for a factor, which the equations explain.

    The offsets are known to so much, by the rounding of the rows.
    """
    times, size = answer.times, float(np.max(np.abs(late)))
    spacing = float(np.median(np.diff(times)))
    if not size > 0:
        return None
    mean = float(np.mean(late[1:]))
    if np.ptp(late[1:]) < _PATTERN * size:
        rows = mean / spacing * answer.stride
        if abs(rows - round(rows)) < _PATTERN and round(rows):
            return f"rows shifted: row k holds the state of row k{round(rows):+d}"
        return f"the clock is {_off(late[1:], size)}"
    return (
        _every_so_many(answer, late, size)
        or _decimals(times, late, size)
        or _single_precision(
            times, times + late, size, min(unsure, _BLUR * size), abs(answer.stride)
        )
        or _whole_steps(times - answer.begins, times + late - answer.begins, size)
        or _factor_or_jumps(answer, late, size, spacing)
    )


def _off(late: Floats, size: float) -> str:
    """Return how a clock goes whose rows are exact so much later than it says."""
    mean = float(np.mean(late))
    if abs(mean) < _PATTERN * size:
        return "in time"
    return f"late by {-mean:.6g}" if mean < 0 else f"early by {mean:.6g}"


def _every_so_many(answer: Answer, late: Floats, size: float) -> str | None:
    """Return the words for times that are wrong at every so many rows, by one number."""
    wrong = np.flatnonzero(np.abs(late) > size / 2)
    apart, others = np.diff(wrong), np.delete(late, wrong)
    if len(apart) < 2 or apart[0] < 2 or np.ptp(apart) or not len(others):
        return None
    if max(np.ptp(late[wrong]), np.max(np.abs(others))) > _PATTERN * size:
        return None
    off, every = float(np.mean(late[wrong])), int(apart[0]) * abs(answer.stride)
    how = "late" if off < 0 else "early"
    return f"of every {every} rows one has a time that is {how} by {abs(off):.6g}; all others are right"


def _decimals(times: Floats, late: Floats, size: float) -> str | None:
    """Return the words for equal steps whose times are rounded; a clock is late in proportion to time."""
    digits = _digits_of(times)
    if (
        digits is None
        or not _are_equal_steps(times + late, _EQUAL * size)
        or _is_line(times, late, size)
    ):
        return None
    unit = 10.0**-digits
    if size <= 0.05 * unit:
        return None
    if size <= 0.51 * unit:
        return f"times are rounded to {digits} decimals; no error is left beyond that"
    if size <= 1.01 * unit and np.min(late) >= -_PATTERN * unit:
        return f"times are cut off after {digits} decimals; no error is left beyond that"
    return None


def _digits_of(times: Floats) -> int | None:
    """Return the number of decimals that the times need; None if they need more than six."""
    for digits in range(_MOST_DECIMALS + 1):
        units = times * 10.0**digits
        if np.max(np.abs(units - np.rint(units))) < _PATTERN:
            return digits
    return None


def _are_equal_steps(exact: Floats, apart: float) -> bool:
    steps = np.linspace(exact[0], exact[-1], len(exact))
    return bool(np.max(np.abs(exact - steps)) <= apart)


def _is_line(times: Floats, late: Floats, size: float) -> bool:
    line = np.polynomial.Polynomial.fit(times, late, 1)
    return bool(np.max(np.abs(late - line(times))) < _STRAIGHT * size)


def _single_precision(
    times: Floats, exact: Floats, size: float, unsure: float, every: int
) -> str | None:
    """Return the words for a running sum, of which these are every so many times, as far as printed."""
    digits = _digits_of(times)
    unit = 0.0 if digits is None else 10.0**-digits
    exactly = max(_PATTERN * size, 0.0 if unit > _EQUAL * size else unit)
    nearly = max(exactly, unsure)
    for equal, summed, (of_steps, of_sums), words in (
        (exact, times, (nearly, exactly), _SUMS),
        (
            times,
            exact,
            (exactly, nearly),
            "the rows are those at a running sum of the step in float32, not at the times",
        ),
    ):
        h = np.float32((equal[-1] - equal[0]) / (every * (len(times) - 1)))
        near = (
            _off_sums(summed, np.nextafter(h, np.float32(way)), every) for way in (h, 0, np.inf)
        )
        if _are_equal_steps(equal, of_steps) and min(near) < of_sums:
            return words
    return None


def _off_sums(summed: Floats, h: np.float32, every: int) -> float:
    """Return how far numbers are from a running sum in float32, of which they are every so many."""
    sums = np.cumsum(np.full(every * (len(summed) - 1), h), dtype=np.float32).astype(float)
    return float(np.max(np.abs(summed[1:] - summed[0] - sums[every - 1 :: every])))


def _whole_steps(times: Floats, exact: Floats, size: float) -> str | None:
    """Return the words for rows that are not interpolated, each exact at a whole number of fixed steps.

    From row to row there are two numbers of steps then, one apart.
    """
    apart = np.diff(exact)
    is_more = apart > (np.min(apart) + np.max(apart)) / 2
    less, more = apart[~is_more], apart[is_more]
    if not len(less) or not len(more) or max(np.ptp(less), np.ptp(more)) > _PATTERN * size:
        return None
    h = float(np.mean(more) - np.mean(less))
    counts = np.concatenate([[0], np.cumsum(np.rint(np.mean(less) / h) + is_more)])
    counts += np.rint(exact[0] / h)
    h = float(exact @ counts / (counts @ counts))
    if np.max(np.abs(exact - h * counts)) > _PATTERN * size:
        return None
    ahead = counts - times / h
    if np.all(np.abs(ahead - np.rint(ahead)) < _PATTERN):
        return None  # rows that are dropped or doubled
    for which, least, most in (("nearest", -0.5, 0.5), ("last", -1.0, 0.0), ("next", 0.0, 1.0)):
        if np.all((ahead > least - _PATTERN) & (ahead < most + _PATTERN)):
            return (
                f"each row holds the state of the {which} whole step of {h:.6g}, none between steps"
            )
    return None


def _factor_or_jumps(answer: Answer, late: Floats, size: float, spacing: float) -> str | None:
    times = answer.times
    if _is_line(times, late, size):
        return None
    jumps = np.flatnonzero(np.abs(np.diff(late)) > 0.2 * size)
    if 0 < len(jumps) <= max(3, len(times) // 50) and answer.stride > 0:
        rows = np.diff(late)[jumps] / spacing * answer.stride
        if np.max(np.abs(rows - np.rint(rows))) < _PATTERN and np.all(np.rint(rows)):
            firsts, off = answer.places[jumps + 1] + 1, np.cumsum(np.rint(rows)).astype(int)
            words = (f"of row k{n:+d} from row {k} on" for k, n in zip(firsts, off, strict=True))
            return f"rows dropped or doubled: row k holds the state {', '.join(words)}"
        pieces = np.split(late, jumps + 1)
        if max(map(np.ptp, pieces)) < _PATTERN * size:
            begins = times[jumps + 1] + answer.right.start
            steps = (
                f"{_off(piece, size)} from t = {begin:.6g} on"
                for piece, begin in zip(pieces[1:], begins, strict=True)
            )
            return f"the clock is {_off(pieces[0], size)}, and {', '.join(steps)}"
    since = times - answer.begins
    powers = np.stack([since, since**2], axis=1)
    rate, bend = np.linalg.lstsq(powers, late, rcond=None)[0]
    if np.max(np.abs(powers @ (rate, bend) - late)) < _PATTERN * size:
        law = f"{'' if abs(rate) < _PATTERN * abs(bend) else f' {rate:+.6g} t'} {bend:+.6g} t^2"
        return f"{_DRIFTS}: the row of the time t since the start holds the motion at t{law}"
    is_smooth = np.max(np.abs(np.diff(late, 2)), initial=0.0) < _SMOOTH * size
    return f"{_PACE if is_smooth else _SCATTER}: each row is exact at another time, at most {size:.3g} away"
