"""Verdicts shown to a Python caller: in words, as a table of pandas, as HTML for a notebook."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.records.verdict import Verdict, summary

if TYPE_CHECKING:
    import pandas


def counts(verdicts: Iterable[Verdict]) -> str:
    """Return the number of verdicts of each status that occurs, in words."""
    words = ", ".join(f"{count} {word}" for word, count in summary(verdicts).items() if count)
    return words or "no verdicts"


def dataframe(rows: Iterable[Mapping[str, Any]]) -> pandas.DataFrame:
    """Return a pandas.DataFrame with a row for each of some rows.

    Raises ModuleNotFoundError without pandas, with the command that installs it.
    """
    try:
        import pandas
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "expected pandas for to_dataframe, got none (pip install pandas)", name=error.name
        ) from error
    return pandas.DataFrame([dict(row) for row in rows])


def html_table(
    title: str,
    headings: Sequence[str],
    rows: Iterable[Sequence[str]],
    sentences: Iterable[str] = (),
) -> str:
    """Return a paragraph, a list of sentences and a table; every text is escaped."""
    points = "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences)
    listed = f"<ul>{points}</ul>" if points else ""
    head = "".join(f"<th>{escape(heading)}</th>" for heading in headings)
    lines = ("".join(f"<td>{escape(cell)}</td>" for cell in row) for row in rows)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    shown = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f"<p>{escape(title)}</p>{listed}{shown}"


_MOST_POINTS: Final = 500
_COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "currentColor")
# A start that is exact but for its last rounding takes no more of a logarithmic axis than this.
_MOST_DECADES: Final = 12


def picture(
    times: Sequence[Any], curves: Mapping[str, Sequence[Any]], title: str = "", log: bool = False
) -> str:
    """Return an SVG of curves against time; a number that is not finite, or has no logarithm, is a gap."""
    # No screen shows more points than these.
    some = slice(None, None, max(1, len(times) // _MOST_POINTS))
    t = [float(time) for time in times[some]]
    heights = {name: [_height(v, log) for v in curve[some]] for name, curve in curves.items()}
    known = [y for curve in heights.values() for y in curve if y is not None]
    if not known or t[0] == t[-1]:
        return ""
    low, high = min(known), max(known)
    low = max(low, high - _MOST_DECADES) if log else low
    across, up = 560 / (t[-1] - t[0]), 180 / ((high - low) or 1.0)
    lines = []
    for k, (name, curve) in enumerate(heights.items()):
        colour = _COLOURS[k % len(_COLOURS)]
        points = " ".join(
            f"{40 + (time - t[0]) * across:.1f},{200 - (max(y, low) - low) * up:.1f}"
            for time, y in zip(t, curve, strict=True)
            if y is not None
        )
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}"/>')
        label = f'<text x="{44 + 70 * (k % 8)}" y="{232 + 14 * (k // 8)}" fill="{colour}"'
        lines.append(f'{label} font-size="11">{escape(name)}</text>')
    ends = [f"1e{end:.1f}" if log else f"{end:.3g}" for end in (high, low)]
    lines += [
        f'<text x="0" y="{y}" font-size="10">{end}</text>'
        for y, end in zip((24, 204), ends, strict=True)
    ]
    lines.append(f'<text x="40" y="12" font-size="11">{escape(title)}</text>')
    size = 'viewBox="0 0 620 260" style="max-width: 46rem" fill="currentColor"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{"".join(lines)}</svg>'


def _height(value: Any, log: bool) -> float | None:
    number = float(value)
    if not math.isfinite(number) or (log and number <= 0):
        return None
    return math.log10(number) if log else number
