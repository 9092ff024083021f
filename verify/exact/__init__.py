"""The truth: exact motions, conserved quantities and the condition of an orbit.

The room is callable: `verify.exact(scene, times, digits)`. How a motion changes with its start and its
body: `verify.exact.sensitivity.sensitivity(scene, times_elapsed, digits)`. The room imports nothing of
models, solvers or judge, because what it is compared with must not be part of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from verify.callable_module import make_callable

if TYPE_CHECKING:
    from verify.scenes.motion import Motion
    from verify.scenes.scene import Scene


def exact(
    scene: Scene | str, times: Sequence[Any], digits: int = 30, route: str | None = None
) -> Motion:
    """The exact motion at absolute times, to ``digits`` significant digits of every vector.

    Times are Fractions, integers or decimal text, in the scene's unit; the initial state is at the
    scene's start. The Motion has a row for each time, in body axes but for ``centre``, and a ``radius``:
    proven, or for ``mpmath`` that to which two precisions agree. ``route`` is ``arb`` (closed form in
    balls), ``mpmath`` (closed form by other formulas) or ``taylor`` (Taylor series in balls); by default
    ``arb`` where there is a closed form, else ``taylor``. The equations are Heinbockel (2.2.72) and
    Encyclopaedia Britannica, hydromechanics 48 (3), (4); the formulas of a closed form are named in
    exact.euler and exact.kirchhoff.

    Raises scenes.faults.Refused for a scene that cannot be read, exact.solution.NoClosedForm where the
    route asks for a closed form that is missing, exact.solution.Unsettled where the digits cannot be
    had, and ValueError for a text that is no time.
    """
    from verify.exact.ellipsoid import formed_to
    from verify.exact.route import solution
    from verify.scenes.reader import load

    scene = load(scene) if isinstance(scene, str) else scene
    elapsed = [Fraction(time) - scene.clock.start for time in times]
    return solution(formed_to(scene, digits), route).motion(elapsed, digits)


make_callable(__name__, exact)
