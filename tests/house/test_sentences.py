"""Sizes of verdicts are written in one place, so that all doors say the same digits."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import taylor_verify

PACKAGE = Path(taylor_verify.__file__).parent
# What a row says of itself, and the room of all other words.
MAKERS = ("records/reason.py", "records/sentence.py", "words/")
SIZES = {
    *("max", "mean", "final", "bound", "attainable", "ratio", "since"),
    *("time_shift", "residual", "trend", "remains", "exponent"),
}


def written_sizes(text: str) -> Iterator[str]:
    """Yield the sizes of a verdict that a text of Python lays out in digits itself, as {v.max:.2g}."""
    if not any(f".{size}" in text for size in SIZES):
        return
    for part in ast.walk(ast.parse(text)):
        if isinstance(part, ast.FormattedValue) and part.format_spec is not None:
            inside = (node for node in ast.walk(part.value) if isinstance(node, ast.Attribute))
            yield from (
                node.attr
                for node in inside
                if node.attr in SIZES and ast.unparse(node.value) != "np"
            )


def test_sentences_on_verdicts_have_their_place() -> None:
    """Reasons, rows and the room of words lay out sizes of a verdict; no other file does."""
    makers = {
        str(file.relative_to(PACKAGE))
        for file in PACKAGE.rglob("*.py")
        if [*written_sizes(file.read_text(encoding="utf-8"))]
    }
    assert {file for file in makers if not file.startswith(MAKERS)} == set()
    assert makers >= {*MAKERS[:2]}


def test_a_planted_sentence_is_seen() -> None:
    """The broken twin: a size that is laid out in digits, by itself or within a sum."""
    assert [*written_sizes('f"error {v.max:.2g}, allowed {2 * v.bound:g}, {v.rung}"')] == [
        "max",
        "bound",
    ]
