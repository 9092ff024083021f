"""Document of plain calls of heyoka that are wrong silently."""

from __future__ import annotations

from dataclasses import dataclass, field

from taylor_verify.records.provenance import Machine


@dataclass(frozen=True)
class TrapGate:
    """A gate on the plain answer: its verdict, and the largest error over its bound."""

    verdict: str
    over_bound: float | None


@dataclass(frozen=True)
class TrapCase:
    """A measured use of the plain call, and of the driver on the same scene.

    ``said`` is what heyoka reports and ``driver`` what the driver does. ``error`` and ``driver_error``
    are relative to the size of the true answer; None where nothing is returned that could have one.
    ``gates`` are the judge's on the plain answer, by quantity.
    """

    case: str
    said: str
    error: float | None
    driver: str
    driver_error: float | None = None
    steps: int | None = None
    gates: dict[str, TrapGate] = field(default_factory=dict)


@dataclass(frozen=True)
class TrapRow:
    """A trap: ``code`` that was run, ``where`` an address, ``script`` the minimal reproduction."""

    key: str
    title: str
    code: str
    plain: str
    driver: str
    cause: str
    silent: bool
    documented: str
    where: str
    remark: str
    script: str
    cases: tuple[TrapCase, ...]


@dataclass(frozen=True)
class TrapsStudy:
    """All traps, with the versions that they were measured with."""

    versions: dict[str, str]
    machine: Machine
    factor: int
    traps: tuple[TrapRow, ...]
