"""How Sphinx makes these pages: `make docs` alone, `make site` with all that is published.

The docstrings of the package are plain text in which only ``literals`` are marked. They are turned into
what Sphinx reads here, so that |x|, R_ij and an indented formula stay what they are.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any

from taylor_verify.cli.arguments import parse

# Settings are names of this file for Sphinx: those of all pages first.
from taylor_verify_reports.studies.site.conf import *  # noqa: F403
from taylor_verify_reports.studies.site.conf import extensions
from taylor_verify_reports.studies.site.links import relinked

HERE = Path(__file__).resolve().parent

extensions = [*extensions, "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
# Docstrings with headings are numpydoc's; the colon of a plain one begins no section.
napoleon_google_docstring = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "mixed"
python_use_unqualified_type_names = True
maximum_signature_line_length = 88

# A notebook that reads what is published finds it here, wherever its kernel runs.
os.environ["TAYLOR_VERIFY_CLONE"] = str(HERE.parent)

LITERAL = re.compile(r"(``.+?``)")
ANNOTATED = re.compile(r"~?\b(?:typing\.)?Annotated\[")
MARKUP = re.compile(r"([\\*|`]|_(?!\w))")


def plain(lines: Iterable[str]) -> Iterator[str]:
    """A docstring as reStructuredText: its marks escaped, but for literals; what is indented verbatim."""
    before, is_verbatim = "", False
    for line in lines:
        is_indented = line.startswith(" ")
        if is_indented and not is_verbatim and not before:
            yield from ("::", "")
        if line or not is_verbatim:
            is_verbatim = is_indented and (is_verbatim or not before)
        if is_verbatim or not line:
            yield line
        else:
            parts = LITERAL.split(re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", line))
            yield "".join(p if p.startswith("``") else MARKUP.sub(r"\\\1", p) for p in parts)
        before = line


def told(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    lines[:] = plain(lines)


def bare(text: str) -> str:
    """A signature whose types have no remarks: Annotated[str, Meta(...)] is str to a reader."""
    mark = ANNOTATED.search(text)
    if mark is None:
        return text
    depth, quote, comma, end = 1, "", 0, mark.end()
    while depth:
        sign = text[end]
        if quote:
            quote = "" if sign == quote and text[end - 1] != "\\" else quote
        elif sign in "'\"":
            quote = sign
        elif sign == "," and depth == 1:
            comma = comma or end
        else:
            depth += (sign in "[(") - (sign in "])")
        end += 1
    return bare(text[: mark.start()] + text[mark.end() : comma] + text[end:])


def without_remarks(
    _app: Any,
    _what: str,
    _name: str,
    _thing: Any,
    _options: Any,
    given: str | None,
    back: str | None,
) -> tuple[str | None, str | None]:
    return given and bare(given), back and bare(back)


# A section of the page of the command line whose heading is a verb.
VERB = re.compile(r"^## ([a-z]+)\n.*?(?=^## )", re.MULTILINE | re.DOTALL)


def help_of(verb: str) -> str:
    with redirect_stdout(StringIO()) as out, suppress(SystemExit):
        parse([verb, "--help"])
    return out.getvalue()


def with_help(_app: Any, page: str, content: list[str]) -> None:
    """End each verb's section with the text of its --help, which has every option."""
    if page.endswith("command-line"):
        content[0] = VERB.sub(
            lambda section: f"{section[0]}```text\n{help_of(section[1])}```\n\n", content[0]
        )


INCLUDED = re.compile(r"^```\{include\} (\S+)\n```$", re.MULTILINE)
# A page replaces the file of the repository that it includes.
STAND_INS = {
    (HERE / included).resolve(): page.resolve()
    for page in HERE.glob("*.md")
    for included in INCLUDED.findall(page.read_text(encoding="utf-8"))
}


def beyond(place: str) -> str:
    """Where a link leads: what lies beyond these pages comes along as a file, a picture is shown."""
    target = (HERE / place).resolve()
    target = STAND_INS.get(target, target)
    if target.is_relative_to(HERE):
        return target.relative_to(HERE).as_posix()
    return place if target.suffix == ".svg" else f"path:{place}"


def linked_from_page(_app: Any, page: str, content: list[str]) -> None:
    folder = Path(page).parent.as_posix()
    content[0] = relinked(content[0], folder, folder, beyond)


def linked_from_included(_app: Any, path: Path, _page: str, content: list[str]) -> None:
    content[0] = relinked(content[0], Path(path).parent.as_posix(), "", beyond)


def setup(app: Any) -> None:
    app.connect("autodoc-process-docstring", told)
    app.connect("autodoc-process-signature", without_remarks)
    app.connect("source-read", with_help)
    # The pages of the whole site lie elsewhere, with their links as they have to be.
    if Path(app.srcdir) == HERE:
        app.connect("source-read", linked_from_page)
        app.connect("include-read", linked_from_included)
