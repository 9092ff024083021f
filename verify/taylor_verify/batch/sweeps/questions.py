"""The scenes of a sweep, each by its number: points of a family, or the files of a folder."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from math import inf
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import Refused, refusal
from taylor_verify.scenes.families.cube import Spread, places
from taylor_verify.scenes.families.family import Family, Place
from taylor_verify.scenes.families.shipped import family, is_family
from taylor_verify.scenes.families.template import MOST_POINTS, load_family
from taylor_verify.scenes.library import find, named
from taylor_verify.scenes.reading.reader import load, text_of
from taylor_verify.scenes.scene import Scene

COUNT: Final = 100
SEED: Final = 1
_MOST_FAULTS: Final = 100


class Question(NamedTuple):
    """A scene of a sweep: its number, its name, and the numbers that were drawn for it.

    ``scene`` is the refusal where the numbers make no body.
    """

    number: int
    name: str
    scene: Scene | Refused
    drawn: Mapping[str, float | None]


@dataclass(frozen=True)
class Drawn:
    """Points of a family; every drawn point is combined with every point of the grid."""

    family: Family
    count: int
    seed: int
    spread: Spread

    @property
    def name(self) -> str:
        return self.family.name

    @property
    def title(self) -> str:
        return self.family.title

    @property
    def total(self) -> int:
        """The number of scenes."""
        return self.count * self.family.nodes

    @property
    def drawn(self) -> tuple[str, ...]:
        """The names of the numbers that are drawn or come from a grid."""
        return tuple(v.path for v in self.family.variables if v.is_free)

    @property
    def digest(self) -> str:
        """A digest of all that the scenes depend on."""
        return sha256(self.family.source.encode()).hexdigest()

    @property
    def described(self) -> dict[str, Any]:
        """The caller's choices, for the record."""
        return {"count": self.count, "seed": self.seed, "points": self.spread.value}

    def part(self, first: int, stop: int) -> Drawn:
        """Return what a worker needs for the scenes with these numbers."""
        return self

    def questions(self, first: int, stop: int) -> Iterator[Question]:
        """Yield the scenes with these numbers."""
        for number, place, node in self._places(first, stop):
            name = f"{self.name}#{number}"
            drawn: Mapping[str, float | None] = dict.fromkeys(self.drawn)
            scene: Scene | Refused
            try:
                numbers = self.family.numbers(place, node)
                drawn = self.family.drawn(numbers)
                scene = self.family.scene_of(numbers, name)
            except Refused as refused:
                scene = refused
            yield Question(number, name, scene, drawn)

    def examples(self) -> Iterator[Scene]:
        """Yield a scene with the quantities that all scenes have."""
        for number in range(self.total):
            (question,) = self.questions(number, number + 1)
            if isinstance(question.scene, Scene):
                yield question.scene
                return

    def text(self, number: int) -> str:
        """Return the scene file of one number."""
        ((_, place, node),) = self._places(number, number + 1)
        return self.family.text(place, node)

    def _places(self, first: int, stop: int) -> Iterator[tuple[int, Place, int]]:
        """Yield these numbers, each with its drawn place and its point of the grid."""
        nodes = self.family.nodes
        low, high = first // nodes, -(-stop // nodes)
        points = places(self.spread, self.family.free, self.seed, low, high)
        for number in range(first, stop):
            draw, node = divmod(number, nodes)
            yield number, points[draw - low], node


@dataclass(frozen=True)
class Listed:
    """Scenes in files, in the order of their names; a part of them has its scenes already read."""

    name: str
    files: tuple[str, ...]
    digest: str = ""
    scenes: tuple[Scene, ...] = field(default=(), repr=False)
    begin: int = 0

    title = ""
    drawn: tuple[str, ...] = ()

    @cached_property
    def total(self) -> int:
        """The number of scenes."""
        return len(self.files)

    @property
    def described(self) -> dict[str, Any]:
        """The caller's choices, for the record."""
        return {"count": self.total, "seed": None, "points": None}

    def part(self, first: int, stop: int) -> Listed:
        """Return what a worker needs for the scenes with these numbers: no file of this machine."""
        files = self.files[first:stop]
        return replace(self, files=files, scenes=tuple(map(load, files)), begin=first)

    def questions(self, first: int, stop: int) -> Iterator[Question]:
        """Yield the scenes with these numbers."""
        part = self if self.scenes else self.part(first, stop)
        for number in range(first, stop):
            scene = part.scenes[number - part.begin]
            yield Question(number, scene.name, scene, {})

    def examples(self) -> Iterator[Scene]:
        """Yield scenes that have between them all quantities."""
        return map(load, self.files)

    def text(self, number: int) -> str:
        """Return the scene file of one number."""
        return text_of(find(self.files[number]))


Questions = Drawn | Listed


def questions(
    what: str, count: int | None = None, seed: int | None = None, spread: str | None = None
) -> Questions:
    """Return the scenes that a word stands for: a family, a template, or a folder of scenes.

    What is not given is what the template says, else 100 points that are drawn with the seed 1.

    Raises
    ------
    records.faults.Refused
        For a template, or scenes of a folder, with all their faults, and for a name that is none.
    ValueError
        For a number of points or a seed that is none, and for either beside a folder.
    """
    path = Path(what)
    if path.suffix == ".toml" or path.is_file():
        return _drawn(load_family(path), count, seed, spread)
    if path.is_dir():
        files = sorted(str(f) for f in path.glob("*.toml") if not f.stem.isupper())
        return _listed(what, files, count, seed, spread)
    if not is_family(what) and (shipped := named(what)) != (what,):
        return _listed(what, shipped, count, seed, spread)
    return _drawn(family(what), count, seed, spread)


def _drawn(family: Family, count: int | None, seed: int | None, spread: str | None) -> Drawn:
    faults = []
    if count is not None and not is_whole(count, 1, MOST_POINTS):
        faults.append(f"expected a whole number from 1 to {MOST_POINTS}, got {count!r} @ count")
    if seed is not None and not is_whole(seed, 0, 2**63 - 1):
        faults.append(f"expected a whole number from 0 to 2^63 - 1, got {seed!r} @ seed")
    known = [each.value for each in Spread]
    if spread is not None and spread not in known:
        faults.append(f"expected one of {', '.join(known)}, got {spread} @ points")
    if not family.free:
        faults += _needless(count, seed, spread, "a grid, where nothing is drawn")
    if faults:
        raise ValueError("\n".join(faults))
    drawn = (count or family.count or COUNT) if family.free else 1
    if (total := drawn * family.nodes) > MOST_POINTS:
        each = f"{drawn} points, each with {family.nodes} of the grid" if drawn > 1 else "a grid"
        raise ValueError(f"expected at most {MOST_POINTS} bodies, got {total} ({each}) @ count")
    chosen = seed if seed is not None else family.seed
    return Drawn(
        family,
        drawn,
        chosen if chosen is not None else SEED,
        Spread(spread or family.spread or Spread.RANDOM),
    )


def _needless(count: object, seed: object, spread: object, what: str) -> list[str]:
    """Return a sentence for each option that is given, where it means nothing."""
    asked = {"count": count, "seed": seed, "points": spread}
    return [
        f"expected no {key} for {what}, got {value} @ {key}"
        for key, value in asked.items()
        if value is not None
    ]


def is_whole(value: object, least: int, most: float = inf) -> bool:
    """Return True for a whole number from ``least`` to ``most``; a boolean is none."""
    return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most


def _listed(name: str, files: Any, count: object, seed: object, spread: object) -> Listed:
    if faults := _needless(count, seed, spread, "a folder of scenes"):
        raise ValueError("\n".join(faults))
    if not files:
        raise refusal("a folder with scenes (*.toml)", "none", name)
    digest, lines = sha256(), list[str]()
    for file in files:
        try:
            digest.update(f"{file} {load(file).digest}\n".encode())
        except Refused as refused:
            lines += [f"{file} is refused:", *refused.faults]
        if len(lines) > _MOST_FAULTS:
            break
    if lines:
        raise Refused(lines)
    return Listed(name, tuple(files), digest.hexdigest())
