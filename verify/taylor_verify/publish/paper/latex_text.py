r"""Words, code and formulas as LaTeX that pdflatex takes: every special sign escaped, none lost.

Signs beyond Latin letters are written as the macros that have them; one that has none stands as its code
point, such as [U+2603], for the reader to see that it is missing.
"""
# ruff: noqa: RUF001 (signs that look like others are what the table below is about)

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

_SPECIAL: Final = {
    **{sign: f"\\{sign}" for sign in "#$%&_{}"},
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    "'": r"\textquotesingle{}",
}
# In prose, quotation marks are what they are in a book; in code they stay straight.
_IN_PROSE: Final = {**_SPECIAL, "'": "'"}
_GREEK: Final = {
    **dict(zip("αβγδεζηθικλμ", (*("alpha", "beta", "gamma", "delta", "varepsilon", "zeta", "eta"),
        *("theta", "iota", "kappa", "lambda", "mu")), strict=True)),
    **dict(zip("νξπρστυφχψω", (*("nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "varphi"),
        *("chi", "psi", "omega")), strict=True)),
    **dict(zip("ΓΔΘΛΞΠΣΥΦΨΩ", (*("Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma"),
        *("Upsilon", "Phi", "Psi", "Omega")), strict=True)),
}  # fmt: skip
_SIGNS: Final = {
    **{sign: rf"\({macro}\)" for sign, macro in {
        "×": r"\times",
        "·": r"\cdot",
        "±": r"\pm",
        "−": "-",
        "≤": r"\leq",
        "≥": r"\geq",
        "≠": r"\neq",
        "≈": r"\approx",
        "∼": r"\sim",
        "≡": r"\equiv",
        "∞": r"\infty",
        "√": r"\surd",
        "∂": r"\partial",
        "∫": r"\int",
        "∑": r"\sum",
        "∈": r"\in",
        "→": r"\rightarrow",
        "←": r"\leftarrow",
        "↦": r"\mapsto",
        "⇒": r"\Rightarrow",
        "‖": r"\Vert",
        "′": "'",
        "″": "''",
        "ᵀ": r"^{\mathsf T}",
        "⁻": "^{-}",
        "ℝ": r"\mathbf R",
        "½": r"\frac12",
        "¼": r"\frac14",
        "¾": r"\frac34",
    }.items()},
    **{sign: rf"\(\{name}\)" for sign, name in _GREEK.items()},
    **{sign: rf"\(^{digit}\)" for digit, sign in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")},
    **{sign: rf"\(_{digit}\)" for digit, sign in enumerate("₀₁₂₃₄₅₆₇₈₉")},
    "–": "--",
    "—": "---",
    "…": r"\ldots{}",
    "‘": "`",
    "’": "'",
    "“": "``",
    "”": "''",
    "\u00a0": "~",
    "\u202f": r"\,",
}  # fmt: skip
# The letters that the T1 encoding has.
_LAST_LATIN: Final = 0x17F
# Where code may be broken at the end of a line.
_BREAKS: Final = re.compile(r"[/,;:=?.-](?=\w)|[)\]}](?=[^)\]}.,;])|(?<=[a-z0-9])_(?=\w)")
_BREAK: Final = "\0"


def prose(text: str) -> str:
    """Plain words."""
    return "".join(_sign(sign, _IN_PROSE) for sign in text)


def code(text: str, breakable: bool = False) -> str:
    """A code span; one that is ``breakable`` may go on in the next line behind a / or a hyphen."""
    parts = _BREAKS.sub(lambda found: found[0] + _BREAK, text) if breakable else text
    inside = "".join(r"\allowbreak{}" if s == _BREAK else _sign(s, _SPECIAL) for s in parts)
    # Two hyphens would be drawn as a dash.
    return rf"\texttt{{{inside.replace('--', '-{}-')}}}"


def _sign(sign: str, special: dict[str, str]) -> str:
    if sign in special:
        return special[sign]
    if sign in _SIGNS:
        return _SIGNS[sign]
    if ord(sign) <= _LAST_LATIN:
        return sign
    return f"[U+{ord(sign):04X}]"


def formula(latex: str) -> str:
    r"""Mathematics in a line. The words of a \text at its top level become words, which can break."""
    return "".join(part if is_text else _formula(part) for part, is_text in parts(latex))


def _formula(latex: str) -> str:
    """One stretch of mathematics; a space at its end is one between it and the words behind."""
    if not latex.strip():
        return latex
    # In the style of a line, fractions are too small to be read.
    style = r"\displaystyle " if "frac" in latex or r"\int" in latex else ""
    return f"${style}{latex.strip()}${' ' if latex[-1].isspace() else ''}"


def parts(latex: str) -> Iterator[tuple[str, bool]]:
    r"""The formula cut where a \text{...} stands outside every brace, which is said to be one."""
    place = start = depth = 0
    while place < len(latex):
        if depth == 0 and latex.startswith(r"\text{", place):
            yield latex[start:place], False
            end = _closing(latex, place + len(r"\text"))
            yield latex[place + len(r"\text{") : end], True
            place = start = end + 1
            continue
        if latex[place] == "\\":
            # A command's first sign opens and closes nothing, but for \left and \right.
            place += 1
        elif latex[place] in "{}":
            depth += 1 if latex[place] == "{" else -1
        place += 1
    yield latex[start:], False


def _closing(latex: str, opening: int) -> int:
    """The place of the brace that closes the one at ``opening``; ValueError if none does."""
    depth = 0
    for place in range(opening, len(latex)):
        if latex[place - 1] != "\\":
            depth += {"{": 1, "}": -1}.get(latex[place], 0)
        if depth == 0:
            return place
    raise ValueError(f"expected a closing brace, got none @ {latex}")
