"""LaTeX as MathML, which browsers show without a script."""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from html import unescape
from typing import Final

from markupsafe import Markup, escape

# Browsers ignore the attribute mathvariant: a bold x is a character of its own.
_VARIANT: Final = re.compile(r'<mi mathvariant="([a-z-]+)">(&#x[0-9A-F]+;|.)</mi>')
# TeX leaves a thin space beside the name of a function.
_FUNCTION: Final = re.compile(r"<mi>(sin|cos|tan|exp|ln|log|sinh|cosh|tanh|sn|cn|dn|am)</mi>")
_SPACED: Final = r'<mspace width="0.14em"/><mi>\1</mi><mspace width="0.14em"/>'
_WORDS: Final = re.compile(r"\\text\{([^{}]*)\}")


@cache
def mathml(tex: str, display: bool = False) -> Markup:
    """Return the formula as an element <math>, its LaTeX in the attribute ``alttext``.

    Raises ValueError for LaTeX that cannot be read.
    """
    from latex2mathml.converter import convert

    try:
        markup = convert(tex, display="block" if display else "inline")
    except Exception as fault:
        # The converter raises its own exceptions, and some of Python's.
        raise ValueError(f"expected LaTeX, got {tex!r} ({type(fault).__name__})") from fault
    named = markup.replace("<math ", f'<math alttext="{escape(tex)}" ', 1)
    return Markup(_FUNCTION.sub(_SPACED, _VARIANT.sub(_letter, named)))


def _letter(match: re.Match[str]) -> str:
    """Return a letter of another alphabet as its Unicode character, or unchanged."""
    alphabet = match[1].upper().replace("BOLD-", "BOLD ")
    # Such as LATIN SMALL LETTER X.
    _, case, _, letter = (*unicodedata.name(unescape(match[2]), "").split(), "", "", "", "")[:4]
    try:
        return f"<mi>{unicodedata.lookup(f'MATHEMATICAL {alphabet} {case} {letter}')}</mi>"
    except KeyError:
        return match[0]


def inline(tex: str) -> Markup:
    """Return a formula within a line; its words are text, so that lines can break at spaces."""
    parts, at = [], 0
    for words in _WORDS.finditer(tex):
        before = tex[at : words.start()]
        if before.count("{") == before.count("}"):
            parts += [_formula(before), escape(words[1])]
            at = words.end()
    return Markup("").join([*parts, _formula(tex[at:])])


def _formula(tex: str) -> Markup:
    """Return a formula in a box that a narrow page can scroll; empty without a formula."""
    markup = mathml(tex.strip()) if tex.strip() else None
    return Markup('<span class="formula">{}</span>').format(markup) if markup else Markup()
