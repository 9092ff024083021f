"""Names of the files of scenes and solvers: what was published keeps its name, and none is shared."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from taylor_verify.records.file_names import of_scene, of_solver
from taylor_verify.scenes import library

NAMES = st.text(alphabet="ab-_/.%", min_size=1, max_size=6)


@pytest.mark.parametrize(
    "name", library.names(*library.STANDARD_SET, library.EXTREMES, library.WORST)
)
def test_a_shipped_scene_keeps_its_name(name: str) -> None:
    """The stroke is a hyphen, as in every file that was published so far."""
    assert of_scene(name) == name.replace("/", "-")


@given(NAMES)
@example("./s.toml")
def test_no_file_is_hidden(name: str) -> None:
    """No file's name begins with a dot: `ls`, `cp O/*` and uploads leave such files out."""
    assert not of_scene(name).startswith(".")


@given(NAMES, NAMES)
@example("a/b", "a-b")
@example("a/b/c", "a-b/c")
@example("a/worst/b", "a/worst-b")
def test_no_two_scenes_share_a_name(one: str, other: str) -> None:
    """Two names lead to one file only if they are the same name, and no file lies in a folder."""
    assert (of_scene(one) == of_scene(other)) == (one == other)
    assert "/" not in of_scene(one)


@given(NAMES, NAMES, NAMES, NAMES)
def test_scene_and_solver_are_told_apart(a: str, b: str, c: str, d: str) -> None:
    """The dot between them is the last but one of a record's name, wherever other dots stand."""
    one, other = (f"{of_scene(s)}.{of_solver(t)}.f64.json" for s, t in ((a, b), (c, d)))
    assert (one == other) == ((a, b) == (c, d))
