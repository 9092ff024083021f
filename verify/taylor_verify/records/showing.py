"""Verdicts shown to a Python caller: in words, as a table of pandas, as HTML for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

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
