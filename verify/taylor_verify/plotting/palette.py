"""Colours of what is no line of a solver: text, thin lines, grids and paper.

Text on paper has the contrast that WCAG 2.1 requires (1.4.3).
"""

from __future__ import annotations

from typing import Final

INK: Final = "#1A1A1A"
QUIET: Final = "#6A6A6A"
FAINT: Final = "#E2E2E2"
PAPER: Final = "#FFFFFF"
