"""A certificate as Python, a notebook and pytest show it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from taylor_verify.records.certificate import Certified
from taylor_verify.records.passing import Passing
from taylor_verify.records.showing import dataframe, html_table
from taylor_verify.words.certificate import certificate_lines

if TYPE_CHECKING:
    import pandas

_HEADINGS = ("quantity", "bound", "near t", "reached", "rounding")


@dataclass(frozen=True, repr=False)
class Certificate(Certified, Passing):
    """Proven bounds of the error of a dense answer, and its faults; true if it passed."""

    def __repr__(self) -> str:
        bounds = ", ".join(f"{name} <= {bound:.3e}" for name, bound in self.bound.items())
        word = "passed" if self.passed else "undecided" if self.is_undecided else "failed"
        return f"<{type(self).__name__} of {self.scene}: {word}; {bounds or 'nothing proven'}>"

    def __str__(self) -> str:
        return "\n".join(certificate_lines(self))

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each quantity. Raises ModuleNotFoundError without it."""
        return dataframe(self.rows())

    def _repr_html_(self) -> str:
        rows = [
            [f"{v:.6g}" if isinstance(v, float) else v for v in row.values()] for row in self.rows()
        ]
        return html_table(repr(self)[1:-1], _HEADINGS, rows, certificate_lines(self))
