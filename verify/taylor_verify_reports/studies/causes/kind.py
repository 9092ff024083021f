"""A kind of faulty answers, and makers of answers by a changed law or by changed rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from taylor_verify_reports.studies.causes.bodies import SORTS, Floats, Sample
from taylor_verify_reports.studies.causes.simulated import Law, Rows, integrated, law
from taylor_verify_reports.studies.causes.stepping import Draw, Make

RIGID: Final = ("free", "moment", "wheels")
FLUID: Final = ("fluid", "momenta")
# Files of momenta have no omega.
WITH_RATES: Final = (*RIGID, "fluid")


@dataclass(frozen=True)
class Kind:
    """A kind of answers; ``words`` of which one stands in each true sentence.

    Its files have the centre if it ``has_centre``, and no rates if it ``has_rates`` none.
    """

    name: str
    words: tuple[str, ...]
    make: Make
    sorts: tuple[str, ...] = SORTS
    has_centre: bool = False
    has_rates: bool = True


def of(change: Callable[[Law, Sample, Draw, float], None]) -> Make:
    """Return the maker of a changed law."""

    def make(sample: Sample, draw: Draw, size: float) -> Rows:
        own = law(sample)
        change(own, sample, draw, size)
        return integrated(sample, own)

    return make


def setting(name: str, value: Callable[[Sample, Draw, float], Any]) -> Make:
    """Return the maker of a law with another value of one field."""
    return of(lambda own, s, d, size: setattr(own, name, value(s, d, size)))


def right(sample: Sample, times: Floats | None = None) -> Rows:
    """Return the rows of the right motion."""
    return integrated(sample, law(sample), times)
