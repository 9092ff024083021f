"""Paper written in Markdown, as PDF by Typst and as LaTeX. Neither needs TeX.

pandoc, in the wheel of `pypandoc-binary`, writes both forms. Typst compiles in this process, with the fonts
of its wheel alone, so that the PDF is the same on another machine. `paper.lua` adds to pandoc's LaTeX;
`paper.typst` and `paper.latex` are the frames around the text.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

MADE_BY: Final = "made by taylor-verify publish --paper; do not edit"

_HERE: Final = Path(__file__).with_suffix("")
# Tildes, carets and at signs in words of a table are plain characters.
_READER: Final = "markdown-superscript-subscript-citations"
_OPTIONS: Final = ("--fail-if-warnings", "--wrap=none", "--columns=10000")
# Signs in cells that LaTeX's fonts lack.
_SIGNS: Final = {"→": r"$\to$", "µ": r"$\mu$", "∞": r"$\infty$"}
_POWER: Final = re.compile(r"(?<![\w.`])(-?\d+(?:\.\d+)?)e\+?(-?)0*(\d+)(?![\w`])")


def formulas(text: str) -> str:
    """Return Markdown with signs, and numbers such as 2.5e-14, as formulas."""
    for sign, formula in _SIGNS.items():
        text = text.replace(sign, formula)
    return _POWER.sub(_power, text)


def _power(number: re.Match[str]) -> str:
    mantissa, sign, exponent = number.groups()
    factor = "" if mantissa == "1" else rf"{mantissa}\times "
    return rf"${factor}10^{{{sign}{exponent}}}$"


def latex(text: str, citation: Path) -> str:
    """Return a paper as LaTeX, with the title and the authors of a file CITATION.cff."""
    return f"% {MADE_BY}\n{_convert(text, 'latex', citation)}"


def latex_table(text: str) -> str:
    """Return a table with its caption as LaTeX to be read in, by booktabs, adjustbox and amsmath."""
    return f"% {MADE_BY}\n{_convert(text, 'latex')}"


def pdf(text: str, citation: Path, folder: Path) -> bytes:
    """Return a paper as PDF; the pictures that it names are files of ``folder``."""
    return bytes(_compile(text, citation, folder, "pdf"))


def images(text: str, citation: Path, folder: Path) -> list[bytes]:
    """Return the pages of a paper as PNG."""
    pages = _compile(text, citation, folder, "png")
    return [pages] if isinstance(pages, bytes) else list(pages)


def _compile(text: str, citation: Path, folder: Path, form: str) -> Any:
    import typst

    source = _convert(text, "typst", citation).encode()
    # Without the time of making, two files of one paper are the same.
    return typst.compile(source, root=folder, ignore_system_fonts=True, format=form, timestamp=0)


def _convert(text: str, writer: str, citation: Path | None = None) -> str:
    import pypandoc

    options = [*_OPTIONS, f"--lua-filter={_HERE.with_suffix('.lua')}"]
    if citation is not None:
        template = f"--template={_HERE.with_suffix(f'.{writer}')}"
        options += ["--standalone", "--number-sections", template, f"--metadata-file={citation}"]
    return str(pypandoc.convert_text(formulas(text), writer, _READER, options))
