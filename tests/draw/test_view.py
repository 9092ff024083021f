"""Views of bodies, and the curves on them: hidden where hidden, and true to the motion."""

from __future__ import annotations

import numpy as np
import pytest
from builders.trajectories import document
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.draw import axis_path, polhode
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.view import Ellipsoid, View

angles = st.floats(-180, 180)
heights = st.floats(-80, 80)
lengths = st.floats(0.2, 5)


@given(angles, heights, st.lists(lengths, min_size=3, max_size=3))
def test_a_view_keeps_lengths_across_it(azimuth: float, elevation: float, p: list[float]) -> None:
    """Right, up and towards the viewer are a right-handed frame: what is seen lacks the depth alone."""
    view = View(azimuth, elevation)
    assert np.abs(view.frame @ view.frame.T - np.eye(3)).max() <= 1e-12
    assert np.linalg.det(view.frame) == pytest.approx(1)
    point = np.array(p)
    across, depth = view.project(point)[0], float(view.towards @ point)
    assert across @ across + depth**2 == pytest.approx(point @ point)


@given(angles, heights, st.tuples(lengths, lengths, lengths), angles, heights)
def test_what_faces_the_viewer_is_what_a_ray_to_him_leaves_the_body_from(
    azimuth: float, elevation: float, semi_axes: tuple[float, float, float], a: float, b: float
) -> None:
    """A point of the surface is seen if and only if a short way towards the viewer leads outside."""
    view, surface = View(azimuth, elevation), Ellipsoid(semi_axes)
    q = View(a, b).towards
    point = q * np.array(semi_axes)
    ahead = (point + 1e-4 * min(semi_axes) * view.towards) / np.array(semi_axes)
    slope = float(q / np.array(semi_axes) @ view.towards)
    if abs(slope) > 1e-3 / min(semi_axes):
        assert bool(surface.faces(point, view)[0]) == bool(ahead @ ahead > 1)


@given(angles, heights, st.tuples(lengths, lengths, lengths))
def test_the_outline_is_on_the_surface_and_nothing_is_seen_beyond_it(
    azimuth: float, elevation: float, semi_axes: tuple[float, float, float]
) -> None:
    """The rim's points are on the surface with their normal across the view, and no circle is wider."""
    view, surface = View(azimuth, elevation), Ellipsoid(semi_axes)
    rim = surface.outline(view)
    assert np.abs(np.square(rim / np.array(semi_axes)).sum(axis=1) - 1).max() <= 1e-9
    normal = rim / np.square(semi_axes)
    across = np.abs(normal @ view.towards) / np.linalg.norm(normal, axis=1)
    assert across.max() <= 1e-9
    widest = np.abs(view.project(rim)).max(axis=0)
    for pole in np.eye(3):
        # The rim has a corner every two degrees.
        assert (np.abs(view.project(surface.circle(pole))).max(axis=0) <= 1.001 * widest).all()


# Curves


@pytest.mark.parametrize("scene", ["euler/generic", "euler/separatrix", "euler/full-tensor"])
def test_a_polhode_is_on_its_ellipsoid(scene: str) -> None:
    """All points have length one in units of the semi-axes, because the energy is conserved."""
    series = polhode.surface(document(scene))
    for points in (series.course, *(curve.points for curve in series.curves)):
        q = points / np.array(series.semi_axes)
        assert np.abs(np.square(q).sum(axis=1) - 1).max() <= 1e-7


def test_the_separatrix_scene_runs_along_a_separatrix() -> None:
    """The course of the separatrix scene lies in the plane of a curve, that of a plain scene in none."""

    def distance(scene: str) -> float:
        series = polhode.surface(document(scene))
        q = series.course / np.array(series.semi_axes)
        curves = [curve.points / np.array(series.semi_axes) for curve in series.curves]
        normals = [np.cross(curve[0], curve[40]) for curve in curves]
        return min(float(np.abs(q @ n).max() / np.linalg.norm(n)) for n in normals)

    assert distance("euler/separatrix") <= 1e-7
    assert distance("euler/generic") >= 0.1


@pytest.mark.parametrize(
    ("scene", "what"),
    [
        ("kirchhoff/whole-motion", "free rigid body"),
        ("manufactured/euler-tones", "free rigid body"),
        ("euler/rest", "a body that turns"),
    ],
)
def test_a_scene_without_a_polhode_is_refused(scene: str, what: str) -> None:
    """A fluid, a moment that changes with time, or no motion at all: there is no such surface."""
    with pytest.raises(NotDrawn, match=f"{what}.* @ {scene}"):
        polhode.surface(document(scene))


@pytest.mark.parametrize(
    ("scene", "axis"),
    [
        ("kirchhoff/whole-motion", 3),
        ("kirchhoff/oblate-about-axis-1", 1),
        ("euler/with-attitude", 1),
        ("euler/about-max-axis", 1),
        ("manufactured/kirchhoff-path", 3),
    ],
)
def test_the_axis_is_that_of_the_motion(scene: str, axis: int) -> None:
    """The axis is that of symmetry or of the polhode; the momentum of a free motion is marked."""
    series = axis_path.surface(document(scene))
    assert series.name == f"body axis {axis}"
    assert np.abs(np.linalg.norm(series.course, axis=1) - 1).max() <= 1e-7
    assert (not series.marks) == scene.startswith("manufactured")
