"""The search for likely causes: rows and times first, then conventions and starts, then equations.

Only what is proven on the whole answer is said. To add a fault: add it to the list of its kind (terms.py,
other_bodies.py, changed_texts.py, misread_states.py, replayed_methods.py, kinematics.py, paths.py,
inexact_conventions.py, stamps.py), a broken twin to the tests, a line to docs/verdicts.md.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes import starts
from taylor_verify.judge.causes.arcs import row_to_row
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.dynamics import Dynamics
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.in_space_axes import in_world
from taylor_verify.judge.causes.inexact_conventions import readings
from taylor_verify.judge.causes.kinematics import kinematics
from taylor_verify.judge.causes.limits import bounds
from taylor_verify.judge.causes.numbers_and_states import in_numbers, in_states
from taylor_verify.judge.causes.other_readings import attitudes, rates, with_omega
from taylor_verify.judge.causes.parts_of_a_run import causes_in_pieces, of_part
from taylor_verify.judge.causes.paths import contradicts
from taylor_verify.judge.causes.printed_bodies import printed_by_another_body
from taylor_verify.judge.causes.proof import are_explained, left_of_all, may_leave, whole
from taylor_verify.judge.causes.quaternion_rows import matrices
from taylor_verify.judge.causes.settled import PAIR
from taylor_verify.judge.causes.spoiled_rows import are_saved_twice, wrong_rows
from taylor_verify.judge.causes.stamps import other_times
from taylor_verify.words.causes import with_numbers

# An attitude so many times better than omega refutes every equation.
_CONTRADICTED: Final = 1e-3
_PROVEN: Final = 0.1
_SLIGHT: Final = 1e-6
_ROUNDINGS: Final = 10.0
_FEWEST: Final = 6
_OF_PIECES: Final = frozenset({"own start", "jump at the start", "jump", "at rest"})
# A convention that begins within the run has at least this part of its largest error at once.
_AT_ONCE: Final = 0.03
# The truth has left the start if it is so many roundings of the file away.
_LEFT: Final = 30.0
# Faults that are too many for this part of the work leave the rest to methods.
_TO_FAULTS: Final = 3 / 4
# So many arcs over a switch are no single switch that comes late.
_SEVERAL: Final = 3
_MOST_WRONG: Final = 0.75


def causes_of(answer: Answer) -> list[Cause]:
    """Return the proven causes of the failures of an answer."""
    if not answer.failed or answer.count < _FEWEST:
        return []
    whole_answer = wrong_rows(answer) or other_times(answer)
    if whole_answer is not None:
        return [whole_answer]
    undone = _clock_undone(answer) or _saved_twice(answer)
    if undone:
        return undone
    by_group = readings(answer)
    if answer.has_states:
        return _each_once(by_group) or _some(in_states(answer))
    undone = _undone(answer, by_group)
    if undone:
        return undone
    if not by_group.keys() >= {*answer.moving} and (printed := printed_by_another_body(answer)):
        return [printed]
    # The vectors of one quantity fail together, also where the error is that of one of them.
    largest = max((answer.worst[name] for name in by_group if name in answer.groups), default=0.0)
    slight = {name for name in answer.groups if answer.worst[name] < _SLIGHT * largest}
    left = [name for name in answer.failed if name not in (*by_group, *slight)]
    causes = _each_once(by_group)
    if left == ["centre"]:
        causes += _some(contradicts(answer))
    if not left:
        return causes
    moving = [name for name in left if name in answer.groups]
    if moving and _is_attitude_right(answer, by_group) and _contradicts(answer, moving):
        words = "omega contradicts the file's own attitude, which is right"
        contradiction = Cause(words, "omega against attitude", {})
        return [*causes, *(_read_from_some_row(answer) or [contradiction])]
    if not causes:
        causes = _of_motion(answer, moving, "attitude" in left) or _in_space(answer)
        return causes or _read_from_some_row(answer)
    with suppress(Spent):
        of_motion = _of_motion(answer, moving, "attitude" in left)
        # What the motion explains with all else is no convention.
        is_all = bool(of_motion) and are_explained(answer, of_motion[-1].leaves)
        causes = of_motion if is_all else [*causes, *of_motion]
    return causes


def _read_from_some_row(answer: Answer) -> list[Cause]:
    """Return the conventions of all rows behind some right ones, where they begin at once."""
    failed = answer.failed
    is_wrong = [answer.error[name] > _LEFT * answer.roundings[name] for name in failed]
    first = int(np.argmax(np.any(is_wrong, axis=0)))
    begins_at_once = any(
        answer.error[name][first] > _AT_ONCE * answer.worst[name] for name in failed
    )
    if not (first and begins_at_once and answer.count - first >= _FEWEST):
        return []
    rest = answer.at(np.s_[first:])
    by_group = readings(rest)
    if by_group.keys() != set(rest.failed):
        return []
    where = f"from t = {rest.times[0] + answer.right.start:.6g} on"
    return [replace(cause, where=where) for cause in _each_once(by_group)]


def _some(cause: Cause | None) -> list[Cause]:
    return [] if cause is None else [cause]


def _each_once(by_group: dict[str, Cause]) -> list[Cause]:
    """Return the causes of groups; one of several groups is one object."""
    return list({id(cause): cause for cause in by_group.values()}.values())


def _is_attitude_right(answer: Answer, by_group: dict[str, Cause]) -> bool:
    return answer.file.q is not None and ("attitude" not in answer.failed or "attitude" in by_group)


def _contradicts(answer: Answer, moving: list[str]) -> bool:
    attitude = answer.worst["attitude"]
    return answer.n == 3 and "omega" in moving and attitude < _CONTRADICTED * answer.worst["omega"]


def _of_motion(answer: Answer, moving: list[str], has_wrong_attitude: bool) -> list[Cause]:
    """Return the causes in the motion, and in the attitude given the motion."""
    causes: list[Cause] = []
    cause = None
    if has_wrong_attitude and _turns_too_little(answer):
        moving = []
    if moving:
        causes = _of_moving_part(answer)
        cause = causes[-1] if causes else None
    if not has_wrong_attitude:
        return causes
    if cause is not None and cause.is_whole and _left(cause) <= _enough(answer, cause):
        return causes
    is_slight = cause is not None and max(answer.worst[name] for name in moving) < (
        _CONTRADICTED * answer.worst["attitude"]
    )
    if is_slight:
        of_attitude = _with_attitude(answer, None, [])
        # The steps of a method explain the little that the attitude does not.
        steps = [each for each in causes if each.method is not None] if of_attitude else []
        return [*steps, *of_attitude]
    if cause is None and moving:
        return causes
    return _with_attitude(answer, cause, causes)


def _enough(answer: Answer, cause: Cause) -> float:
    """Return what a cause of the motion may leave of the attitude before that is asked by itself."""
    return _PROVEN if cause.kind in _OF_PIECES else may_leave(answer, ["attitude"], 1)


def _of_moving_part(answer: Answer) -> list[Cause]:
    """Return the causes of the moving part: a fault without numbers is nearer than a part of the run."""
    search, simple, are_all = Dynamics(answer), None, False
    with answer.budget.share(_TO_FAULTS):
        simple = search.without_numbers()
        are_all = True
    if not are_all:
        return _some(search.of_steps())
    if simple is None:
        defects = starts.roundings(answer)
        # Another pulse is nearer than a part of the run without it.
        wrong = starts.wrong_arcs(defects)
        has_parts = len(answer.right.switches) > 0 or bool(bounds(answer.right.loads))
        is_part = has_parts and 0 < 2 * len(wrong) < len(defects)
        of_part = (
            _over_switches(answer, search, wrong) or in_numbers(answer, wrong) if is_part else None
        )
        causes = _some(of_part)
        causes = causes or causes_in_pieces(answer, defects, causes_of) or _some(search.cause())
        return causes or _from_own_start(answer)
    with suppress(Spent):
        return _some(search.cause() or simple)
    return [simple]


def _over_switches(answer: Answer, search: Dynamics, wrong: Places) -> Cause | None:
    """Return the method whose steps go over the switches, where each of several wrong arcs has one."""
    if len(wrong) < _SEVERAL or np.mean(row_to_row(answer).have_switch[wrong]) < _MOST_WRONG:
        return None
    with answer.budget.share(1 / 4):
        return search.of_steps()
    return None


def _from_own_start(answer: Answer) -> list[Cause]:
    """Return another start and the causes of the motion from there; none if the first row is right."""
    if not starts.has_own_start(answer):
        return []
    part = starts.piece(answer, 0, answer.count - 1)
    is_reached = not starts.has_own_start(part)
    causes = _of_motion(part, list(part.moving), "attitude" in part.failed) if is_reached else []
    if any(max(cause.leaves.values(), default=1.0) > PAIR for cause in causes):
        return []
    return _beside(
        Cause("another start", "own start", {}),
        [of_part(answer, part, cause, "") for cause in causes],
    )


def _turns_too_little(answer: Answer) -> bool:
    """Return True if the error of omega, over the whole run, turns less than the attitude is wrong."""
    if answer.n == 6:
        return False
    span = float(np.max(np.abs(answer.times - answer.begins)))
    turn = answer.worst["omega"] * float(answer.sizes[0]) * span
    return turn < _CONTRADICTED * answer.worst["attitude"]


def _with_attitude(answer: Answer, cause: Cause | None, causes: list[Cause]) -> list[Cause]:
    is_stepped = cause is not None and cause.method is not None
    # Steps alone are steps of the scene; beside a fault they are steps of the changed one.
    changes = {} if cause is None or cause.kind == "method" else cause.changes
    right = answer.right.changed(changes)
    of_attitude = kinematics(answer, right, None if cause is None else cause.method)
    if cause is not None and is_stepped:
        # The steps of the motion explain the attitude, or another update does, or the sentence says so.
        leaves = {"attitude": 1.0, **cause.leaves}
        left = leaves.pop("attitude")
        if of_attitude is None:
            leaves["attitude"] = left
        causes = [replace(each, leaves=leaves) if each is cause else each for each in causes]
    if of_attitude is not None:
        of_clock = _by_clock(answer, of_attitude)
        # A clock beside two faults is farther than one fault of the motion and one of the attitude.
        is_single = cause is not None and cause.kind != "pair"
        if of_clock and not (is_single and any(each.kind == "pair" for each in of_clock)):
            return of_clock
        if causes:
            # What is left of the motion is said of its own cause.
            own = {name: part for name, part in of_attitude.leaves.items() if name == "attitude"}
            of_attitude = replace(of_attitude, leaves=own)
        return [*causes, of_attitude]
    # An attitude that no cause explains refutes a cause that does not explain it.
    return causes if cause is None or _stands(cause) else [c for c in causes if c is not cause]


def _stands(cause: Cause) -> bool:
    """Return True if a cause may leave the attitude as it does: it is near, of steps or of a part."""
    return (cause.is_whole and _left(cause) <= _PROVEN) or _is_of_steps(cause)


def _left(cause: Cause) -> float:
    """Return the part of the attitude's error that a cause leaves."""
    return cause.leaves.get("attitude", 1.0)


def _is_of_steps(cause: Cause) -> bool:
    """Return True for the steps of a method, and for the motion in pieces."""
    return cause.method is not None or cause.kind in _OF_PIECES


def _by_clock(answer: Answer, of_attitude: Cause) -> list[Cause]:
    """Return causes by another clock, where the attitude shows its factor; none if there is no such clock.

    Alone it is as good as the factor of the attitude: the motion does not tell them apart.
    """
    turns = of_attitude.changes.get("turns")
    if of_attitude.kind != "kinematics" or turns is None or turns[0] or np.ndim(answer.right.clock):
        return []
    pace = float(turns[1])
    right = answer.right.changed({"clock": pace})
    words = with_numbers("clock", (), (1.0,), (pace,))
    if left_of_all(answer, right):
        return [replace(of_attitude, alike=(*of_attitude.alike, words))]
    if not answer.moving:
        return []
    causes = _of_moving_part(replace(answer, right=right))
    if causes and are_explained(answer, causes[-1].leaves):
        return _beside(Cause(words, "clock", {}), causes)
    return []


def _clock_undone(answer: Answer) -> list[Cause]:
    """Return the causes by the clock of a first row that is the start at another time."""
    late = float(answer.times[0]) - answer.begins
    if not late or answer.right.acting is not None or not _begins_at_start(answer):
        return []
    at_start = replace(answer, times=answer.times - late)
    truth = whole(replace(at_start, file=answer.truth), answer.right)
    if truth is None:
        return []
    how = f"late by {late:.6g}" if late > 0 else f"early by {-late:.6g}"
    where = f"with the clock {how}, as the first row shows"
    causes = causes_of(replace(at_start, truth=truth))
    return [replace(cause, where=": ".join(filter(None, (where, cause.where)))) for cause in causes]


def _saved_twice(answer: Answer) -> list[Cause]:
    """Return the causes of every second row where the others are the rows before them."""
    if not are_saved_twice(answer):
        return []
    causes = causes_of(answer.at(np.s_[::2]))
    where = "each row is saved twice; of every second row"
    return [replace(cause, where=": ".join(filter(None, (where, cause.where)))) for cause in causes]


def _begins_at_start(answer: Answer) -> bool:
    """Return True if the first row is the state of the start, and the truth has left it there."""
    start = replace(answer.start, v=answer.first(answer.right.mass)[None])
    of_file, of_truth = (
        replace(answer.at(np.s_[:1]), file=file.at(np.s_[:1]), truth=start).error
        for file in (answer.file, answer.truth)
    )
    is_start = all(of_file[name][0] <= _ROUNDINGS * answer.roundings[name] for name in of_file)
    has_left = any(of_truth[name][0] > _LEFT * answer.roundings[name] for name in of_file)
    return is_start and has_left


def _undone(answer: Answer, by_group: dict[str, Cause]) -> list[Cause]:
    """Return a convention that the first row shows, with the causes of what is left by it."""
    if "omega" in by_group and "attitude" in answer.failed and "attitude" not in by_group:
        own = starts.exact_in_pieces(answer, starts.roundings(answer))
        if own is not None and own.kind == "own start" and are_explained(answer, own.leaves):
            return [own]
        read = with_omega(answer, answer.truth.v[:, answer.groups["omega"]])
        return _beside(by_group["omega"], _of_motion(read, [], has_wrong_attitude=True))
    tried = {"attitude": attitudes(answer), "omega": rates(answer)}
    for name, readings_ in tried.items() if answer.is_from_start else ():
        if name in by_group or name not in answer.failed:
            continue
        if _is_right_at_first(answer, name):
            continue
        for words, read in readings_:
            if _is_right_at_first(read, name):
                convention = Cause(f"{name} {words}", "convention", {})
                if both := _beside(convention, causes_of(read)):
                    return both
    return []


def _is_right_at_first(answer: Answer, group: str) -> bool:
    return bool(answer.error[group][0] <= _ROUNDINGS * answer.roundings[group])


def _beside(convention: Cause, causes: list[Cause]) -> list[Cause]:
    """Return a convention and the causes that are proven by it; none without these."""
    with_that = [replace(cause, where=cause.where or "with that") for cause in causes]
    return [convention, *with_that] if causes else []


def _in_space(answer: Answer) -> list[Cause]:
    """Return causes of a motion whose omega, or whose equations, are in space axes."""
    q, start = answer.file.q, answer.start.q
    if q is None or start is None or answer.n == 6 or "omega" not in answer.failed:
        return []
    name, read = next(rates(answer))
    convention = Cause(f"omega {name}", "convention", {})
    if np.array_equal(read.file.v, answer.file.v):
        return []
    # Where the first row refutes the convention, only the equations may be in space axes.
    if not answer.is_from_start or _is_right_at_first(read, "omega"):
        causes = _of_motion(read, list(read.moving), "attitude" in answer.failed)
        if causes:
            return _beside(convention, causes)
    in_space = np.einsum("nij,nj->ni", matrices(q), answer.file.v)
    return _beside(convention, in_world(answer, answer.file.v)) or in_world(answer, in_space)
