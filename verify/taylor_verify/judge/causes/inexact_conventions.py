"""Conventions of a file that are no exact reading of its columns: signs, offsets, turned and moving frames.

All rows are compared with the truth, fewest numbers first. A convention without numbers leaves at most ten
roundings of the file, one with fitted numbers one and a half, or a part of the error that each reading has,
a millionth most often: the simulator has errors of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations, product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.lateness import late_rows
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.other_frames import (
    NEAR,
    degrees,
    frame_that_turns,
    is_near,
    is_of_steady_turn,
    mean_turn,
    other_columns,
)
from taylor_verify.judge.causes.paths import paths
from taylor_verify.judge.causes.proof import LEAVES
from taylor_verify.judge.causes.quaternion_rows import angles, conjugate, matrices
from taylor_verify.judge.causes.quaternion_rows import product as times
from taylor_verify.judge.conventions.axis_orders import quaternion_columns

# What a convention may leave, in roundings of a row; fitted numbers imitate others, as a delay a filter.
_ROUNDINGS: Final = 10.0
_ROUNDINGS_OF_FIT: Final = 1.5
_PART: Final = 1e-6
_MOST: Final = 0.03
# A limit is reached so often.
_OFTEN: Final = 3

# All signed permutations, those of signs alone first.
SIGNED: Final = tuple(
    sorted(
        (
            np.eye(3)[list(order)] * np.array(signs)[:, None]
            for order in permutations(range(3))
            for signs in product((1.0, -1.0), repeat=3)
        ),
        key=lambda P: (not np.array_equal(np.abs(P), np.eye(3)), int(np.sum(P < 0))),
    )
)
FACTORS: Final = {
    "degrees for radians": 180 / np.pi,
    "radians for degrees": np.pi / 180,
    "turns": 1 / (2 * np.pi),
    "turns per minute": 30 / np.pi,
    "knots": 3600 / 1852,
    "thousandths": 1e3,
    "thousands": 1e-3,
    "feet": 1 / 0.3048,
}
_THAT_TURNS: Final = "relative to a frame that turns, in space axes, at"
_FRAMES: Final = {
    "velocity": "is relative to a moving frame, with the velocity",
    "omega": f"is {_THAT_TURNS}",
}
_OF_RIGID_BODY: Final = "is that of the rigid body alone, without the added mass"
_ONCE_MORE: Final = "is turned by R^T once more: the file has it in body axes already"
_OF_ANGLES: Final = "is the rates of Euler angles, roll' pitch' yaw', and no body rates"
_TURNED: Final = "turned by a fixed rotation"
_NOUNS: Final = {
    "velocity": "the linear velocity",
    "centre": "the centre",
    "x": "the impulse x",
    "y": "the impulse y",
}


@dataclass(frozen=True)
class Reading:
    """A convention: the rows of a right file by it, the count of fitted numbers, and what it may leave."""

    name: str
    count: int
    rows: Floats
    part: float = _PART


def readings(answer: Answer) -> dict[str, Cause]:
    """Return the convention that explains each failed group, where there is one."""
    causes: dict[str, Cause] = {}
    for name in answer.failed:
        tried = _attitudes(answer) if name == "attitude" else _vectors(answer, name)
        near, least = [], _ROUNDINGS * answer.roundings[name]
        for place, reading in enumerate(tried):
            left = _left(answer, name, reading.rows)
            most = _ROUNDINGS_OF_FIT if reading.count else _ROUNDINGS
            bound = max(most * answer.roundings[name], reading.part * answer.worst[name])
            if left <= bound and left < _MOST * answer.worst[name]:
                # Of two that leave no more than roundings, the simpler one was tried first.
                near.append((reading.count, max(left, least), place, reading.name, left))
        if near:
            count = min(each[0] for each in near)
            same = sorted(each for each in near if each[0] == count)
            noun = _NOUNS.get(name, name)
            alike = [each for each in same[1:4] if each[1] <= max(10 * same[0][1], least)]
            causes[name] = Cause(
                f"{noun} {same[0][3]}",
                "convention",
                {name: same[0][4] / answer.worst[name]},
                alike=tuple(f"{noun} {each[3]}" for each in alike),
            )
    omega = causes.get("omega")
    is_alone = "attitude" in answer.failed and "attitude" not in causes
    if omega is not None and is_alone and "turned by a fixed" in omega.name:
        # An axisymmetric body of the other sign looks like a turn.
        del causes["omega"]
    for one in (_one_turn, _one_frame, _one_body):
        causes |= one(answer, causes)
    return causes


def _one_turn(answer: Answer, causes: Mapping[str, Cause]) -> dict[str, Cause]:
    """Return one cause for velocities and attitude if the same turn of the body's axes explains them."""
    q, truth, names = answer.file.q, answer.truth.q, (*answer.moving, "attitude")
    if not (answer.has_rates and answer.moving and _all(causes, names, _TURNED)):
        return {}
    assert q is not None
    assert truth is not None
    turn = mean_turn(times(conjugate(truth), q))
    rows = {name: _group(answer, name)[1] @ matrices(turn)[0] for name in answer.moving}
    words = f"the body's axes are {_TURNED} of {degrees(turn[0]):.4g} degrees"
    nouns = " and ".join(_NOUNS.get(name, name) for name in names)
    return _one(
        answer, f"{words}, in {nouns} alike", {"attitude": times(truth, turn), **rows}, _PART
    )


def _one_frame(answer: Answer, causes: Mapping[str, Cause]) -> dict[str, Cause]:
    """Return one cause for omega and attitude if both are relative to the same frame that turns."""
    q, truth = answer.file.q, answer.truth.q
    if not (answer.has_rates and _all(causes, ("omega", "attitude"), _THAT_TURNS)):
        return {}
    assert q is not None
    assert truth is not None
    rate, turned = frame_that_turns(answer, q, truth)
    omega = _group(answer, "omega")[1] - matrices(truth).transpose(0, 2, 1) @ rate
    words = f"omega and attitude are {_THAT_TURNS} {numbers(rate)}"
    return _one(answer, words, {"omega": omega, "attitude": turned}, LEAVES)


def _one_body(answer: Answer, causes: Mapping[str, Cause]) -> dict[str, Cause]:
    """Return one cause for both impulses if they are those of the body without its added mass."""
    if not _all(causes, ("x", "y"), _OF_RIGID_BODY):
        return {}
    leaves = {**causes["x"].leaves, **causes["y"].leaves}
    words = "the impulses x and y are those of the rigid body alone, without the added mass"
    return dict.fromkeys(leaves, Cause(words, "convention", leaves))


def _all(causes: Mapping[str, Cause], names: Sequence[str], words: str) -> bool:
    return all(name in causes and words in causes[name].name for name in names)


def _one(answer: Answer, words: str, rows: Mapping[str, Floats], part: float) -> dict[str, Cause]:
    """Return a cause for several groups by their rows; none if one of them is not explained."""
    left = {name: _left(answer, name, own) for name, own in rows.items()}
    if any(
        each > max(_ROUNDINGS * answer.roundings[name], part * answer.worst[name])
        for name, each in left.items()
    ):
        return {}
    leaves = {name: each / answer.worst[name] for name, each in left.items()}
    return dict.fromkeys(leaves, Cause(words, "convention", leaves))


def _left(answer: Answer, name: str, rows: Floats) -> float:
    if name == "attitude":
        assert answer.file.q is not None
        return float(np.max(angles(answer.file.q, rows)))
    file, _, size = _group(answer, name)
    return float(np.max(np.linalg.norm(file - rows, axis=1))) / size


def _group(answer: Answer, name: str) -> tuple[Floats, Floats, float]:
    """Return the file's rows of a group of vectors, the truth, and the size of an error of 1."""
    size = 1.0 if name == "centre" else float(answer.sizes[answer.groups[name]][0])
    return answer.rows(answer.file, name), answer.rows(answer.truth, name), size


def numbers(values: Floats) -> str:
    """Return fitted numbers as text; what is nothing beside the others is 0."""
    size = float(np.max(np.abs(values))) or 1.0
    cut = [0.0 if abs(value) < 1e-6 * size else float(value) for value in np.atleast_1d(values)]
    return "(" + ", ".join(f"{value:.6g}" for value in cut) + ")"


def axes(P: Floats) -> str:
    """Return a signed permutation as the signed numbers of its axes."""
    places = np.argmax(np.abs(P), axis=1)
    return " ".join(
        f"{'-' if P[i, k] < 0 else ''}{k + 1}" for i, k in zip(range(3), places, strict=True)
    )


def _vectors(answer: Answer, name: str) -> Iterator[Reading]:
    file, truth, _ = _group(answer, name)
    assert answer.truth.q is not None
    R = matrices(answer.truth.q)
    is_centre = name == "centre"
    for P in SIGNED[1:]:
        yield Reading(_signs(P), 0, truth @ P.T)
    if not is_centre:
        in_space = np.einsum("nij,nj->ni", R, truth)
        yield Reading("is in space axes", 0, in_space)
        for P in SIGNED[1:]:
            yield Reading(f"is in space axes, as axes {axes(P)}", 0, in_space @ P.T)
        once_more = np.einsum("nji,nj->ni", R, truth)
        yield Reading(_ONCE_MORE, 0, once_more)
        for unit, factor in FACTORS.items():
            yield Reading(f"{_ONCE_MORE}, and in another unit: {unit}", 0, factor * once_more)
    if name == "velocity":
        yield from _by_current(answer.right.current, truth, R)
    if name in ("x", "y") and answer.right.added is not None:
        dry = answer.right.inverse.T @ (answer.right.mass - answer.right.added).T
        yield Reading(_OF_RIGID_BODY, 0, (answer.truth.v @ dry)[:, answer.groups[name]])
    for words, rows in paths(answer) if is_centre else ():
        yield Reading(words, 0, rows)
    for unit, factor in FACTORS.items():
        yield Reading(f"is in another unit: {unit}", 0, factor * truth)
    if name == "omega" and answer.n == 3:
        yield Reading("is I omega", 0, truth @ answer.right.mass.T)
    if name == "omega":
        yield Reading(_OF_ANGLES, 0, _rates_of_angles(truth, R))
    yield from _fitted(answer, name, file, truth, R)


def _by_current(current: Floats, truth: Floats, R: Floats) -> Iterator[Reading]:
    """Yield the velocities of a body that are not relative to the fluid, or are so twice."""
    if not any(current):
        return
    ground = np.einsum("nji,j->ni", R, current)
    in_space = np.einsum("nij,nj->ni", R, truth)
    over = "is over ground, not relative to the fluid"
    yield Reading(f"{over}: the current is added to it", 0, truth + ground)
    yield Reading(f"{over}, and in space axes: it is the rate of the centre", 0, in_space + current)
    yield Reading(f"{over}, and the current is not turned into body axes", 0, truth + current)
    yield Reading(
        "has the current taken off, though it is relative to the fluid", 0, truth - ground
    )


def _rates_of_angles(omega: Floats, R: Floats) -> Floats:
    """Return roll' pitch' yaw' of R = R_z(yaw) R_y(pitch) R_x(roll)."""
    (x, y, z), (p, q, r) = R[:, 2].T, omega.T
    level = np.hypot(y, z)
    yaw = (q * y + r * z) / level**2
    return np.array([p - yaw * x, (q * z - r * y) / level, yaw]).T


def _signs(P: Floats) -> str:
    flipped = np.flatnonzero(np.diag(P) < 0)
    if np.array_equal(np.abs(P), np.eye(3)):
        listed = " and ".join(str(i + 1) for i in flipped)
        return f"has the other sign on axis {listed}" if len(flipped) < 3 else "has the other sign"
    return f"has other axes: {axes(P)}"


def _fitted(answer: Answer, name: str, file: Floats, truth: Floats, R: Floats) -> Iterator[Reading]:
    is_centre, unit = name == "centre", np.eye(3)
    factor = np.sum(file * truth) / max(float(np.sum(truth * truth)), 1e-300)
    yield Reading(f"has the factor {factor:.8g}", 1, factor * truth)
    for i in range(3):
        offset = np.mean(file[:, i] - truth[:, i])
        yield Reading(
            f"has a constant offset on axis {i + 1}: {offset:.6g}", 1, truth + offset * unit[i]
        )
    yield from _cut_off(file, truth)
    constant = [np.broadcast_to(axis, truth.shape) for axis in unit]
    p, rows = _best(file - truth, constant)
    yield Reading(f"has a constant offset {numbers(p)}", 3, truth + rows)
    p, rows = _best(file, [truth * axis for axis in unit])
    if not (name == "omega" and "attitude" in answer.failed):
        yield Reading(f"has factors {numbers(p)} on its axes", 3, rows)
    if is_centre or name in _FRAMES:
        p, rows = _best(file - truth, [R[:, :, i] if is_centre else R[:, i, :] for i in range(3)])
        words = "is the path of the body's point" if is_centre else _FRAMES[name]
        p = p if is_centre else -p
        # The Earth turns under simulators that are right to single precision.
        part = LEAVES if name == "omega" else _PART
        yield Reading(f"{words} {numbers(p)}", 3, truth + rows, part)
    if is_centre or name == "velocity":
        p, rows = _best(file - truth, [axis * answer.times[:, None] for axis in unit])
        yield Reading(f"drifts with the constant velocity {numbers(p)}", 3, truth + rows)
    if name == "velocity":
        omega = answer.truth.v[:, 3:]
        p, rows = _best(file - truth, [np.cross(omega, axis) for axis in unit])
        yield Reading(f"is that of another point of the body, at {numbers(p)}", 3, truth + rows)
    yield from _turned(file, truth, R, is_centre)
    for words, rows in late_rows(answer, name):
        yield Reading(words, 3, rows)


def _cut_off(file: Floats, truth: Floats) -> Iterator[Reading]:
    """Yield rows whose numbers are cut off at a limit that the file reaches often, as a sensor does."""
    limits = list[tuple[float, float, Any, str]]()
    for i, own in enumerate(np.eye(3, dtype=bool)):
        least, most = float(np.min(file[:, i])), float(np.max(file[:, i]))
        limits.append((-np.inf, most, own, f"on axis {i + 1} above {most:.6g}"))
        limits.append((least, np.inf, own, f"on axis {i + 1} below {least:.6g}"))
    limit = float(np.max(np.abs(file)))
    limits.append((-limit, limit, np.ones(3, dtype=bool), f"on all axes at {limit:.6g}"))
    for least, most, own, words in limits:
        if np.count_nonzero((file[:, own] == least) | (file[:, own] == most)) >= _OFTEN:
            rows = np.where(own, np.clip(truth, least, most), truth)
            yield Reading(f"is cut off {words}", 1, rows)


def _turned(file: Floats, truth: Floats, R: Floats, is_centre: bool) -> Iterator[Reading]:
    """Yield the best fixed rotation (Kabsch), in body and in space axes."""
    of_space = np.einsum("nij,nj->ni", R, truth)
    for words, rows in (("space" if is_centre else "body", truth), ("space", of_space))[
        : 1 if is_centre else 2
    ]:
        U, singular, V = np.linalg.svd(file.T @ rows)
        if singular[1] > 1e-6 * singular[0]:
            Q = U @ np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ V))]) @ V
            angle = np.degrees(np.arccos(np.clip((np.trace(Q) - 1) / 2, -1, 1)))
            yield Reading(
                f"is turned by a fixed rotation of {angle:.4g} degrees, {words} axes", 3, rows @ Q.T
            )


def _best(rows: Floats, columns: list[Floats]) -> tuple[Floats, Floats]:
    """Return the least-squares numbers of columns for rows, and the rows that they make."""
    matrix = np.array([column.ravel() for column in columns]).T
    scale = np.linalg.norm(matrix, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    p = np.linalg.lstsq(matrix / scale, rows.ravel(), rcond=1e-10)[0] / scale
    return p, (matrix @ p).reshape(rows.shape)


# Attitudes.


def _attitudes(answer: Answer) -> Iterator[Reading]:
    q, truth = answer.file.q, answer.truth.q
    assert q is not None
    assert truth is not None
    yield Reading(
        "is transposed, as a conjugate quaternion is: it takes space to body axes",
        0,
        conjugate(truth),
    )
    columns = other_columns(truth)
    for words, rows in columns.items():
        yield Reading(words, 0, rows)
    for words, rows in (("", truth), ("is transposed, and ", conjugate(truth))):
        for side, turn in (
            ("space", times(q, conjugate(rows))),
            ("body", times(conjugate(rows), q)),
        ):
            mean = mean_turn(turn)
            angle = degrees(mean[0])
            name = f"{words}has {side} axes turned by a fixed rotation of {angle:.4g} degrees"
            turned = (mean, rows) if side == "space" else (rows, mean)
            yield Reading(name, 3, times(*turned))
    # A quaternion with one component in the wrong place is that of other frames too, for no other reason.
    if not any(is_near(q, rows) for rows in columns.values()):
        yield from _both_frames(q, truth)
    rate, relative = frame_that_turns(answer, q, truth)
    # Another coupling of a solid in a fluid, B + c 1, turns the attitude as well, and moves the centre.
    if not (is_of_steady_turn(answer, rate) or "centre" in answer.failed):
        yield Reading(f"is {_THAT_TURNS} {numbers(rate)}", 3, relative)
    for words, rows in late_rows(answer, "attitude"):
        yield Reading(words, 3, rows)


def _both_frames(q: Floats, truth: Floats) -> Iterator[Reading]:
    """Yield S R P with a signed permutation P of the body's axes and a fixed S."""
    R, file = matrices(truth), matrices(q)
    for words, rows in (("", R), ("is transposed, and ", R.transpose(0, 2, 1))):
        for P in (P for P in SIGNED[1:] if np.linalg.det(P) > 0):
            S = file[0] @ P.T @ rows[0].T
            some = [len(rows) // 2, -1]
            if np.max(np.abs(S @ rows[some] @ P - file[some])) > NEAR:
                continue
            known = [s for s in SIGNED if np.max(np.abs(S - s)) < 1e-6]
            of_space = f"space axes {axes(known[0])}" if known else "space axes turned"
            rotations = quaternion_columns(S @ rows @ P)
            unit = rotations / np.linalg.norm(rotations, axis=1, keepdims=True)
            name = f"{words}has other frames: body axes {axes(P.T)}, {of_space}, q = E q F"
            yield Reading(name, 0 if known else 3, unit)
