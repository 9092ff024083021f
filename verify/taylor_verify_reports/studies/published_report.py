"""Folder of what is published: the pages of every study, and their index."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from hashlib import sha256
from pathlib import Path

from taylor_verify.records import store
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.verdict import Verdict
from taylor_verify.report.folder import index
from taylor_verify.report.index_page import Page
from taylor_verify.scenes import library
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.studies.accuracy import quoted
from taylor_verify_reports.studies.registry import STUDIES, others

_PAGES_OF_NO_STUDY = (
    Page("upstream/traps.md", "a plain heyoka call against the driver of this suite"),
    Page("upstream/README.md", "what to report to heyoka's authors, each in a few lines that run"),
    Page(
        "upstream/engines/README.md",
        "what to report to the authors of engines, each in a script that runs",
    ),
)

_CAUTION = f"**These numbers were edited**: no run has written `{store.VERDICTS}` as it is."


def publish(folder: Path | str) -> list[Path]:
    """Make ``folder``/tables and the index from ``folder``/data; return the files written.

    Tables that are no longer made are removed. Files that this program did not make stay, even a README.md.
    Raises OSError for files that cannot be read or written, and ValueError for files that hold something
    else.
    """
    place = Path(folder)
    verdicts = _with_own_names(place)
    texts = {name: text for study in STUDIES for name, text in study.pages(place).items()}
    texts |= index(place, verdicts, entries(place, texts))
    texts = _with_caution(place, texts)
    written = replace_files(place, texts, stale=_own_tables(place / "tables"))
    return [*written, *_requote(place, verdicts)]


def publish_index(folder: Path | str) -> list[Path]:
    """Make the index and the quoted blocks of other pages again.

    Returns the files written. Raises the errors of `publish`.
    """
    place = Path(folder)
    verdicts = _with_own_names(place)
    texts = _with_caution(place, index(place, verdicts, entries(place)))
    return [*replace_files(place, texts), *_requote(place, verdicts)]


def _with_own_names(place: Path) -> tuple[Verdict, ...]:
    """Return the verdicts; raise ValueError for a shipped scene under the name of another one.

    A name that ends in .toml is that of a file, which may be a copy.
    """
    verdicts, own = store.load(place), _names_by_digest()
    for k, verdict in enumerate(verdicts):
        name = own.get(verdict.provenance["scene"], verdict.scene)
        if verdict.scene != name and not verdict.scene.endswith(".toml"):
            file = place / store.FOLDER / store.VERDICTS
            expected = f"expected the scene {name}, whose digest this is"
            raise ValueError(
                f"{expected}, got {verdict.scene!r:.60} @ verdicts[{k}].scene @ {file}"
            )
    return verdicts


def _names_by_digest() -> dict[str, str]:
    """Return the name of each shipped scene by the digest of its text, as Scene has it."""
    folders = (*library.STANDARD_SET, library.EXTREMES, library.WORST, library.ENGINES)
    files = {name: library.find(name) for name in library.names(*folders)}
    texts = {name: file.read_text(encoding="utf-8-sig") for name, file in files.items()}
    return {sha256(text.encode()).hexdigest(): name for name, text in texts.items()}


def _with_caution(place: Path, texts: Mapping[str, str]) -> dict[str, str]:
    """Return the pages, each with a sentence under its title if the verdicts may be edited."""
    if store.are_edited(place) is False:
        return dict(texts)
    return {
        name: re.sub("^# .*$", rf"\g<0>\n\n{_CAUTION}", text, count=1, flags=re.MULTILINE)
        if name.endswith(".md")
        else text
        for name, text in texts.items()
    }


def entries(place: Path, made: Collection[str] = ()) -> list[Page]:
    """Return the pages beside the tables of runs that exist or are about to be ``made``."""

    def is_there(path: str) -> bool:
        return path in made or (place / path).exists()

    pages = (*(Page(study.path, study.title) for study in others()), *_PAGES_OF_NO_STUDY)
    sheets = [f"tables/{Path(page.path).stem}.csv" for page in pages]
    return [
        page._replace(sheet=sheet if is_there(sheet) else "")
        for page, sheet in zip(pages, sheets, strict=True)
        if is_there(page.path)
    ]


def _requote(place: Path, verdicts: Sequence[Verdict]) -> tuple[Path, ...]:
    """Make the quoted blocks of the pages beside the report again."""
    return replace_files(place.resolve().parent, quoted.requoted(place, verdicts))


def _own_tables(target: Path) -> list[Path]:
    """Return the Markdown files that this program made, each with its CSV."""
    own = [file for file in target.glob("*.md") if first_line(file) == MADE_BY]
    return own + [file.with_suffix(".csv") for file in own]
