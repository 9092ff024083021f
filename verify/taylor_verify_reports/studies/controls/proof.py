"""Sentences that the stored controls prove: every name and number in them is computed from the rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Final

from taylor_verify.records.status import Status
from taylor_verify.words.cells import INFINITE
from taylor_verify.words.markdown import bold, prose
from taylor_verify_reports.studies.controls.sight import Sight

MAIN: Final = ("omega", "impulse")

# Errors of equal roundings in two runs differ by at most this factor.
_ALIKE: Final = 2
_SPELLINGS: Final = {"nan": "NaN", "munk": "Munk"}


def proven(sights: Sequence[Sight]) -> list[str]:
    """Return the sentences that are true of these rows."""
    finished = [sight for sight in sights if sight.is_finished]
    sentences = [
        _energy_alone(finished),
        _conservation_together(finished),
        "Omega or impulse, attitude and centre together see "
        f"{_seeing(finished, lambda sight: sight.state)} of {len(finished)}; all conserved quantities "
        f"together see {_seeing(finished, lambda sight: sight.conserved)}.",
        f"{len(finished)} of {len(sights)} report success: a solver's own report is no evidence."
        if finished
        else "",
        _all_caught(sights),
    ]
    return [sentence for sentence in sentences if sentence]


def _energy_alone(sights: Sequence[Sight]) -> str:
    """Return how many defects the gate of the energy passes."""
    blind = [sight for sight in sights if sight.is_missed_by("T")]
    if not blind:
        return ""
    worse = [sight for sight in blind if not _keeps_energy_like_its_twin(sight)]
    exact = f"All but {_names(worse)}" if worse else "All of them"
    return (
        f"{bold(f'{len(blind)} of {len(sights)} defects pass the gate of the energy')}: "
        f"{_names(blind)}. {exact} conserve it to the last digit, as well as the sound solver beside "
        "them."
    )


def _keeps_energy_like_its_twin(sight: Sight) -> bool:
    drift, sound = sight.verdicts["T"].max, sight.sound["T"].max
    return drift is not None and sound is not None and drift <= _ALIKE * sound


def _conservation_together(sights: Sequence[Sight]) -> str:
    """Return how many defects all gates on conserved quantities pass together."""
    blind = conserving(sights)
    if not blind:
        return "Every defect shows in some conserved quantity."
    listed = []
    for sight in blind:
        over = (sight.over_bound(name) for name in sight.state if sight.is_seen_by(name))
        listed.append(f"{title(sight)} ({_short(max(map(or_infinite, over)))})")
    return (
        f"{bold(f'{len(blind)} pass every gate on a conserved quantity')} that their scene has, "
        "vectors in space included where there are any, although their state is wrong, by these "
        f"multiples of the bound of its gate: {_listed(listed)}. "
        f"{bold('No gate on conserved quantities certifies a state, nor do all of them together.')}"
    )


def conserving(sights: Iterable[Sight]) -> list[Sight]:
    """Return the defects that pass every gate on a conserved quantity and fail one on the state."""
    return [
        sight
        for sight in sights
        if _is_conserving(sight) and any(sight.is_seen_by(name) for name in sight.state)
    ]


def _is_conserving(sight: Sight) -> bool:
    return all(sight.is_missed_by(name) for name in sight.conserved)


def _seeing(sights: Iterable[Sight], quantities: Callable[[Sight], Iterable[str]]) -> int:
    """Return the number of defects that a gate of one of the quantities sees."""
    return sum(any(map(sight.is_seen_by, quantities(sight))) for sight in sights)


def _all_caught(sights: Sequence[Sight]) -> str:
    """Return that every defect is seen and every twin is sound, or the names of the others."""
    unseen = [sight for sight in sights if sight.is_finished and not sight.seen_by]
    faulty = {
        sight.defect.sound_solver
        for sight in sights
        if any(verdict.verdict is not Status.PASS for verdict in sight.sound.values())
    }
    if unseen:
        return f"{bold('Not seen by any gate')}: {_names(unseen)}."
    if faulty:
        return f"{bold('A sound twin fails')}: {_listed(sorted(faulty))}."
    return (
        "Every defect is caught by at least one gate, and every sound twin passes all of its gates."
    )


def _names(sights: Iterable[Sight]) -> str:
    return _listed([title(sight) for sight in sights])


def _listed(words: Sequence[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def title(sight: Sight) -> str:
    """Return the name of a defect in words."""
    return prose(" ".join(_SPELLINGS.get(word, word) for word in sight.defect.name.split("-")))


def times_bound(sight: Sight, quantity: str) -> str:
    """Return the error over the bound in two digits: NaN for a NaN error, infinity if the bound is zero."""
    over = sight.over_bound(quantity)
    if over is None:
        return "NaN" if sight.verdicts[quantity].max is None else INFINITE
    return _short(over)


def _short(value: float) -> str:
    """Return a number in two digits: 1.0, 42, 2.1e9."""
    if 0.1 <= abs(value) < 100:
        return f"{value:.2g}" if abs(value) >= 10 else f"{value:.1f}"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def constant_shift(sight: Sight) -> float | None:
    """Return the constant shift of time that explains the error of the main quantity; None without one.

    It is in the scene's unit of time, positive for a late answer.
    """
    for name in MAIN:
        verdict = sight.verdicts.get(name)
        if verdict is not None and sight.is_seen_by(name) and verdict.shift == "constant":
            return verdict.time_shift
    return None


def or_infinite(value: float | None) -> float:
    """Return the number; infinity for None, which is above every number."""
    return math.inf if value is None else value
