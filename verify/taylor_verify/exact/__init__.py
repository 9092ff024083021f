"""The truth: exact motions, conserved quantities and the condition of an orbit.

The room imports nothing of models, solvers or judge, because what it is compared with must not be part
of it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from taylor_verify.numbers.working_precision import in_turn

if TYPE_CHECKING:
    import os

    from taylor_verify.scenes.motion import Motion
    from taylor_verify.scenes.scene import Scene


@in_turn
def exact(
    scene: Scene | str | os.PathLike[str],
    times: Iterable[Any],
    digits: int = 30,
    route: str | None = None,
) -> Motion:
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
        precisions agree.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read.
    exact.solution.NoClosedForm
        Where the route asks for a closed form that is missing.
    exact.solution.Unsettled
        Where the digits cannot be had at every time. Its ``motion`` has the other rows; row k is that
        of ``times[places[k]]``.
    ValueError
        For what is no finite time, no number of digits up to ten thousand, no route.

    Notes
    -----
    The equations are Heinbockel (2.2.72) and Encyclopaedia Britannica, hydromechanics 48 (3), (4). The
    formulas of a closed form are named in exact.euler and exact.kirchhoff.
    """
    from taylor_verify.exact.request import check_digits, exact_times
    from taylor_verify.exact.route import solution
    from taylor_verify.scenes.reading.reader import as_scene

    scene, digits = as_scene(scene), check_digits(digits)
    elapsed = [time - scene.clock.start for time in exact_times(times)]
    return solution(scene, route).motion(elapsed, digits)
