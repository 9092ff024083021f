"""Colours by their lightness, so that different colours also differ in grey.

Y is the relative luminance of WCAG 2 (linear sRGB, 0 black to 1 white), L the lightness of CIE 1976
(0 to 100), which greyscale prints show.
"""

from __future__ import annotations

from typing import Final

INK: Final = "#1A1A1A"
QUIET: Final = "#6A6A6A"
FAINT: Final = "#E2E2E2"
PAPER: Final = "#FFFFFF"

# Contrast with the background that WCAG 2.1 requires of text (1.4.3) and of lines and marks (1.4.11).
TEXT_CONTRAST: Final = 4.5


def luminance(colour: str) -> float:
    """Return Y of a colour written #RRGGBB."""
    red, green, blue = (_linear(int(colour[i : i + 2], 16) / 255) for i in (1, 3, 5))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def lightness(colour: str) -> float:
    """Return L of a colour, with the linear foot of CIE 1976 below Y = (6/29)^3."""
    y = luminance(colour)
    return 116 * y ** (1 / 3) - 16 if y > (6 / 29) ** 3 else (29 / 3) ** 3 * y


def contrast(one: str, other: str = PAPER) -> float:
    """Return the contrast ratio of WCAG 2, from 1 to 21."""
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def for_text(colour: str) -> str:
    """Return the hue of a colour, darkened for text on paper."""
    while contrast(colour) < TEXT_CONTRAST:
        parts = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
        colour = "#" + "".join(f"{part * 24 // 25:02X}" for part in parts)
    return colour


def _linear(value: float) -> float:
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
