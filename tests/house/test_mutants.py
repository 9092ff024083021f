"""The mutants of `make mutants`: what is changed, what is left alone, and who is known to be equivalent."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from mutants.__main__ import within
from mutants.copied import Copy
from mutants.draw import drawn, equivalents, of_line
from mutants.mutant import PACKAGE, changed, count, lines, mutant
from mutants.trace import TESTS

CHANGED = [
    ("x = a + b", ["x = a - b"]),
    ("x = a * b / c", ["x = a * b * c", "x = a / b / c"]),
    ("x = a ** b", ["x = a * b"]),
    ("x -= b", ["x += b"]),
    ("x = -a", ["x = +a"]),
    ("x = a < b", ["x = a <= b"]),
    ("x = a == b", ["x = a != b"]),
    ("x = a is b and c", ["x = a is b or c", "x = a is not b and c"]),
    ("x = f(3, y=True)", ["x = f(4, y=True)", "x = f(3, y=False)"]),
    ("if a in b:\n    pass", ["if a not in b:"]),
]
LEFT_ALONE = [
    "x: Literal[1]",
    "def f(a: X[1]) -> Y[2]:\n    pass",
    "@cache(3)\ndef f():\n    pass",
    "raise ValueError(1)",
    "x = f'{1}'",
    "x = zip(a, b, strict=True)",
    "x = 1000",
]


@pytest.mark.parametrize(("source", "expected"), CHANGED)
def test_an_operator_a_sign_or_a_small_constant_is_changed(
    source: str, expected: list[str]
) -> None:
    """Each by itself, and told by the line that differs."""
    mutants = [mutant("a.py", source, place) for place in range(count(source))]
    assert [one.after for one in mutants] == expected
    assert {one.before for one in mutants} == {source.partition("\n")[0]}


@pytest.mark.parametrize("source", LEFT_ALONE)
def test_types_decorators_and_words_are_left_alone(source: str) -> None:
    """No test could notice a change of them, nor of a number of many."""
    assert count(source) == 0


def test_a_seed_draws_the_same_mutants() -> None:
    """Each is a module that can be compiled, and another seed draws others."""
    mutants = drawn(["judge/floor"], 12, seed=1)
    assert mutants == drawn(["judge/floor"], 12, seed=1)
    assert mutants != drawn(["judge/floor"], 12, seed=2)
    assert len(set(mutants)) == 12
    for one in mutants:
        assert ast.unparse(ast.parse(one.text)) == one.text
        assert one.before != one.after


def test_mutants_of_other_modules_change_no_draw() -> None:
    """Of a draw of two rooms, those of one room are the first that are drawn of it alone."""
    both = drawn(["judge/floor", "judge/series"], 12, seed=1)
    of_floor = [one for one in both if one.path.startswith("judge/floor")]
    assert 0 < len(of_floor) < 12
    assert of_floor == drawn(["judge/floor"], len(of_floor), seed=1)


def test_the_mutants_of_a_line_are_those_that_are_drawn_there() -> None:
    """A line can be tried again by its number."""
    (one,) = drawn(["judge/floor"], 1, seed=1)
    assert one in of_line(one.path, one.line)


def test_the_lines_of_a_statement_are_its_own_and_an_import_runs_what_is_in_no_function() -> None:
    """A line in the middle of a statement has no count of its own; a default is read by the import."""
    source = (
        "a = [\n1,\n]\ndef f(\nb=2,\n):\n    if b > c:\n        return (\n3)\nclass C:\n    d = 4"
    )
    every = (mutant("a.py", source, place) for place in range(count(source)))
    assert {one.line: (one.statement, one.is_imported) for one in every} == {
        2: (range(1, 4), True),
        5: (range(4, 7), True),
        7: (range(7, 8), False),
        9: (range(8, 10), False),
        11: (range(11, 12), True),
    }


def test_the_tests_of_a_mutant_stay_within_the_budget() -> None:
    """At least one is run, how long it may take."""
    seconds = {"a": 2.0, "b": 2.0, "c": 90.0}
    assert list(within(list(seconds), seconds, 10)) == ["a", "b"]
    assert list(within(["c", "a"], seconds, 10)) == ["c"]
    assert within([], seconds, 10) == {}


SOUND = """
LAST = 0
def ends(n: int) -> bool:
    while n != LAST:
        n -= 1  # to the end
    return True
"""
TESTS_OF_IT = """
from pathlib import Path
from taylor_verify.ending import ends
def test_ends(): assert ends(2) and ends(0)
def test_comment(): assert "#" in Path("verify/taylor_verify/ending.py").read_text()
"""


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Copy:
    """Return a package of one function with two tests."""
    package = tmp_path / "verify/taylor_verify"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "ending.py").write_text(SOUND, encoding="utf-8")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/test_ending.py").write_text(TESTS_OF_IT, encoding="utf-8")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTHONPATH", str(TESTS))
    return Copy(tmp_path)


@pytest.mark.slow
def test_a_mutant_that_fails_or_does_not_end_is_noticed(
    copy: Copy, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that behaves as before is not, and neither is one whose line no test runs."""
    monkeypatch.setattr("mutants.copied.START", 0.5)
    name = "tests/test_ending.py::test_ends"
    mutants = [mutant("ending.py", SOUND, place) for place in range(count(SOUND))]
    noticed = dict(copy.noticing({one: {name: 0.0} for one in mutants}))
    assert {one.after: noticed[one] for one in mutants} == {
        "LAST = 1": name,  # without end; in its file, for an import runs it
        "while n == LAST:": None,
        "n += 1": name,  # without end
        "n -= 2": None,
        "return False": name,
    }
    assert dict(copy.noticing({mutants[0]: {}})) == {mutants[0]: None}


@pytest.mark.slow
def test_a_test_that_fails_without_a_mutant_notices_nothing(copy: Copy) -> None:
    """A mutant has no comments, and a test that asks for them fails with every one."""
    every = dict.fromkeys(
        ("tests/test_ending.py::test_comment", "tests/test_ending.py::test_ends"), 0.0
    )
    assert copy.failing([mutant("ending.py", SOUND, 0)], every) == {next(iter(every))}


def test_the_sound_module_comes_back_whatever_happens(copy: Copy) -> None:
    """It has its time of change, by which its compiled form is known, even after a stop by the user."""
    file = copy.place / "verify/taylor_verify/ending.py"
    before = file.stat().st_mtime_ns

    def stop() -> None:
        with copy._changed({"ending.py": "pass"}):
            assert file.read_text(encoding="utf-8") == "pass"
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop()
    assert file.read_text(encoding="utf-8") == SOUND
    assert file.stat().st_mtime_ns == before


def test_who_is_called_equivalent_is_a_mutant_still() -> None:
    """The code has the line yet, the change is one that is drawn, and the reason is a sentence."""
    for (path, before, after), why in equivalents().items():
        source = (PACKAGE / path).read_text(encoding="utf-8")
        # As it is printed, every statement is a line.
        printed = ast.unparse(ast.parse(source))
        rows = [row.strip() for row in printed.splitlines()]
        changes = [(n, at - 1) for n, at in enumerate(lines(printed)) if rows[at - 1] == before]
        mutants = [(ast.unparse(changed(source, n)), at) for n, at in changes]
        assert after in {text.splitlines()[at].strip() for text, at in mutants}, f"{path}: {before}"
        assert why.endswith(".")
