"""The published Markdown as HTML: links that lead within the site, formulas set, tables to be sorted."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import takewhile
from typing import Any, Final

from markdown_it import MarkdownIt
from markdown_it.rules_inline import StateInline
from markdown_it.token import Token
from markupsafe import Markup, escape

from taylor_verify.publish.mathml import inline
from taylor_verify.studies.site.links import Links

_COMMENT: Final = re.compile(r"^<!--.*?-->\n?", re.MULTILINE)
_TITLE: Final = re.compile(r"^# (.+)$", re.MULTILINE)
_NO_WORD: Final = re.compile(r"[^\w\- ]")
# GitHub's formula within a line: a code span between dollars.
_OPENS, _CLOSES = "$`", "`$"
# A table of fewer lines is seen at a glance, one of more is looked through with a filter.
SORTABLE: Final = 6
FILTERABLE: Final = 40


class Prose:
    """Markdown to HTML, within one site."""

    def __init__(self, links: Links) -> None:
        self._links = links
        # By page: what is in parts has the anchors and tables of one page all the same.
        self._known: dict[str, dict[str, Any]] = {}
        self._markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
        self._markdown.inline.ruler.before("backticks", "formula", _formula)
        for name in _RULES:
            self._markdown.add_render_rule(name, _rule(getattr(self, f"_{name}")))

    def html(self, text: str, source: str, page: str) -> Markup:
        """The body of a page: ``source`` is the Markdown file's place, ``page`` that of the page."""
        env = self._known.setdefault(page, {"page": page, "slugs": {}, "tables": 0})
        env["source"] = source
        return Markup(self._markdown.render(_COMMENT.sub("", text), env))

    # How each token is written, by markdown-it's names.

    def _formula(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return str(inline(found[i].content))

    def _code_inline(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        """A code span; the name of a scene leads to its page."""
        text = f"<code>{escape(found[i].content)}</code>"
        link = self._links.scene(found[i].content, env["page"])
        within = i > 0 and found[i - 1].type == "link_open"
        return text if link is None or within else f'<a href="{link}">{text}</a>'

    def _link_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        given = str(found[i].attrs["href"])
        link = self._resolved(given, env)
        markdown = self._links.markdown(given, env["source"])
        if markdown is not None and found[i + 1].content == given:
            # The name of a file says nothing here: the title of its page does.
            found[i + 1].content = self._links.title(markdown)
        # A span in its place: what is between opening and closing stays, and leads nowhere.
        return "<span>" if link is None else f'<a href="{escape(link)}">'

    def _link_close(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        opened = max(k for k in range(i) if found[k].type == "link_open")
        link = self._resolved(str(found[opened].attrs["href"]), env)
        return "</span>" if link is None else "</a>"

    def _image(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        link = self._resolved(str(found[i].attrs["src"]), env)
        alt = escape(found[i].content)
        return f'<img class="sheet" src="{escape(link or "")}" alt="{alt}" loading="lazy">'

    def _heading_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        slug = slug_of(found[i + 1].content, env["slugs"])
        return f'<{found[i].tag} id="{slug}">'

    def _table_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        env["tables"] += 1
        name = f"table-{env['tables']}"
        rows = _rows(found, i)
        heading = next((found[k + 1] for k in range(i, -1, -1) if _is_heading(found[k])), None)
        label = escape(_plain(heading)) if heading else "table"
        env["sorted"] = rows >= SORTABLE
        kind = ' class="sortable"' if env["sorted"] else ""
        above = _filter_above(name) if rows >= FILTERABLE else ""
        return (
            f'{above}<div class="scroll" data-label="{label}"><table id="{name}"{kind} '
            f'aria-label="{label}">'
        )

    def _table_close(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return "</table></div>"

    def _th_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        number = " class=n" if _is_right(found[i]) else ""
        return f'<th scope="col"{number}>' + ('<button type="button">' if env["sorted"] else "")

    def _th_close(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return "</button></th>" if env["sorted"] else "</th>"

    # HTML needs no word for the end of a cell or a line, and a large table has thousands.
    def _td_close(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return ""

    def _tr_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return "\n<tr>"

    def _tr_close(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return ""

    def _td_open(self, found: Tokens, i: int, options: Any, env: dict[str, Any]) -> str:
        return "<td class=n>" if _is_right(found[i]) else "<td>"

    def _resolved(self, link: str, env: dict[str, Any]) -> str | None:
        return self._links.resolved(link, env["source"], env["page"])


Tokens = Sequence[Token]

_RULES: Final = (
    *("formula", "code_inline", "link_open", "link_close", "image", "heading_open"),
    *("table_open", "table_close", "th_open", "th_close", "td_open"),
    *("td_close", "tr_open", "tr_close"),
)


def _rule(write: Callable[..., str]) -> Callable[..., str]:
    """A method of ours as one of the renderer, which comes first among its arguments."""
    return lambda renderer, *given: write(*given)


def without_title(text: str) -> str:
    """The same text below its first heading, for a page that has set that itself."""
    return _TITLE.sub("", text, count=1)


def sections(text: str) -> dict[str, str]:
    """The parts of a Markdown file by their second headings; what is before them under none."""
    found: dict[str, str] = {}
    for part in re.split(r"^(?=## )", text, flags=re.MULTILINE):
        heading = part.partition("\n")[0]
        found[heading.removeprefix("## ") if heading.startswith("## ") else ""] = part
    return found


def slug_of(heading: str, taken: dict[str, int]) -> str:
    """The heading's anchor as GitHub makes it: lower case, hyphens, a number for one that is taken."""
    plain = _NO_WORD.sub("", heading.replace("`", "").lower()).replace(" ", "-")
    taken[plain] = taken.get(plain, -1) + 1
    return f"{plain}-{taken[plain]}" if taken[plain] else plain


def _formula(state: StateInline, silent: bool) -> bool:
    """The rule that reads a formula; True where one begins."""
    if not state.src.startswith(_OPENS, state.pos):
        return False
    end = state.src.find(_CLOSES, state.pos + len(_OPENS))
    if end < 0:
        return False
    if not silent:
        token = state.push("formula", "math", 0)
        token.content = state.src[state.pos + len(_OPENS) : end]
    state.pos = end + len(_CLOSES)
    return True


def _rows(found: Tokens, i: int) -> int:
    """The lines of the table that begins here, without its heading."""
    inside = takewhile(lambda token: token.type != "table_close", found[i:])
    return sum(token.type == "tr_open" for token in inside) - 1


def _filter_above(name: str) -> str:
    return (
        f'<p class="filter"><label for="{name}-filter">Filter</label> '
        f'<input id="{name}-filter" type="search" data-filter="{name}" autocomplete="off"> '
        f'<span role="status" data-count="{name}"></span></p>'
    )


def _is_heading(token: Token) -> bool:
    return token.type == "heading_open"


def _is_right(token: Token) -> bool:
    return "right" in str(token.attrs.get("style", ""))


def _plain(heading: Token) -> str:
    return "".join(child.content for child in heading.children or ())
