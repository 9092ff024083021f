"""The table of the closed form in plain doubles: where it is as good as it looks, and where it fails."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from taylor_verify.publish.cells import NOTHING, figure
from taylor_verify.publish.markdown import bold, bullets, code, prose, table
from taylor_verify.records.standing import Standing
from taylor_verify.studies.tradeoff.document import PlainDouble

_WHAT: Final = (
    "Omega of a free body is Jacobi's sn, cn and dn of time, and SciPy has them: `closed-form:ellipj` is "
    "that in float64, written with care. 1 - m is exact here and 0 on the separatrix; the error is "
    "relative to the largest |omega|. Beside it the integrator, where the motion is short enough for it."
)
_WHY: Final = (
    "**Long times.** The argument u = lam t + u0 is rounded to 2^-53 of itself, and so is lam: a phase "
    "error of some 1e-16 lam |t|. No step was taken, and still the error grows in proportion to time; "
    "at t = 1e15 u is known to a tenth, and the answer is a point somewhere on the right orbit.",
    "**Near the separatrix.** m is a double near 1, so that 1 - m is known to 1e-16: its relative error "
    "is 1e-16/(1 - m), the period depends on its logarithm, and where an orbit waits at the middle "
    "axis that shows. Below 1 - m = 1e-10 SciPy's `ellipj` takes series about m = 1 that hold within "
    "the first quarter of a period only. Beyond it they grow like an exponential, and what comes back "
    "is larger than the motion by any factor, without a warning.",
    "**On it** the answer hangs on the last bit of m. It is right where that happens to be 1, and where "
    "the principal axes are themselves found in doubles it need not be.",
    "**About the middle axis** the phase is infinite and the answer no number, where the motion is the "
    "simplest of all.",
    "Equal moments, a moment of force, a body at rest, an attitude, a fluid: it says beforehand that "
    "it is not made for them.",
    "The exact route of this suite has the same functions with 1 - m formed in rationals and as much "
    "precision as the answer needs: none of these orbits is difficult for it.",
)


def doubles_table(rows: Iterable[PlainDouble]) -> str:
    """Return a line for each case, and why."""
    numbers = ("until t:", "1 - m:", "error:", "taylor f64:")
    columns = ["orbit", *numbers, "what it claims"]
    lines = [
        [
            prose(row.what),
            figure(row.end),
            figure(row.m_prime),
            _error(row),
            figure(row.error_beside),
            _claim(row),
        ]
        for row in rows
    ]
    return "\n\n".join([_WHAT, table(columns, lines), bullets(_WHY)])


def _error(row: PlainDouble) -> str:
    if row.error is None:
        return NOTHING
    return figure(row.error) if row.standing is Standing.SOUND else bold(figure(row.error))


def _claim(row: PlainDouble) -> str:
    """Return what the solver claims. A false success stands out; an honest outcome has its own words."""
    if row.standing is Standing.SOUND:
        return "success"
    if row.standing is Standing.FALSE:
        return bold("success, falsely")
    return prose(row.outcome) if row.outcome else code(row.standing.value)
