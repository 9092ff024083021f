"""A page as a LaTeX document that pdflatex compiles as it is, and all pages as one paper."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Final

from taylor_verify.publish.paper import latex_table
from taylor_verify.publish.paper.latex_table import Cell, Table
from taylor_verify.publish.paper.latex_text import code, formula, prose
from taylor_verify.publish.paper.parsed import MADE_BY, MATH, Page

if TYPE_CHECKING:
    from markdown_it.token import Token
    from markdown_it.tree import SyntaxTreeNode

SUFFIX: Final = ".tex"
MAKER: Final = f"% {MADE_BY}"

_PREAMBLE: Final = r"""\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{lmodern,textcomp,amsmath,array,booktabs,longtable,pdflscape,graphicx}
\usepackage[margin=20mm]{geometry}
\usepackage[hidelinks]{hyperref}
% The headings of a table stand right once pdflatex has run three times.
\setcounter{LTchunksize}{1000}
\setcounter{secnumdepth}{-1}
\setlength{\parindent}{0pt}
\setlength{\parskip}{.5\baselineskip}
\emergencystretch=3em
% What a list is about stands on the page on which the list begins.
\makeatletter\@beginparpenalty=10000\makeatother
% A picture is left out where its file is not.
\newcommand{\shown}[1]{\IfFileExists{#1}{\begin{center}\includegraphics[width=\linewidth,%
height=.8\textheight,keepaspectratio]{#1}\end{center}}{}}
"""
_HEADINGS: Final = {
    "h1": "section",
    "h2": "subsection",
    "h3": "subsubsection",
    "h4": "paragraph",
}
_FIRST: Final = r"\begin{document}"
_LAST: Final = r"\end{document}"


def document(page: Page) -> str:
    """The whole file of one page."""
    return "\n".join([MAKER, _PREAMBLE, _FIRST, blocks(page), _LAST, ""])


def paper(title: str, stems: Iterable[str]) -> str:
    """One document that reads in the files of all pages, whose preambles docmute leaves out."""
    inputs = [rf"\clearpage\input{{{stem}}}" for stem in stems]
    preamble = [
        MAKER,
        _PREAMBLE + r"\usepackage{docmute}",
        rf"\title{{{prose(title)}}}",
        r"\date{}",
    ]
    return "\n".join([*preamble, _FIRST, r"\maketitle\tableofcontents", *inputs, _LAST, ""])


def blocks(page: Page) -> str:
    """What stands between the beginning and the end of the document."""
    from markdown_it.tree import SyntaxTreeNode

    parts: list[str] = []
    heading = ""
    for node in SyntaxTreeNode(page.tokens).children:
        layouts = latex_table.laid_out(_table(node)) if node.type == "table" else []
        block = latex_table.latex(layouts) if layouts else _block(node)
        if layouts and layouts[0].turned:
            # A heading that stayed on the page before would stand on it alone.
            block = f"\\begin{{landscape}}\n{heading}{block}\n\\end{{landscape}}"
            parts = parts[:-1] if heading else parts
        heading = f"{block}\n" if node.type == "heading" else ""
        parts.append(block)
    return "\n\n".join(parts)


def _block(node: SyntaxTreeNode) -> str:
    match node.type:
        case "heading":
            return rf"\{_HEADINGS[node.tag]}{{{_inside(node)}}}"
        case "paragraph":
            return _inside(node)
        case "bullet_list" | "ordered_list":
            name = "itemize" if node.type == "bullet_list" else "enumerate"
            items = [rf"\item {_nested(item)}" for item in node.children]
            return "\n".join([rf"\begin{{{name}}}", *items, rf"\end{{{name}}}"])
        case "fence" | "code_block":
            return (
                f"{{\\footnotesize\\begin{{verbatim}}\n{node.content.rstrip()}\n\\end{{verbatim}}}}"
            )
        case "blockquote":
            return f"\\begin{{quote}}\n{_nested(node)}\n\\end{{quote}}"
        case "hr":
            return r"\par\noindent\hrulefill\par"
        case "table":
            return latex_table.latex(latex_table.laid_out(_table(node)))
    raise ValueError(f"expected a block that LaTeX is made of, got {node.type}")


def _nested(node: SyntaxTreeNode) -> str:
    return "\n\n".join(_block(child) for child in node.children)


def _inside(node: SyntaxTreeNode, breakable: bool = True) -> str:
    """The words of a block that has one line of them, or none."""
    return "".join(_span(child, breakable) for inline in node.children for child in inline.children)


def _span(node: SyntaxTreeNode, breakable: bool) -> str:
    inner = "".join(_span(child, breakable) for child in node.children)
    match node.type:
        case "text":
            return prose(node.content)
        case "code_inline":
            return code(node.content, breakable)
        case "strong":
            return rf"\textbf{{{inner}}}"
        case "em":
            return rf"\emph{{{inner}}}"
        case "softbreak":
            return "\n"
        case "hardbreak":
            return "\\\\\n"
        case "link":
            return _link(str(node.attrs["href"]), inner)
        case "image":
            stem = PurePosixPath(str(node.attrs["src"])).with_suffix(".pdf")
            return rf"\shown{{{stem}}}"
    if node.type == MATH:
        return formula(node.content)
    raise ValueError(f"expected words that LaTeX is made of, got {node.type}")


def _link(address: str, words: str) -> str:
    """An address in the web is linked to; a file beside the page is not beside a printed one."""
    if "://" not in address:
        return words
    escaped = "".join(rf"\{sign}" if sign in "#%&_" else sign for sign in address)
    return rf"\href{{{escaped}}}{{{words}}}"


def _table(node: SyntaxTreeNode) -> Table:
    head, *body = node.children
    (heads,) = head.children
    rows = [row for part in body for row in part.children]
    return Table(
        heads=tuple(_cell(cell) for cell in heads.children),
        to_right=tuple("right" in str(cell.attrs.get("style", "")) for cell in heads.children),
        rows=tuple(tuple(_cell(cell) for cell in row.children) for row in rows),
    )


def _cell(node: SyntaxTreeNode) -> Cell:
    words, spans = _seen(node.to_tokens())
    # Where the cell is not wrapped nothing is broken, whatever is allowed.
    return Cell(_inside(node), words, spans)


def _seen(tokens: Sequence[Token]) -> tuple[str, str]:
    """What a reader sees of some tokens, apart: words, and signs of code."""
    inline = [child for token in tokens for child in token.children or ()]
    words = " ".join(t.content for t in inline if t.type in ("text", MATH))
    return words, "".join(t.content for t in inline if t.type == "code_inline")
