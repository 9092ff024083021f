"""The traps as CSV: a row for every case, with every digit."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from taylor_verify.publish.sheet import sheet
from taylor_verify.studies.traps.document import TrapCase, TrapRow

_GATED: Final = ("omega", "T", "H2")
_TRAPS: Final = (
    *("trap", "title", "case", "reports", "silent", "error", "driver", "driver_error", "steps"),
    *(f"{name}_{field}" for name in _GATED for field in ("verdict", "over_bound")),
    *("cause", "documented", "script"),
)


def traps(rows: Iterable[TrapRow]) -> str:
    """Return a row for every case of every trap, with the verdict of each gate that was asked."""
    return sheet(_TRAPS, (_trapped(row, case) for row in rows for case in row.cases))


def _trapped(row: TrapRow, case: TrapCase) -> dict[str, Any]:
    gates = {
        f"{name}_{field}": getattr(case.gates.get(name), field, None)
        for name in _GATED
        for field in ("verdict", "over_bound")
    }
    return {
        "trap": row.key,
        **{name: getattr(row, name) for name in ("title", "cause", "documented", "script")},
        "silent": "yes" if row.silent else "no",
        "reports": case.said,
        **{n: getattr(case, n) for n in ("case", "error", "driver", "driver_error", "steps")},
        **gates,
    }
