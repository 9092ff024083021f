"""Proven findings about engines: scripts below reports/upstream/engines, reported on the board.

A script begins with its report: in Python the docstring, in JavaScript the first comment. The report is a
title and paragraphs, each of which begins with a word of `PARTS` and a colon.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Final

from taylor_verify.words.markdown import bullets, prose

FOLDER: Final = "upstream/engines"
PARTS: Final = ("Versions", "Expected", "Came", "Evidence")


@dataclass(frozen=True)
class Finding:
    """A script, its title, and its paragraphs by the first word of each."""

    script: str
    title: str
    parts: dict[str, str]


def read(file: Path) -> Finding:
    """Return the finding of a script. Raises OSError, and ValueError for a script that lacks a part."""
    report = _report(file.read_text(encoding="utf-8"), file.suffix)
    title, *paragraphs = [" ".join(text.split()) for text in re.split(r"\n\s*\n", report)]
    splits = [paragraph.partition(":") for paragraph in paragraphs]
    parts = {word: text.strip() for word, _, text in splits}
    if missing := [word for word in PARTS if not parts.get(word)]:
        raise ValueError(f"expected paragraphs {', '.join(missing)}, got none @ {file.name}")
    return Finding(file.name, title.removesuffix("."), parts)


def scripts(folder: Path) -> list[Path]:
    """Return the scripts of a report folder, in alphabetical order."""
    place = folder / FOLDER
    return sorted([*place.glob("*.py"), *place.glob("*.mjs")])


def _report(text: str, suffix: str) -> str:
    """Return the docstring of a script, or its first comment; empty if it has neither."""
    if suffix == ".py":
        return ast.get_docstring(ast.parse(text)) or ""
    lines = takewhile(lambda line: line.startswith("//"), text.splitlines())
    return "\n".join(line.removeprefix("//").strip() for line in lines)


def findings(folder: Path, only: Collection[str] = ()) -> Iterator[str]:
    """Yield the section with the findings of a report folder, or of scripts of some names.

    Nothing is yielded if there are none.
    """
    results = [read(file) for file in scripts(folder) if not only or file.name in only]
    if results:
        yield "## Findings"
        yield (
            "Each has a script that runs with the engine and at most NumPy, and evidence beside our "
            f"adapter ([all of them](../{FOLDER}/README.md))."
        )
        yield bullets(
            f"[{prose(finding.title)}](../{FOLDER}/{finding.script}): {prose(finding.parts['Came'])} "
            f"({prose(finding.parts['Versions'])})"
            for finding in results
        )
