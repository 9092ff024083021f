"""The truth: exact motions, conserved quantities and the condition of an orbit.

The room imports nothing of models, solvers or judge, because what it is compared with must not be part
of it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from taylor_verify import types
from taylor_verify.numbers.working_precision import in_turn


@in_turn
def exact(
    scene: types.Scene | str | os.PathLike[str],
    times: Iterable[Any],
    digits: int = 30,
    route: str | None = None,
) -> types.Motion:
    """Return the exact motion of a scene at given times.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    times
        Absolute times in the scene's unit: Fractions, integers, decimal text, or binary numbers, NumPy's
        among them, which are taken exactly. The initial state is at the scene's start.
    digits
        The number of significant digits of every vector.
    route
        ``arb`` (closed form in balls), ``mpmath`` (closed form by other formulas) or ``taylor`` (Taylor
        series in balls); ``arb`` where there is a closed form and else ``taylor``, unless given.

    Returns
    -------
    scenes.motion.Motion
        A row for each time, in body axes but for ``centre``: omega (n, 3), or linear_impulse and
        angular_impulse (n, 3), and, where tracked, attitude (n, 3, 3) from body to space and centre (n, 3).
        ``radius`` (n,) bounds the relative error of each vector: proven, or for ``mpmath`` as far as two
        precisions agree. Each number prints with all the ``digits``.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read, for what is no finite time, and no number of digits up to ten
        thousand.
    exact.solution.NoClosedForm
        Where the route asks for a closed form that is missing.
    exact.solution.Unsettled
        Where the digits cannot be had at every time. Its ``motion`` has the other rows; row k is that
        of ``times[places[k]]``.
    ValueError
        For what is no route.

    Notes
    -----
    The equations are Heinbockel (2.2.72) and Encyclopaedia Britannica, hydromechanics 48 (3), (4). The
    formulas of a closed form are named in exact.euler and exact.kirchhoff.
    """
    from taylor_verify.exact.printed import motion_at
    from taylor_verify.exact.request import check_digits, exact_times
    from taylor_verify.exact.route import solution
    from taylor_verify.records.faults import answers
    from taylor_verify.scenes.reading.reader import as_scene

    known, digits, asked = answers(
        partial(as_scene, scene), partial(check_digits, digits), partial(exact_times, times)
    )
    return motion_at(solution(known, route), asked, known.clock.start, digits)


@in_turn
def enclose(
    rates: Mapping[str, Any],
    start: Mapping[str, Any],
    times: Iterable[Any],
    digits: int = 30,
    begin: Any = 0,
) -> types.Motion:
    """Return the motion of your own equations at given times, with proven error bounds.

    Parameters
    ----------
    rates
        The derivative of each name by the time ``t``: a text in the expressions of loads, or a number, as
        in ``{"x": "v", "v": "-sin(x) + 0.1*cos(t)"}``. A literal is the decimal that it writes.
    start
        The number of each name at ``begin``: Fractions, integers, decimal text, ``"a/b"``, or binary
        numbers, which are taken exactly.
    times
        Times on the clock ``t``, before and after ``begin``, as those of `exact`.
    digits
        The number of significant digits of every number, relative to its largest size so far.
    begin
        The time of the start.

    Returns
    -------
    scenes.motion.Motion
        An array (n,) for each name. ``errors`` bounds the error of every entry; ``radii`` bounds it
        relative to ``peaks``, a lower bound of the largest size of the number up to its row, and
        ``radius`` (n,) is the widest of a row. All of them are proven.

    Raises
    ------
    records.faults.Refused
        For texts, names and numbers with faults: all of them at once. For what is no finite time, and no
        number of digits up to ten thousand.
    exact.solution.Unsettled
        Where a time is not reached: the text says how far the motion is followed and why it ends there.
        Its ``motion`` has the rows before; row k is that of ``times[places[k]]``.

    Notes
    -----
    The method is that of exact.enclosure: Taylor series in balls, with a bound of all that they leave out.
    """
    from dataclasses import replace

    from taylor_verify.exact.field import Field
    from taylor_verify.exact.printed import motion_at
    from taylor_verify.exact.request import check_digits, exact_time, exact_times
    from taylor_verify.records.faults import answers
    from taylor_verify.scenes.reading.field import field_of

    loads, asked, digits, first = answers(
        partial(field_of, rates, start),
        partial(exact_times, times),
        partial(check_digits, digits),
        partial(exact_time, begin, "begin"),
    )
    return motion_at(Field(replace(loads, origin=first)), asked, first, digits)


@in_turn
def events(
    scene: types.Scene | str | os.PathLike[str], text: str, until: Any, digits: int = 30
) -> types.Events:
    """Return all times of an event between the start of a scene and a time, with proof that none is missed.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    text
        ``EXPRESSION = VALUE`` or ``extremum EXPRESSION``, in the expressions of loads: ``"w2 = 0"``,
        ``"extremum r33"``. Names are those of loads, the scene's own, and T, H2 (euler) or T, F2, FG
        (kirchhoff); x.y is the product of two vectors.
    until
        The end of the span, on the clock of the scene; it may be before the start.
    digits
        The number of significant digits of every time.

    Returns
    -------
    exact.event_times.Events
        The enclosed times, in the order of the motion. Each has ``t`` and ``radius``, an absolute bound:
        there is exactly one event within it. ``undecided`` are intervals in which a zero may be touched,
        or several may lie. ``passed`` says that there are none of these.

    Raises
    ------
    records.faults.Refused
        For a scene or a text that cannot be read, and for an expression that jumps. For what is no finite
        time, and no number of digits up to ten thousand.
    exact.event_times.Incomplete
        Where the motion is not followed to the end of the span, or the expression has no value on the way:
        an Unsettled whose ``events`` are all up to ``events.until``.
    exact.solution.Unsettled
        Where the times cannot be had to so many digits.
    """
    from taylor_verify.exact.event_times import events_of
    from taylor_verify.exact.request import check_digits, exact_time
    from taylor_verify.records.faults import answers
    from taylor_verify.scenes.reading.reader import as_scene

    known, end, digits = answers(
        partial(as_scene, scene), partial(exact_time, until, "until"), partial(check_digits, digits)
    )
    return events_of(known, text, end, digits)
