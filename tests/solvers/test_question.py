"""The question of every kind of scene: each key has one meaning, and its template can be filled in."""

from __future__ import annotations

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from builders.trajectories import columns_at
from builders.turns import by_turns
from builders.worked import DOCS

from taylor_verify.cli import main
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.process import protocol

# Every number is an object of these two: the one pair that occurs again and again.
PAIR = {"text", "hex"}
# Behind all others: lists of steps and of states, whose entries are alike.
LISTS = ("loads", "states", "instants")
# Tables whose keys are names that the scene chose.
NAMED = ("define", "space")
Kind = tuple[str, frozenset[str], bool, bool, bool]


def kind(scene: Scene) -> Kind:
    """The features by which the questions of two scenes differ in their keys."""
    loads = scene.body.loads
    acts = scene.body.is_free, loads is not None, loads is not None and bool(loads.states)
    return scene.model, scene.track, *acts


@cache
def one_of_each_kind() -> dict[Kind, str]:
    scene_of: dict[Kind, str] = {}
    for name in names():
        scene_of.setdefault(kind(load(name)), name)
    return scene_of


def keys(document: Any) -> Iterator[str]:
    """Every key at every level, as often as it occurs, but for the names that a scene chose."""
    if isinstance(document, dict):
        for key, value in document.items():
            yield key
            yield from () if key in NAMED else keys(value)
    elif isinstance(document, list):
        for entry in document:
            yield from keys(entry)


def legend() -> tuple[set[str], set[str]]:
    """The words in backquotes of the page: those that explain the question, and those of the answer."""
    page = (DOCS.parent / "cases" / "README.md").read_text(encoding="utf-8")
    question, answer = page.partition("The question:")[2].split("The answer is `{")
    lines = ("| `", "With `loads`", "With `states`")
    tables = [line for line in question.splitlines() if line.startswith(lines)]
    words = [set(re.findall(r"`(\w+)`", text)) for text in (" ".join(tables), answer)]
    return words[0], words[1] & {"remark", "steps", "evaluations", "seconds", "compile_seconds"}


@pytest.mark.parametrize("name", one_of_each_kind().values())
def test_no_key_occurs_twice(name: str) -> None:
    """No key but `text` and `hex` occurs twice, before the lists of what a scene writes down."""
    document = protocol.question(pose(load(name), rung("f64")))
    first = {key: value for key, value in document.items() if key not in LISTS}
    assert [*document][: len(first)] == [*first]
    counts = Counter(keys(first))
    assert {key for key, count in counts.items() if count > 1} == PAIR
    # As a reader without a JSON library searches it, in the text that the program gets.
    text = json.dumps({**first, "title": '"elapsed": a title may say anything'})
    assert {text.count(f'"{key}":') for key in counts if key not in PAIR} == {1}


@pytest.mark.parametrize("name", one_of_each_kind().values())
def test_every_key_is_explained(name: str) -> None:
    """The page names each key of a question, and no key before its lists is one of an answer."""
    question, answer = legend()
    document = protocol.question(pose(load(name), rung("f64")))
    asked = {*keys(document)} - PAIR
    assert asked <= question
    assert len(answer) == 5
    first = {key: value for key, value in document.items() if key not in LISTS}
    assert not {*keys(first)} & {*answer, *document["columns"]}


def lists(document: Any) -> Iterator[list[Any]]:
    """Every list at every level."""
    if isinstance(document, list):
        yield document
    entries = document.values() if isinstance(document, dict) else document
    for entry in entries if isinstance(document, dict | list) else ():
        yield from lists(entry)


@pytest.mark.parametrize("name", ["loads/vehicle-in-a-current", "kirchhoff/algebraic", "loads/pid"])
def test_a_vector_is_one_object_of_text_and_hex(name: str) -> None:
    """The lists stand within it: none is a list of such objects."""
    document = protocol.question(pose(load(name), rung("f64")))
    for entries in lists(document):
        assert not entries or not all(isinstance(e, dict) and e.keys() == PAIR for e in entries)


@pytest.mark.parametrize("name", ["loads/pid", "loads/thruster-pulses", "loads/vehicle-depth"])
def test_what_is_tracked_includes_states_of_the_scenes_own(name: str) -> None:
    """`track` lists own states as `columns` do, so that a program may ask either of them."""
    scene = load(name)
    document = protocol.question(pose(scene, rung("f64")))
    assert set(document["track"]) == scene.track | scene.states
    assert scene.states
    for own in scene.states:
        assert any(column.startswith(own) for column in document["columns"])


@pytest.mark.parametrize(
    ("name", "others", "version"),
    [
        ("euler/damped", set(), 1),
        ("kirchhoff/damped", set(), 1),
        ("euler/gyrostat", {"rotor"}, 3),
    ],
)
def test_damping_has_a_version_of_its_own(name: str, others: set[str], version: int) -> None:
    """Programs are asked by version 4, also with wheels; the damping is a text and a float."""
    scene = load(name)
    damped, plain = (
        protocol.question(pose(replace(scene, body=replace(scene.body, damping=c)), rung("f64")))
        for c in (Fraction(1, 8), Fraction(0))
    )
    assert (damped["protocol"], plain["protocol"]) == (4, version)
    assert {"damping", *others} <= set(damped["body"])
    assert damped["body"]["damping"] == {"text": "0.125", "hex": "0x1p-3"}
    assert "damping" not in plain["body"]


@pytest.mark.parametrize("name", by_turns(one_of_each_kind().values(), 10))
def test_the_template_filled_in_passes(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`question --csv` with the exact motion in its cells is a file that `check` takes as it is."""
    assert main(["question", name, "--csv"]) == 0
    out, stderr = capsys.readouterr()
    assert stderr == ""
    header, *rows = list(csv.reader(io.StringIO(out)))
    scene = load(name)
    instants = pose(scene, rung("f64")).given.clock.instants
    assert len(rows) == len(instants)
    exact = columns_at(scene, instants)
    assert [float(row[0]) for row in rows] == exact["t"]
    filled = [
        [row[0], *(repr(exact[column][k]) for column in header[1:])] for k, row in enumerate(rows)
    ]
    file = tmp_path / "filled.csv"
    file.write_text("\n".join(",".join(line) for line in [header, *filled]) + "\n")
    assert main(["check", str(file), "--scene", name]) == 0
