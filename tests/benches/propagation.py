"""The driver beside heyoka: solving, posing, and the first solve of a body."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import product
from typing import Final

from builders.scenes import sampled

from benches.ratio import RESOLUTION, Action, Ratio, Side, Target
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor import driver
from taylor_verify.solvers.taylor.driver import Taylor, compiled, pays
from taylor_verify.solvers.taylor.heyoka_equations import equations
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.taylor.package import heyoka_cache_off
from taylor_verify_reports.studies.tradeoff.measurement import SCENES, UNTIL, scene_named

_RUNG: Final = rung("f64")
_SAMPLES: Final = 10_000
_SHORT: Final = tuple(name for name in SCENES if UNTIL not in name)
_LONG: Final = tuple(name for name in SCENES if UNTIL in name)
# Bodies with nothing but moments and a spin.
_PLAIN: Final = ("euler/generic", "euler/with-attitude")

# Loads without kinks, in one piece, and bodies without loads.
_WRITTEN: Final = (
    "loads/heavy-top",
    "loads/pd-wheels",
    "loads/magnetic-torquing",
    "extremes/euler-long-heavy-top",
    "euler/with-attitude",
)

_ADDED: Final = 0.3
_SHORT_SOLVE: Final = Target(
    1 + _ADDED,
    "what is made for a problem and one look at its rate are a part of the shortest ways",
)
_POSED: Final = Target(3e-4, "0.3 ms for moments and a spin: as long as some of the shortest ways")
_FIRST: Final = Target(
    2.0,
    "what is made once for a body costs no more than its way; compiling would be a hundred ways",
)


def plain(problem: Problem) -> Callable[[], object]:
    """Return heyoka's own call for a problem of which time 0 is a sample: no cap, no look, no outcome."""
    numbers = arithmetic(problem.rung)
    integrator = compiled(problem.form, problem.rung, None, pays(problem))
    start, parameters = map(numbers.array, (problem.initial_momenta, problem.parameters))
    grid = numbers.array(problem.times)
    assert grid[0] == 0

    def propagate() -> object:
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = parameters
        return integrator.propagate_grid(grid)

    return propagate


def users(problem: Problem) -> Callable[[], Callable[[], object]]:
    """Return what compiles heyoka as its user writes it: its own tolerance, mode and optimisation.

    Numbers are literals. What is returned goes the whole way. The problem has no kinks, and one piece.
    """
    numbers = [float(value) for value in problem.parameters]
    start = [float(value) for value in problem.initial_momenta]
    grid = arithmetic(problem.rung).array(problem.times)

    def compile_anew() -> Callable[[], object]:
        import heyoka as hy

        heyoka_cache_off()
        hy.llvm_state.clear_memcache()
        system = equations(problem.form, [hy.expression(number) for number in numbers])
        integrator = hy.taylor_adaptive(system, start)

        def propagate() -> object:
            integrator.time = 0.0
            integrator.state[:] = start
            return integrator.propagate_grid(grid)

        return propagate

    return compile_anew


def _user_over(name: str, solver: Taylor) -> tuple[Side, Side]:
    problem = pose(load(name), _RUNG)
    solver.solve(problem)
    return _call(partial(solver.solve, problem)), _call(users(problem)())


def _cold_over_user(name: str) -> tuple[Side, Side]:
    problem = pose(load(name), _RUNG)

    def cold() -> object:
        import heyoka as hy

        hy.llvm_state.clear_memcache()
        for cached in (compiled, driver.prepared_once):
            cached.cache_clear()
        return Taylor().solve(problem)

    return _call(cold), _call(lambda: users(problem)()())


def _call(work: Callable[[], object]) -> Action:
    return Action(lambda _: work())


def _known(problem: Problem) -> Action:
    """Return the solve of a problem for which the driver has compiled all that it ever compiles."""
    Taylor().solve(problem)
    return _call(partial(Taylor().solve, problem))


def _long_solve(name: str) -> Target:
    """Return the target of a scene beyond its own end."""
    scene = scene_named(name)
    share = load(name.partition(UNTIL)[0]).clock.elapsed[-1] / scene.clock.elapsed[-1]
    return Target(
        1 + RESOLUTION + _ADDED * float(share),
        "to a long way as much is added as to the short one; two hundredths are apart what is equal",
    )


def _solve_over_plain(name: str) -> tuple[Side, Side]:
    problem = pose(scene_named(name), _RUNG)
    return _known(problem), _call(plain(problem))


def _pose_over_plain(name: str) -> tuple[Side, Side]:
    # A scene remembers what was made of it: each is read anew.
    posed = Action(lambda scene: pose(scene, _RUNG), partial(load, name))
    return posed, _call(plain(pose(load(name), _RUNG)))


def _both_over_plain(name: str) -> tuple[Side, Side]:
    def work(scene: Scene) -> object:
        return Taylor().solve(pose(scene, _RUNG))

    scene = sampled(load(name), _SAMPLES)
    both = Action(work, partial(sampled, load(name), _SAMPLES))
    return both, _call(plain(pose(scene, _RUNG)))


def _first_over_second(name: str) -> tuple[Side, Side]:
    known = _known(pose(load(name), _RUNG))
    return Action(Taylor().solve, lambda: pose(load(name), _RUNG)), known


def _each(
    group: str,
    names: Iterable[str],
    about: str,
    sides: Callable[[str], tuple[Side, Side]],
    target: Callable[[str], Target | None],
    unit: str = "solve",
) -> Iterator[Ratio]:
    for name in names:
        title = f"{group}/{name.replace(UNTIL, '-to-')}"
        yield Ratio(title, about, partial(sides, name), target(name), unit=unit)


def ratios() -> Iterator[Ratio]:
    """Yield what the driver adds to heyoka, in the order of the trade-off's scenes."""
    about = (
        "a solve of a problem that the driver knows, over heyoka's call with the same integrator"
    )
    yield from _each("solve", _SHORT, about, _solve_over_plain, lambda name: _SHORT_SOLVE)
    yield from _each("solve", _LONG, about, _solve_over_plain, _long_solve)
    about = "the first solve of a body whose equations are compiled, over a further one"
    yield from _each("first-solve", _SHORT, about, _first_over_second, lambda name: _FIRST)
    for name, code in product(_WRITTEN, ("quick", "optimised")):
        about = f"a solve with {code} code, over heyoka's call as its user writes it"
        sides = partial(_user_over, solver=Taylor(is_optimised=code == "optimised"))
        yield from _each(f"user-{code}", [name], about, sides, lambda name: _SHORT_SOLVE)
    about = "a first solve, code compiled, over heyoka's as its user writes it"
    yield from _each("user-first", _WRITTEN, about, _cold_over_user, lambda name: _SHORT_SOLVE)
    about = "posing a body that was just read, over heyoka's call for it"
    for name in _SHORT:
        limit, pair = _POSED if name in _PLAIN else None, partial(_pose_over_plain, name)
        yield Ratio(f"pose/{name}", about, pair, limit=limit, unit="body")
    about = f"posing and solving with {_SAMPLES:,} samples, over heyoka's call for as many"
    some = _SHORT[0], _SHORT[2]
    yield from _each("samples", some, about, _both_over_plain, lambda name: None, "propagation")
