"""A picture in fewer bytes is the same picture."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import StringIO
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.studies.hard import study
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.plotting.compact_svg import compact
from taylor_verify.plotting.picture import plotting
from taylor_verify_reports.studies.hard import picture as diagram
from taylor_verify_reports.studies.site.stage import smaller

SVG = "{http://www.w3.org/2000/svg}"
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">'
HUNDREDTH = 0.005001


@pytest.fixture(scope="module")
def drawn() -> str:
    """A picture as matplotlib writes it: lines, marks, words."""
    with plotting():
        file = StringIO()
        figure = diagram.pictures(study())[0].figure()
        figure.savefig(file, format="svg", metadata={"Title": "A picture", "Date": None})
    return file.getvalue()


def marks(svg: str) -> Iterator[tuple[str, dict[str, str], str]]:
    """Return all marks with their styles and words, without names of groups."""
    root = ElementTree.fromstring(svg)
    sheet = "".join(one.text or "" for one in root.iter(f"{SVG}style"))
    styles = dict(re.findall(r"\.(s\d+)\{([^}]*)\}", sheet))
    for element in root.iter():
        if element.tag in {SVG + name for name in ("path", "use", "text", "rect", "tspan")}:
            given = dict(element.attrib)
            given["style"] = given.get("style") or styles.get(given.pop("class", ""), "")
            yield element.tag, given, (element.text or "").strip()


def points(path: str) -> list[tuple[str, list[float]]]:
    """The commands of a path, each with its letter and numbers; steps are added up to points."""
    commands: list[tuple[str, list[float]]] = []
    for letter, text in re.findall(r"([A-Za-z])([^A-Za-z]*)", path):
        numbers = [float(n) for n in re.findall(r"-?\d*\.?\d+(?:e[+-]?\d+)?", text)]
        if letter == "l":
            before = np.array(commands[-1][1][-2:])
            steps = np.cumsum(np.reshape(numbers, (-1, 2)), axis=0) + before
            numbers = steps.ravel().tolist()
        commands.append((letter, numbers))
    return commands


def flat(path: str) -> list[float]:
    return [number for _, numbers in points(path) for number in numbers]


def test_every_mark_is_there_with_its_style_and_words(drawn: str) -> None:
    """Marks come in the same order, in the same style, at the same places to a hundredth of a point."""
    before, after = list(marks(drawn)), list(marks(compact(drawn)))
    assert len(before) > 50
    references: dict[str, str] = {}
    for (tag, old, words), (tag_now, new, words_now) in zip(before, after, strict=True):
        style = re.sub(r"font-family:[^;]*; ?", "", old["style"])
        assert (tag, words, style) == (tag_now, words_now, new["style"])
        assert old.get("width") == new.get("width")
        for name in ("clip-path", f"{'{http://www.w3.org/1999/xlink}'}href"):
            assert references.setdefault(old.get(name, ""), new.get(name, "")) == new.get(name, "")
        for name in ("x", "y"):
            assert abs(float(old.get(name, 0)) - float(new.get(name, 0))) <= HUNDREDTH
        pairs = zip(flat(old.get("d", "")), flat(new.get("d", "")), strict=True)
        assert all(abs(a - b) <= HUNDREDTH for a, b in pairs)


def test_it_is_two_thirds_at_most_and_stays_as_it_is(drawn: str) -> None:
    """Made compact twice it is the same, and each version is smaller than the one before."""
    once = compact(drawn)
    assert compact(once) == once
    assert len(once) < len(drawn) * 2 / 3
    assert len(smaller(once)) < len(once)


def test_what_is_referred_to_keeps_its_name(drawn: str) -> None:
    """References to markers and clips have exactly one target."""
    text = compact(drawn)
    targets = re.findall(r' id="([^"]*)"', text)
    assert len(set(targets)) == len(targets)
    used = set(re.findall(r'url\(#([^)]*)\)|href="#([^"]*)"', text))
    assert {a or b for a, b in used} == set(targets)


@given(st.lists(st.tuples(st.floats(-999, 999), st.floats(-999, 999)), min_size=2, max_size=9))
def test_a_path_keeps_its_corners(corners: list[tuple[float, float]]) -> None:
    """Whatever the numbers, large, small or in powers of ten, each corner is where it was."""
    d = " \n".join(f"{'L' if k else 'M'} {x!r} {y!r}" for k, (x, y) in enumerate(corners))
    (made,) = re.findall(r' d="([^"]*)"', compact(f'{HEAD}<path d="{d} z"/></svg>'))
    assert made.endswith("z")
    expected = [number for corner in corners for number in corner]
    assert flat(made) == pytest.approx(expected, abs=HUNDREDTH)
