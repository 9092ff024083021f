"""A page as standalone HTML: one file, one small stylesheet in it, mathematics as MathML, no script."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from functools import partial
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.paper.latex_text import parts
from taylor_verify.publish.paper.parsed import MADE_BY, MATH, Page

if TYPE_CHECKING:
    from markdown_it.token import Token

SUFFIX: Final = ".html"
MAKER: Final = f"<!-- {MADE_BY} -->"

# MathML has no space of its own between the name of a function and what stands behind it.
_FUNCTION: Final = re.compile(r"(\\(?:sin|cos|tan|ln|operatorname\{\w+\}))\s*(?=[A-Za-z\\])")
_APART: Final = r"\1\\,"
_ADDRESSES: Final = frozenset({"href", "src"})
# Right-aligned numbers are a class: a style in every cell would be a third of the file.
_TO_RIGHT: Final = {"style": "text-align:right"}
_STYLE: Final = """\
body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 80rem; padding: 0 1rem;
  color: #1b1b1b; background: #fff; }
h1, h2, h3 { line-height: 1.2; margin-top: 2em; }
h1 { margin-top: 0; }
p, li { max-width: 60rem; }
a { color: #0b57a4; }
code { font-family: ui-monospace, monospace; font-size: .9em; }
pre { background: #f5f5f5; padding: 1em; overflow-x: auto; }
img { max-width: 100%; height: auto; }
div.wide { overflow-x: auto; margin: 1em 0; }
table { border-collapse: collapse; border-top: 2px solid; border-bottom: 2px solid;
  font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2em .6em; text-align: left; vertical-align: top; }
th { border-bottom: 1px solid; vertical-align: bottom; }
tbody tr:nth-child(5n) { border-bottom: 1px solid #ddd; }
th.r, td.r { text-align: right; }
td.r, td code { white-space: nowrap; }
@media print { div.wide { overflow: visible; } body { font-size: 9pt; max-width: none; } }
"""


def html(page: Page, pages: Collection[str]) -> str:
    """The whole file; ``pages`` are the paths of all that are rendered, for links among them."""
    from markdown_it import MarkdownIt
    from markdown_it.renderer import RendererHTML

    renderer = RendererHTML()
    rules: dict[str, Any] = {
        MATH: _formula,
        "table_open": partial(_constant, '<div class="wide">\n<table>\n'),
        "table_close": partial(_constant, "</table>\n</div>\n"),
    }
    renderer.rules.update(rules)
    options = MarkdownIt("commonmark").options
    tokens = list(_changed(page, pages))
    return "\n".join(
        [
            MAKER,
            "<!DOCTYPE html>",
            '<html lang="en">',
            "<head>",
            '<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(page.title)}</title>",
            f"<style>\n{_STYLE}</style>",
            "</head>",
            f"<body>\n{renderer.render(tokens, options, {})}</body>",
            "</html>\n",
        ]
    )


def _changed(page: Page, pages: Collection[str]) -> Iterator[Token]:
    """The page's tokens, with another one in place of each that HTML has otherwise."""
    for token, behind in pairwise((*page.tokens, None)):
        if token is None:
            continue
        if token.attrs == _TO_RIGHT:
            yield token.copy(attrs={"class": "r"})
        elif token.type == "heading_open" and behind is not None:
            yield token.copy(attrs={"id": _anchor(behind.content)})
        elif any(_ADDRESSES & set(child.attrs) for child in token.children or ()):
            children = [_seen_from_tables(child, page, pages) for child in token.children or ()]
            yield token.copy(children=children)
        else:
            yield token


def _anchor(heading: str) -> str:
    """What GitHub makes of a heading: links from elsewhere use it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _seen_from_tables(token: Token, page: Page, pages: Collection[str]) -> Token:
    """A link or a picture; one to a page leads to its rendering."""
    addresses = {
        name: page.leads_to(str(token.attrs[name]), pages, SUFFIX)
        for name in _ADDRESSES & set(token.attrs)
    }
    return token.copy(attrs={**token.attrs, **addresses}) if addresses else token


def _formula(tokens: Sequence[Token], place: int, *_: Any) -> str:
    """Mathematics as MathML; what it says in words is words, which can be broken at their spaces."""
    from taylor_verify.publish.mathml import mathml

    return "".join(
        escape(part) if is_text or not part.strip() else _spaced(part, mathml(_apart(part)))
        for part, is_text in parts(tokens[place].content)
    )


def _apart(latex: str) -> str:
    return _FUNCTION.sub(_APART, latex.strip())


def _spaced(latex: str, formula: str) -> str:
    """With the spaces that stand between a formula and the words beside it."""
    before, behind = (" " if sign.isspace() else "" for sign in (latex[0], latex[-1]))
    return f"{before}{formula}{behind}"


def _constant(text: str, *_: Any) -> str:
    return text
