"""The origin of a document: the versions, the machine and the command that made it."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Provenance:
    """The versions of all packages used, the processor's name and the command line."""

    versions: dict[str, str] = field(default_factory=dict)
    processor: str = ""
    command: str = ""


@dataclass(frozen=True, kw_only=True)
class Machine:
    """The machine of a measurement; only times depend on it."""

    python: str = ""
    processor: str = ""
    command: str = ""
