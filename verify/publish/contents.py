"""What else lies in a report folder, beside the tables that every run makes: named where it is there."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final


@dataclass(frozen=True)
class Page:
    """A file or folder below the report's own, and what it has."""

    path: str
    what: str

    def row(self, seen_from: str = "") -> list[str]:
        """A link, from the folder ``seen_from`` of the report, and what it leads to."""
        place = PurePosixPath(self.path)
        if seen_from and place.is_relative_to(seen_from):
            place = place.relative_to(seen_from)
        elif seen_from:
            place = PurePosixPath("..", place)
        return [f"[{place}]({place})", self.what]


_PAGES: Final = (
    Page("tables/controls.md", "what each gate sees of solvers that were broken on purpose"),
    Page("tables/traps.md", "a plain heyoka call against the driver of this suite"),
    Page("tables/tradeoff.md", "speed against accuracy, every solver, measured once"),
    Page("tables/prices.md", "what each thing costs that a scene may ask for"),
    Page("tables/reach.md", "how far each precision carries, and where it ends"),
    Page("tables/growth.md", "how drift and phase grow over decades of time"),
    Page("tables/worst.md", "the worst that a search has found, family by family"),
    Page("claims.md", "every numbered equation of the two source texts, checked; errata in front"),
    Page("upstream/README.md", "what to report to heyoka's authors, each in a few lines that run"),
    Page("reference/README.md", "exact motions in digits, to test other programs with"),
)


def others(folder: Path, made: Collection[str] = ()) -> list[Page]:
    """Those that are there, or are among the files that are about to be."""
    return [page for page in _PAGES if page.path in made or (folder / page.path).exists()]
