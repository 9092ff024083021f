"""Sentences of likely causes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import ceil, log10
from typing import Any, Final

from taylor_verify.records.answers import MissingLoad

_NOTHING: Final = 1e-7
# A clock with a smaller factor stands still; nanoseconds for seconds are 1e-9.
_STILL: Final = 1e-12
# A change below this part of the largest one is none: the entry agrees.
_AGREES: Final = 1e-4
_MOST_DIGITS: Final = 15
# A number is another one if it is off by more than so many of its errors.
_ERRORS: Final = 5.0
# Of a load between rows as many times are listed.
_TIMES: Final = 5
# An entry below this part of the largest one is 0, rounded.
_ROUNDED: Final = 1e-13
# A larger part of an error that is left is not explained.
_UNEXPLAINED: Final = 0.5
# Steps between rows are equal if the longest and the shortest differ by less than this part.
_EQUAL: Final = 1e-6
# A factor so near to a whole number is one.
_WHOLE: Final = 1e-6


def sentence(
    title: str,
    leaves: Mapping[str, float],
    errors: Mapping[str, float],
    alike: Iterable[str] = (),
    changed: str = "",
) -> str:
    """Return a cause as a sentence: what it is, what it leaves of which error, and what is as good.

    ``leaves`` are parts of the largest ``errors``, by quantity; ``changed`` are keys of a scene's [body].
    """
    parts = [title]
    unexplained = [name for name, left in leaves.items() if left > _UNEXPLAINED]
    explained = {name: left for name, left in leaves.items() if left <= _UNEXPLAINED}
    if explained:
        sizes = {name: errors.get(name, 1.0) for name in explained}
        left = (f"{explained[n] * size:.2g} of {size:.2g} of {n}" for n, size in sizes.items())
        parts.append(f"leaves {', '.join(left)}")
    parts += [f"does not explain the error of {', '.join(unexplained)}"] * bool(unexplained)
    others = " | ".join(alike)
    parts += [f"not told apart from: {others}"] * bool(others)
    parts += [f"as a scene: {changed}"] * bool(changed)
    return "; ".join(parts)


def steps_in_words(spans: Sequence[float], count: int) -> str:
    """Return how long steps are, so many from each row to the next, over these spans.

    With a ``count`` of 0 the spans are those of the steps.
    """
    sizes = sorted(abs(span) for span in spans)
    if sizes[-1] - sizes[0] < _EQUAL * sizes[-1]:
        return f"h = {sizes[len(sizes) // 2] / (count or 1):.6g}"
    if not count:
        return f"steps of at most {sizes[-1]:.6g}"
    return f"{'one step' if count == 1 else f'{count} equal steps'} from row to row"


def with_numbers(
    name: str,
    labels: Sequence[str],
    right: Iterable[Any],
    numbers: Iterable[Any],
    errors: Iterable[Any] = (),
) -> str:
    """Return a fault with its numbers; those with ``labels`` are compared with the ``right`` ones.

    What changes by no more than some of its ``errors``, where they are known, agrees.
    """
    values = [float(number) for number in numbers]
    # A number of the scene, which may be called so, has labels.
    is_clock = name == "clock" and not labels
    if is_clock and abs(values[0]) < _STILL:
        return "clock = 0: the motion stands still"
    if is_clock and values[0] > 0:
        return f"clock = {values[0]:.6g}: {_pace(values[0])}"
    if name == "loads late" and values[0] < 0:
        return f"loads early = {-values[0]:.6g}"
    if name.startswith("switch at "):
        return f"{name} comes at t = {values[0]:.6g}"
    if labels and name.startswith("factor of ") and (words := _of_term(values[0])):
        return f"{name.removeprefix('factor of ')} {words}"
    if labels:
        known = [float(error) for error in errors] or [0.0] * len(values)
        changes = _changes(labels, [float(number) for number in right], values, known)
        return changes if [*labels] == [name] else f"{name}: {changes}"
    if not any(values) and any(right):
        return f"{name} left out"
    largest = max(map(abs, values)) or 1.0
    cut = (0.0 if abs(value) < _NOTHING * largest else value for value in values)
    return f"{name} = {' '.join(f'{value:.6g}' for value in cut)}"


def _of_term(factor: float) -> str:
    """Return what a factor makes of a term, in words; empty where no word says it."""
    words = {0: "left out", -1: "with the other sign", 2: "twice"}
    return words.get(round(factor), "") if abs(factor - round(factor)) < _WHOLE else ""


def _pace(clock: float) -> str:
    """Return how fast a motion goes on whose rates have this factor, and what its times count."""
    times, pace = (clock, "fast") if clock > 1 else (1 / clock, "slow")
    number = f"{round(times)}" if abs(times / round(times) - 1) < _WHOLE else f"{times:.6g}"
    counts = f"{number} units" if clock > 1 else f"1/{number} of the unit"
    return f"the motion is {number} times too {pace}, or t counts {counts} of time"


def _changes(
    labels: Sequence[str], right: list[float], values: list[float], errors: list[float]
) -> str:
    """Return the entries that changed, each with its relative change, and how well the others agree."""
    largest = max(map(abs, right)) or 1.0
    right = [0.0 if abs(old) < _ROUNDED * largest else old for old in right]
    parts = [
        abs(value - old) / (abs(old) or largest) for old, value in zip(right, values, strict=True)
    ]
    most = max(parts)
    by_chance = [abs(v - r) <= _ERRORS * e for v, r, e in zip(values, right, errors, strict=True)]
    agrees = [p <= _AGREES * most or c for p, c in zip(parts, by_chance, strict=True)]
    changed = [k for k, same in enumerate(agrees) if not same]
    words = [_change(labels[k], right[k], values[k], errors[k]) for k in changed]
    rest = [part for part, same in zip(parts, agrees, strict=True) if same]
    if rest:
        are_own = "are the scene's" if not any(rest) else f"agree to {max(*rest, 2.0**-52):.0e}"
        words.append(f"the other entries {are_own}")
    return ", ".join(words)


def _change(label: str, old: float, value: float, error: float) -> str:
    known = ceil(log10(abs(value) / error)) if 0 < error < abs(value) else _MOST_DIGITS
    if not old:
        return f"{label} = {value:.{max(1, min(6, known))}g} for 0"
    part = value / old - 1
    digits = min(_MOST_DIGITS, 6 + max(0, ceil(-log10(abs(part)))) if part else 6)
    if abs(value) < max(_NOTHING * abs(old), error):
        return f"{label} = 0 for {old:.6g}"
    shown = max(2, min(digits, known))
    return f"{label} = {value:.{shown}g} for {old:.{digits}g} ({100 * part:+.3g} %)"


def missing_load_line(loads: Sequence[MissingLoad]) -> str:
    """Return the load between rows as a sentence, at a few of its times."""
    is_moment = len(loads[0].load) == 3
    noun, what = ("moment", "omega") if is_moment else ("force and couple", "the velocities")
    few = [loads[k * (len(loads) - 1) // (_TIMES - 1)] for k in range(_TIMES)]
    some = list(dict.fromkeys(few))
    vectors = {each.t: ", ".join(f"{value:.3g}" for value in each.load) for each in some}
    listed = "; ".join(f"t = {t:.6g}: ({vector})" for t, vector in vectors.items())
    return (
        f"no cause is proven; each row of {what} follows from the row before if from "
        f"t = {loads[0].t:.6g} to {loads[-1].until:.6g} a {noun} acts (body axes) that the scene "
        f"does not have: {listed}"
    )
