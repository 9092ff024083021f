"""Likely causes of an answer to a damped scene: the damping laws of engines, each by its name."""

from __future__ import annotations

from collections.abc import Callable
from math import exp
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID as BODY
from builders.caused_rows import rigid, titles
from builders.integrators import Kick, engine, implicit, none
from builders.turns import by_turns
from builders.wrong_dynamics import Array, Columns, Numbers, Rate, causes, runge_kutta, simulated

from taylor_verify.scenes.reading.reader import load

RIGID, FLUID = "euler/damped", "kirchhoff/damped"
# Of a step of damping c h = x.
EXPLICIT: Callable[[float], float] = lambda x: 1 - x  # noqa: E731 (a law in a row of a table)
IMPLICIT: Callable[[float], float] = lambda x: 1 / (1 + x)  # noqa: E731
EXPONENTIAL: Callable[[float], float] = lambda x: exp(-x)  # noqa: E731


def left_out(n: Numbers) -> None:
    n.damping = 0.0


def turned_round(n: Numbers) -> None:
    n.damping = -n.damping


def doubled(n: Numbers) -> None:
    n.damping = 2 * n.damping


def in_degrees(n: Numbers) -> None:
    n.damping *= np.pi / 180


def in_other_degrees(n: Numbers) -> None:
    n.damping *= np.pi / 200


def of_velocity(n: Numbers) -> Rate:
    """The rates with c times omega, or U and W, for c times the momenta."""

    def rate(z: Array, q: Array, n: Numbers) -> Array:
        from builders.wrong_dynamics import euler, kirchhoff

        c, n.damping = n.damping, 0.0
        free = (euler if len(z) == 3 else kirchhoff)(z, q, n)
        n.damping = c
        taken = np.linalg.solve(n.tensor, z) if len(z) == 3 else n.tensor @ z
        return free - c * taken

    return rate


@pytest.mark.parametrize(
    ("scene", "change", "name"),
    [
        (RIGID, left_out, "damping left out"),
        pytest.param(RIGID, turned_round, "damping with the other sign", marks=pytest.mark.slow),
        (RIGID, doubled, "damping"),
        (FLUID, left_out, "damping left out"),
        (RIGID, in_degrees, "damping of omega in radians for degrees"),
        pytest.param(RIGID, in_other_degrees, "damping", marks=pytest.mark.slow),
        pytest.param(FLUID, doubled, "damping", marks=pytest.mark.slow),
    ],
)
def test_a_wrong_damping_is_named(scene: str, change: Callable[[Numbers], None], name: str) -> None:
    """Damping left out, turned round or doubled has its name, and no other."""
    assert set(causes(load(scene), simulated(load(scene), change=change))) == {name}


@pytest.mark.parametrize("scene", by_turns([RIGID, FLUID], 2))
def test_damping_of_the_velocity_is_named(scene: str) -> None:
    """A moment -c omega in place of -c I omega, or -c U and -c W in a fluid, has its name, and no other."""
    sentences = causes(load(scene), simulated(load(scene), of_velocity(Numbers(load(scene)))))
    assert set(sentences) == {"damping of the velocity"}


@pytest.mark.parametrize("first", by_turns([False, True], 2))
@pytest.mark.parametrize(
    ("factor", "name", "words"),
    [
        (EXPLICIT, "explicit damping step", "1 - c h"),
        (IMPLICIT, "implicit damping step", "1/(1 + c h)"),
        (EXPONENTIAL, "exponential damping step", "exp(-c h)"),
    ],
)
def test_the_factor_of_a_step_is_named(
    factor: Callable[[float], float], name: str, words: str, first: bool
) -> None:
    """A factor once in a step has its law, its place, the step and c in the only sentence."""
    h, scene = 0.1, load(RIGID)
    sentences = causes(scene, runge_kutta(scene, h, 10, factor=factor, factor_first=first))
    (sentence,) = sentences.values()
    place = "before" if first else "after"
    law = f"{name}: omega times {words} {place} the motion of each step of h = {h}, with c = 0.05"
    assert sentence.startswith(law)


@pytest.mark.parametrize("scene", by_turns([RIGID, FLUID], 2))
def test_a_sound_integrator_has_no_cause(scene: str) -> None:
    """The classical method with damping in its rates, and a fine one, are named for nothing."""
    assert causes(load(scene), simulated(load(scene))) == {}
    assert not {
        name for name in causes(load(scene), runge_kutta(load(scene), 0.1, 5)) if "damping" in name
    }


# Scenes without damping: an engine that has it once in each step, as many have by default.
FREE, LOADED = "euler/with-attitude", "euler/constant-moment"
C, H = 0.05, 0.05
OF_ENGINES = {
    "1 - c h": ("explicit", 1 - C * H),
    "1/(1 + c h)": ("implicit", 1 / (1 + C * H)),
    "(1 - c)^h": ("exponential", (1 - C) ** H),
}


def stepped(scene: str, factor: float) -> dict[str, str]:
    """The causes of the classical method with a factor of the momenta after each step."""
    return causes(load(scene), runge_kutta(load(scene), H, 4, factor=lambda _: factor))


@pytest.mark.parametrize(
    ("scene", "law"), by_turns([(scene, law) for law in OF_ENGINES for scene in (FREE, LOADED)], 2)
)
def test_damping_that_no_scene_has_is_named_with_its_step(scene: str, law: str) -> None:
    """A factor once in a step has its law, h and c, which is short in one law alone, and explains all."""
    name, factor = OF_ENGINES[law]
    words = f"omega times {law} after the motion of each step of h = {H:g}, with c = {C:g}; "
    assert any(
        sentence.startswith(f"{name} damping step: {words}")
        for sentence in stepped(scene, factor).values()
    )


def test_a_factor_that_is_short_in_no_law_is_that_of_any() -> None:
    """The value of c cannot be told, and the sentence says so."""
    assert any(
        sentence.startswith("damping step: omega times 1 - c h, or 1/(1 + c h) or exp(-c h) by ")
        for sentence in stepped(FREE, 1 - 0.0512345 * H).values()
    )


def damped_anew(n: Numbers) -> None:
    n.damping = C


@pytest.mark.parametrize("scene", [FREE, LOADED])
def test_damping_in_the_rates_is_no_damping_of_steps(scene: str) -> None:
    """Continuous damping, and steps of a method without any, have no factor of a step."""
    names = causes(load(scene), simulated(load(scene), change=damped_anew))
    assert set(names) == {"damping"}
    coarse = causes(load(scene), runge_kutta(load(scene), 0.2, 1))
    assert not any("damping" in name for name in coarse)


def stepping(kick: Kick, factor: float) -> Columns:
    """Rows of an engine: a step of H/10 moves omega, takes a factor of it, and turns by the new omega."""
    return engine(FREE, lambda *given: factor * kick(*given), H / 10, 401, 10)


@pytest.mark.parametrize(
    ("kick", "words"),
    [
        (none, "without the gyroscopic term"),
        (implicit, "beside one Newton step of backward Euler"),
    ],
)
def test_damping_beside_the_gyroscopic_terms_of_engines_is_named(kick: Kick, words: str) -> None:
    """Engines leave the gyroscopic term out, or take it by one Newton step, and damp by default."""
    sentences = causes(load(FREE), stepping(kick, 1 - C * H / 10))
    law = f"explicit damping step: omega times 1 - c h after the motion of each step of h = {H / 10:g}"
    assert any(each.startswith(f"{law}, {words}, with c = {C:g};") for each in sentences.values())
    assert any("turned by the rate at the end" in each for each in sentences.values())


def test_a_free_coast_with_a_factor_of_no_law_has_no_step() -> None:
    """The step of a body that coasts shows by a short number alone: without one, none is said."""
    sentences = causes(load(FREE), stepping(none, 1 - 0.0512345 * H / 10))
    assert not any("of each step" in each for each in sentences.values())


WEAK: dict[str, Callable[[float], float]] = {
    "of power 1.5": lambda speed: 0.004 * speed**0.5,
    "of power 1.2": lambda speed: 0.004 * speed**0.2,
    "Coulomb": lambda speed: 0.003 / speed,
    "of a logarithm": lambda speed: 0.003 * np.log1p(speed),
    "linear and by the speed": lambda speed: 0.002 + 0.003 * speed,
}


@pytest.mark.parametrize("digits", by_turns([12, 7], 2))
@pytest.mark.parametrize("law", by_turns([*WEAK], 2))
def test_two_drags_that_imitate_another_law_are_not_said(
    law: str, digits: int, tmp_path: Path
) -> None:
    """Two drags fit any law where |w| hardly changes: what they leave shows which law has two."""
    made = rigid(moment=lambda t, w, q: -WEAK[law](float(np.linalg.norm(w))) * w)
    printed = {name: [float(f"{x:.{digits}g}") for x in column] for name, column in made.items()}
    names = titles(tmp_path, BODY.format(load=""), printed)
    is_shown = law == "linear and by the speed"
    assert any("drag" in each and "|w|" in each for each in names) == is_shown


NAMED = {1.0: "one drag on all rates of turn = 0.0003", 2.0: "moment -k |w| w, with k = 0.0003"}


@pytest.mark.parametrize("digits", by_turns([7, 6], 2))
@pytest.mark.parametrize("power", [0.0, 0.5, 1.0, 1.5, 2.0])
def test_no_drag_hides_in_the_rounding(power: float, digits: int, tmp_path: Path) -> None:
    """The attitude adds up what the rounding of omega hides: another power of the speed has no name."""
    made = rigid(moment=lambda t, w, q: -0.0003 * float(np.linalg.norm(w)) ** (power - 1) * w)
    printed = {name: [float(f"{x:.{digits}g}") for x in column] for name, column in made.items()}
    expected = [NAMED[power]] if power in NAMED else []
    assert titles(tmp_path, BODY.format(load=""), printed) == expected
