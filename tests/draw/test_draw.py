"""The verb `draw`: every frame holds its motion, every file is whole, and what is wrong has one message."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import read_scene
from builders.trajectories import document, write_csv
from builders.turns import by_turns
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg

from taylor_verify.cli import main
from taylor_verify.draw import missing_load
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.components import series
from taylor_verify.draw.drawn_course import lengthened, motion, turns
from taylor_verify.draw.moving import moving, page
from taylor_verify.draw.pictures import KINDS, pictures
from taylor_verify.exact.row_arithmetic import quaternions
from taylor_verify.plotting.picture import plotting
from taylor_verify.records.answers import MissingLoad
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

# One of each kind of body, and what it has.
HAS = {
    "euler/tennis-racket": {"polhode", "time", "axis", "spheres"},
    "euler/separatrix": {"polhode", "time", "axis", "spheres"},
    "euler/damped": {"polhode", "time", "axis", "spheres"},
    "euler/damped-negative": {"polhode", "time", "axis", "spheres"},
    "euler/gyrostat": {"time", "axis", "spheres"},
    "euler/gyrostat-dual-spin": {"time", "axis", "spheres"},
    "euler/moment-along-axis": {"time", "axis"},
    "euler/rest": {"time", "axis"},
    "kirchhoff/whole-motion": {"time", "axis", "spheres", "path"},
    "kirchhoff/ellipsoid-prolate": {"time", "axis", "spheres", "path"},
    "manufactured/kirchhoff-path": {"time", "axis", "spheres", "path"},
}
EPS = 1e-6


@pytest.mark.parametrize("scene", by_turns(HAS, len(HAS), lambda scene: frozenset(HAS[scene])))
def test_a_scene_has_its_pictures(scene: str) -> None:
    """Each kind of body has the pictures that its motion has, and no other."""
    assert set(pictures(document(scene))) == HAS[scene]


@pytest.mark.parametrize("scene", by_turns(HAS, len(HAS), lambda scene: frozenset(HAS[scene])))
def test_every_frame_holds_its_motion(scene: str) -> None:
    """No line of a motion and no solid on it leaves its axes, and no text leaves the page."""
    with plotting():
        for name, picture in pictures(document(scene)).items():
            figure = picture.figure()
            FigureCanvasAgg(figure).draw()
            drawn = [shape for axes in figure.axes for shape in shapes(axes)]
            assert drawn, name
            for axes in figure.axes:
                box = axes.get_window_extent()
                for points in shapes(axes):
                    places = axes.transData.transform(points)
                    assert (places >= [box.x0 - EPS, box.y0 - EPS]).all(), name
                    assert (places <= [box.x1 + EPS, box.y1 + EPS]).all(), name
            page_box = figure.bbox
            for text in figure.findobj(match=lambda a: getattr(a, "get_gid", str)() == "name"):
                assert page_box.x0 <= text.get_window_extent().x0, name
                assert text.get_window_extent().x1 <= page_box.x1, name


def shapes(axes: Axes) -> list[np.ndarray[Any, Any]]:
    """Vertices of the lines and polygons that are the motion."""
    moves = {"course", "path", "solid", "start", "end", "scene"}
    lines = [line.get_xydata() for line in axes.lines if line.get_gid() in moves]
    solids = [patch.get_xy() for patch in axes.patches if patch.get_gid() in moves]
    return [np.asarray(points) for points in (*lines, *solids) if len(points)]


def test_a_body_whose_wheels_cancel_its_momentum_has_no_sphere() -> None:
    """H = I omega + h = 0 is no sphere, although nine digits of I omega leave a rounding."""
    cancelled = read_scene(
        'inertia = [3, 2, 1]\nrotor = [-1, "-2/3", "-1/7"]', 'omega = ["1/3", "1/3", "1/7"]'
    )
    with pytest.raises(NotDrawn, match="expected a momentum with a direction, got zero"):
        pictures(motion(cancelled, 60), ["spheres"])


# Moving


def rotations(quaternions: Any) -> np.ndarray[Any, Any]:
    """The matrices (n, 3, 3) of unit quaternions (n, 4), as the script of the page forms them."""
    w, x, y, z = np.array(quaternions).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


@pytest.mark.parametrize("scene", ["euler/tennis-racket", "kirchhoff/whole-motion"])
def test_quaternions_turn_as_their_matrices(scene: str) -> None:
    """Each quaternion is its attitude, and its neighbour is on the same side of the sphere."""
    attitudes = np.array(document(scene)["course"]["attitude"]).reshape(-1, 3, 3)
    q = quaternions(attitudes)
    assert np.abs(rotations(q) - attitudes).max() <= 1e-7
    assert (q[1:] * q[:-1]).sum(axis=1).min() >= 0


@pytest.mark.parametrize(
    "scene",
    ["euler/tennis-racket", "euler/nesc-brick", "loads/heavy-top", "kirchhoff/remus-100"],
)
def test_faces_of_a_body_look_outwards(scene: str) -> None:
    """Each prism of a body is closed: its faces' areas, as vectors, add to nothing."""
    areas = []
    for face in moving(document(scene))["faces"]:
        corners = np.array(face["p"])
        spokes = corners[1:] - corners[0]
        areas.append(np.cross(spokes[:-1], spokes[1:]).sum(axis=0))
        assert "n" not in face or areas[-1] @ np.array(face["n"]) > 0
    assert np.abs(np.sum(areas, axis=0)).max() <= 1e-2


def test_weight_points_downwards() -> None:
    """A top stands on its tip, the origin; its lid is where the weight acts, and the weight points down."""
    shown = moving(document("loads/heavy-top"))
    (weight,) = shown["hung"]
    at = np.array([0.3, 0.1, 0.5])
    assert weight["arrow"][2] < 0
    assert weight["arrow"][:2] == [0, 0]
    assert np.cross(weight["at"], at) == pytest.approx([0, 0, 0], abs=1e-3)
    assert np.min([np.linalg.norm(face["p"], axis=1).min() for face in shown["faces"]]) == 0


@pytest.mark.slow
def test_a_short_motion_is_animated_over_a_longer_span() -> None:
    """The span doubles until the body has turned twice; a motion with two turns stays as it is."""
    top = sampled(2)
    short, whole = motion(top, 20), lengthened(top, motion(top, 20))
    assert turns(np.array(short["course"]["attitude"]).reshape(-1, 3, 3)) < 2
    assert whole["course"]["t"][-1] in [2.0 * 2**k for k in range(1, 5)]
    racket = document("euler/tennis-racket")
    assert lengthened(load("euler/tennis-racket"), racket) is racket


def test_the_racket_flips_in_space() -> None:
    """H points upwards, and the two sides of the head change places at each flip."""
    racket = moving(document("euler/tennis-racket"))
    head = np.mean(
        [np.mean(face["p"], axis=0) for face in racket["faces"] if face["c"] == "plus"], axis=0
    )
    upwards = rotations(racket["quaternions"])[:, 2, :] @ head
    changes = np.flatnonzero(upwards[:-1] * upwards[1:] < 0)
    assert racket["arrow"]
    assert np.array(racket["times"])[changes] == pytest.approx(racket["flips"], abs=2.0)


@pytest.mark.parametrize("scene", HAS)
def test_nothing_moves_beyond_the_reach(scene: str) -> None:
    """Every corner of the body is within the reach of the picture at every time."""
    if scene == "euler/rest":
        with pytest.raises(NotDrawn, match="body at rest"):
            moving(document(scene))
        return
    shown = moving(document(scene))
    corners = np.concatenate([face["p"] for face in shown["faces"]])
    places = np.einsum("nij,kj->nki", rotations(shown["quaternions"]), corners)
    if shown["centres"] is not None:
        places += (np.array(shown["centres"]) - shown["middle"])[:, None, :]
    assert np.linalg.norm(places, axis=2).max() <= shown["reach"] * (1 + 1e-3)


def test_a_page_needs_no_network() -> None:
    """The page holds its script and its numbers, a row of each for each time, and names no address."""
    text = page(moving(document("euler/tennis-racket")))
    assert not re.search(r"https?://|src=|<link|@import", text)
    (data,) = re.findall(r'<script type="application/json" id="motion">(.*?)</script>', text)
    shown = json.loads(data)
    (panel,) = shown["panels"]
    columns = (shown["quaternions"], panel["rows"], shown["inset"]["course"])
    assert {len(column) for column in columns} == {len(shown["times"])}
    assert "exact, by closed form" in shown["caption"]


def sampled(samples: int) -> Scene:
    return read_scene(
        'inertia = [1, 2, 3]\nmoment = ["m - w1/4", "-i/8", "t"]',
        "omega = [0.5, 0.25, 0.125]",
        '[states]\nm = { every = "1/2", value = "-w1" }\ni = { start = 0, rate = "w2" }',
        f"end = 2\nsamples = {samples}",
    )


def test_loads_and_own_states_are_drawn_under_the_motion() -> None:
    """Each load and each state is a panel: the moment is what the text makes of the drawn states."""
    drawn = motion(sampled(5), 40)
    panels = {panel.name: panel for panel in series(drawn).panels}
    moment, held = panels["moment, body axes"].rows, panels["state m"]
    omega, times = np.array(drawn["course"]["omega"]), np.array(drawn["course"]["t"])
    assert np.allclose(moment[:, 0], held.rows[:, 0] - omega[:, 0] / 4, atol=1e-8)
    assert np.allclose(moment[:, 1], -panels["state i"].rows[:, 0] / 8, atol=1e-8)
    assert np.allclose(moment[:, 2], times, atol=1e-8)
    assert held.is_held
    assert len(np.unique(held.rows)) == len(np.arange(0, 2.5, 0.5))
    assert [each["heading"] for each in moving(drawn)["panels"]] == list(panels)


# The verb


def test_draw_writes_what_it_says(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every file named is there, whole, with what it shows; one picture alone has the name given."""
    assert main(["draw", "euler/axisymmetric", "--out", str(tmp_path / "g.svg"), "--json"]) == 0
    document_printed = json.loads(capsys.readouterr().out)
    assert [Path(one["file"]).name for one in document_printed["files"]] == [
        f"g-{name}.svg" for name in KINDS if name in HAS["euler/separatrix"]
    ]
    assert document_printed["evidence"] == "proven"
    for one in document_printed["files"]:
        assert one["shows"] in Path(one["file"]).read_text(encoding="utf-8").replace("&gt;", ">")
    alone = ["draw", "euler/axisymmetric", "--only", "time", "--out", str(tmp_path / "a.svg")]
    assert main(alone) == 0
    assert (tmp_path / "a.svg").exists()
    assert main(["draw", "euler/axisymmetric", "--animate", "--out", str(tmp_path / "a.html")]) == 0
    assert (tmp_path / "a.html").read_text(encoding="utf-8").endswith("</html>\n")


def test_errors_of_a_file_are_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The errors are those of the judgement, and the floor is beside them."""
    rows = document("euler/axisymmetric")["course"]
    omega = zip(("w1", "w2", "w3"), zip(*rows["omega"][::5], strict=True), strict=True)
    file = write_csv(tmp_path / "mine.csv", {"t": rows["t"][::5], **dict(omega)})
    out = tmp_path / "e.svg"
    asked = ["draw", "euler/axisymmetric", file, "--only", "errors", "--out", str(out)]
    assert main(asked) == 0
    # Nine digits were written.
    error = re.search(r"omega of \S+ at most (\S+?)[;.]\s", capsys.readouterr().out + " ")
    assert error is not None
    assert 1e-11 <= float(error[1]) <= 2e-9
    assert "roundoff floor" in out.read_text(encoding="utf-8")


def test_a_missing_load_is_kept_from_row_to_row() -> None:
    """Each load lasts until its end, and none acts between two that do not meet."""
    loads = [
        MissingLoad(1, 2, (5, 0, 0)),
        MissingLoad(2, 3, (6, 0, 0)),
        MissingLoad(7, 8, (4, 0, 0)),
    ]
    drawn = missing_load.series(loads)
    (panel,) = drawn.panels
    assert drawn.times.tolist() == [1, 2, 3, 7, 8]
    assert panel.rows[:, 0].tolist() == [5, 6, 0, 4, 0]
    assert panel.is_held
    impulse = float(np.diff(drawn.times) @ panel.rows[:-1, 0])
    assert impulse == sum((load.until - load.t) * load.load[0] for load in loads)
    vehicle = missing_load.series([MissingLoad(0, 1, (1, 2, 3, 4, 5, 6))])
    assert [panel.rows[0].tolist() for panel in vehicle.panels] == [[1, 2, 3], [4, 5, 6]]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["euler/generic", "--out", "a.gif"], r"expected \.svg, \.pdf, \.png"),
        (["euler/generic", "--animate", "--out", "a.svg"], r"expected \.html"),
        (["euler/generic", "--only", "path,spheres,x"], "(?s)a scene with its centre.*got 'x'"),
        (["euler/generic", "--only", "errors,load"], "expected trajectory files.*errors,load"),
        (["euler/generic", "bad.csv"], "expected a column `t`"),
        (["euler/rest", "--animate"], "got a body at rest"),
        (["euler/rest", "--animate", "--only", "time"], "expected a scene alone with --animate"),
    ],
)
def test_what_cannot_be_drawn_is_one_message(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A wrong ending, a picture that a scene lacks, a file that is none: exit 2, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    Path("bad.csv").write_text("hello,1\n", encoding="utf-8")
    assert main(["draw", *arguments]) == 2
    assert re.search(message, capsys.readouterr().err)
    assert [file.name for file in tmp_path.iterdir()] == ["bad.csv"]
