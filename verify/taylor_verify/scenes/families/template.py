"""A template becomes a family of scenes, or is refused with all its faults at once.

A template is a scene file in which a number may be a table: ``{ uniform = [1, 3] }``. The table
``[sweep]`` says how many points are drawn, and has numbers that formulas use.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, shown
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.scenes.families.cube import Spread
from taylor_verify.scenes.families.family import Family, Variable
from taylor_verify.scenes.families.formula import Formula
from taylor_verify.scenes.families.rules import KINDS, UNIT, rule
from taylor_verify.scenes.families.toml_text import toml
from taylor_verify.scenes.families.trial import place_of, trial_faults
from taylor_verify.scenes.reading.reader import MOST_BYTES, parsed
from taylor_verify.scenes.reading.table import Table

SWEEP: Final = "sweep"
DIGITS: Final = 6
MOST_DIGITS: Final = 15  # a share has 53 bits
MOST_POINTS: Final = 10**9
LARGEST_SEED: Final = 2**63 - 1
_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_SLOT: Final = re.compile("\0(\\d+)\0")
# A word this near to the name of a distribution is meant as one.
_NEAR: Final = 0.7
# The reader of scenes says this of a table whose distribution is not known.
_TABLE_FOR_NUMBER: Final = "expected a finite number, got a table @ "


def load_family(file: Path) -> Family:
    """Return the family of a template file.

    Raises Refused with every fault of the template and of the scene that it is made of.
    """
    content = read_bytes(file, "a readable template", MOST_BYTES)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise Refused(
            [f"expected a readable template, got bytes that are not UTF-8 @ {file}"]
        ) from None
    return read_family(text, file.stem, str(file))


def read_family(text: str, name: str, place: str = "") -> Family:
    """Return the family that this text describes. Raises Refused with every fault of the text.

    ``place`` is the file that faults of the whole text name, or by default the name of the family.
    """
    return _Reading(text, name, place or name).family()


class _Slot(int):
    """The place of a variable among all, where a number stood."""


class _Reading:
    """The reading of one template: its variables in the order in which they are drawn."""

    def __init__(self, text: str, name: str, place: str) -> None:
        self._text, self._name, self._place = text, name, place
        self._document = parsed(text, place)
        self._faults = Faults()
        self._variables: list[Variable] = []
        # Paths of variables that are not known, because of a fault.
        self._faulty: list[str] = []
        # Tables of the scene that stand for no known number, by place.
        self._tables: dict[str, Mapping[str, Any]] = {}
        self._digits = DIGITS

    def family(self) -> Family:
        table = self._document.pop(SWEEP, {})
        options = self._options(table)
        scene = {key: self._with_slots(value, key) for key, value in self._document.items()}
        title = scene.get("title")
        family = Family(
            name=self._name,
            title=title if isinstance(title, str) else "",
            pieces=tuple(_pieces(toml(scene, _number))),
            variables=tuple(self._variables),
            source=self._text,
            **options,
        )
        of_scene = self._of_scene(family)
        if not self._variables and not self._faulty:
            mend = "{ uniform = [1, 3] } in place of a number"
            self._faults.add("a number that is drawn", "none", self._place, mend)
        faults = [*self._faults.lines, *of_scene]
        if faults:
            raise Refused(faults)
        return family

    # The table [sweep].

    def _options(self, entries: object) -> dict[str, Any]:
        if not isinstance(entries, dict):
            self._faults.add("a table", shown(entries), SWEEP)
            return {}
        table = Table(entries, SWEEP, self._faults)
        options = {
            "count": self._whole(table, "count", 1, MOST_POINTS),
            "seed": self._whole(table, "seed", 0, LARGEST_SEED),
            "spread": self._spread(table),
        }
        self._digits = self._whole(table, "digits", 1, MOST_DIGITS) or DIGITS
        numbers = table.take("numbers", "a table") if table.has("numbers") else {}
        table.close()
        if not isinstance(numbers, dict):
            self._faults.add("a table", shown(numbers), f"{SWEEP}.numbers")
            return options
        for name, value in numbers.items():
            self._named(name, value)
        return options

    def _whole(self, table: Table, key: str, least: int, most: int) -> int | None:
        if not table.has(key):
            return None
        value = table.take(key, "a whole number")
        if isinstance(value, int) and not isinstance(value, bool) and least <= value <= most:
            return value
        self._faults.add(f"a whole number from {least} to {most}", shown(value), f"{SWEEP}.{key}")
        return None

    def _spread(self, table: Table) -> str | None:
        if not table.has("points"):
            return None
        value = table.take("points", "a word")
        known = [each.value for each in Spread]
        if value in known:
            return str(value)
        self._faults.add(f"one of {', '.join(known)}", shown(value), f"{SWEEP}.points")
        return None

    def _named(self, name: str, value: object) -> None:
        place = f"{SWEEP}.numbers.{name}"
        if not _NAME.fullmatch(name):
            expected = "a name of letters, digits and underscores that begins with a letter"
            self._faults.add(expected, shown(name), place)
        elif not isinstance(value, dict):
            expected = "a table such as { uniform = [1, 3] }"
            self._faults.add(expected, shown(value), place)
            self._faulty.append(name)
        else:
            self._variable(name, value, place, is_named=True)

    # Numbers.

    def _with_slots(self, value: Any, place: str) -> Any:
        """Return a value of the scene with a slot for every table that stands for a number."""
        if isinstance(value, list):
            return [self._with_slots(entry, f"{place}[{i}]") for i, entry in enumerate(value)]
        if not isinstance(value, dict):
            return value
        if _is_rule(value):
            return self._variable(place, value, place)
        self._tables[place] = value
        return {key: self._with_slots(entry, f"{place}.{key}") for key, entry in value.items()}

    def _variable(
        self, path: str, entries: Mapping[str, Any], place: str, is_named: bool = False
    ) -> int:
        """Add the variable that a table writes; return its slot, or 1 after a fault."""
        known = {v.path for v in self._variables if v.is_named}
        made = rule(entries, place, self._digits, known | set(self._faulty), self._faults)
        unit = entries.get(UNIT, "")
        if not isinstance(unit, str) or (unit and is_named):
            self._faults.add("a unit where the number stands", shown(unit), f"{place}.{UNIT}")
            made = None
        names = made.names if isinstance(made, Formula) else frozenset()
        if made is None or names & set(self._faulty):
            self._faulty.append(path)
            return 1
        self._variables.append(Variable(path, made, unit, is_named))
        return _Slot(len(self._variables) - 1)

    # The scene.

    def _of_scene(self, family: Family) -> list[str]:
        """Return the faults of the scene, without those that a faulty variable may have caused."""
        return [self._of_number(fault) for fault in trial_faults(family, self._faulty)]

    def _of_number(self, fault: str) -> str:
        """Return the fault of a table that stands for a number; any other fault as it is."""
        entries = self._tables.get(place_of(fault))
        if entries is None or not fault.startswith(_TABLE_FOR_NUMBER):
            return fault
        self._faulty.append(place_of(fault))
        faults = Faults()
        rule(entries, place_of(fault), self._digits, (), faults)
        return faults.lines[0]


def _is_rule(entries: Mapping[str, Any]) -> bool:
    """Return True for a table that stands for a number, well written or not."""
    if any(key in KINDS for key in entries):
        return True
    return len(entries) == 1 and any(
        difflib.get_close_matches(key, KINDS, n=1, cutoff=_NEAR) for key in entries
    )


def _pieces(text: str) -> Iterator[str | int]:
    """Yield the text between slots, and the number of each slot."""
    for i, piece in enumerate(_SLOT.split(text)):
        if piece:
            yield int(piece) if i % 2 else piece


def _number(value: Any) -> str:
    if isinstance(value, _Slot):
        return f"\0{int(value)}\0"
    # Python writes no integer of so many digits in tens; only a hexadecimal literal is as long.
    return hex(value) if isinstance(value, int) and value.bit_length() > 4096 else str(value)
