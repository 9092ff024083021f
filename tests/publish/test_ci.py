"""Reports for a CI are never greener than the exit status, and valid for their readers."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import fields
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from builders.processes import on_one_core
from builders.scenes import LISTED_INSTANTS, scene_file
from builders.verdicts import SCHEMA, violations
from builders.verdicts import far_off as row
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.records import schema, store
from taylor_verify.records.json_text import converted
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.words import annotations, junit
from taylor_verify.words.account import with_numbers as sentence
from taylor_verify.words.annotations import annotation_lines
from taylor_verify.words.case import Remark, cases
from taylor_verify.words.step_summary import step_summary

ROOT = Path(__file__).resolve().parents[2]
ACTION = ROOT / ".github" / "actions" / "verify" / "action.yml"
EXAMPLE = ROOT / ".github" / "workflows" / "example.yml"

Captured = pytest.CaptureFixture[str]


def remark(quantity: str = "omega", status: Status = Status.FAIL, text: str = "grew") -> Remark:
    return Remark("euler/generic", "taylor", "", "f64", quantity, status, text)


QUANTITIES = ("omega", "T", "H2", "attitude")
MIXTURES = [
    [row(status, quantity=name) for status, name in zip(rows, QUANTITIES, strict=False)]
    for count in (1, 2, 3)
    for rows in combinations_with_replacement(Status, count)
]


# JUnit.


def is_green(text: str) -> bool:
    """Return True if a reader of JUnit XML sees no failure and no error, neither counted nor there."""
    root = ElementTree.fromstring(text)
    counted = sum(int(suite.get(n, "0")) for suite in root for n in ("failures", "errors"))
    return counted == 0 and not [*root.iter("failure"), *root.iter("error")]


def hidden(mixtures: Iterable[list[Verdict]] = MIXTURES) -> list[list[Verdict]]:
    """The verdicts whose JUnit is of another colour than their exit status."""
    return [rows for rows in mixtures if is_green(junit.junit(rows)) != (exit_status(rows) == 0)]


def test_junit_is_green_where_the_exit_status_is_0_and_only_there() -> None:
    """JUnit has the colour of the exit status, for every mixture of up to three statuses."""
    assert len(MIXTURES) > 80
    assert hidden() == []


@pytest.mark.parametrize("status", [s for s in Status if exit_status([row(s)])])
@pytest.mark.parametrize("element", ["", "skipped", "system-out"])
def test_a_status_that_is_hidden_is_caught(
    monkeypatch: pytest.MonkeyPatch, status: Status, element: str
) -> None:
    """The broken twin: a writer that counts undecided, or any other red status, as success."""
    monkeypatch.setattr(junit, "_ELEMENTS", {**junit._ELEMENTS, status: element})
    assert [row(status)] in hidden([[row(status)]])


def test_junit_counts_what_it_holds() -> None:
    """The counts of suites and of the whole are those of the elements, and no case is lost."""
    rows = [
        row(status, quantity=name, scene=scene, rung=rung)
        for scene in ("euler/generic", "kirchhoff/screw")
        for rung in ("f32", "f64")
        for status, name in zip((*Status, Status.FAIL), "abcdefg", strict=True)
    ]
    root = ElementTree.fromstring(junit.junit(rows))
    assert [suite.get("name") for suite in root] == [
        "euler/generic f32",
        "euler/generic f64",
        "kirchhoff/screw f32",
        "kirchhoff/screw f64",
    ]
    assert len(list(root.iter("testcase"))) == len(rows)
    counted = {"tests": "testcase", "failures": "failure", "errors": "error", "skipped": "skipped"}
    for element in (root, *root):
        for attribute, name in counted.items():
            if element is not root or attribute != "skipped":
                assert element.get(attribute) == str(len(list(element.iter(name))))
    assert [int(root[0].get(name, "")) for name in counted] == [7, 2, 3, 1]


# Element to its attributes and children in order: what the schemas of Surefire 3.0 and of Jenkins
# (junit-10) have in common, a star for what must be there.
SUREFIRE: dict[str, tuple[set[str], tuple[str, ...]]] = {
    "testsuites": ({"name", "tests", "failures", "errors"}, ("testsuite",)),
    "testsuite": (
        {"name*", "tests*", "failures*", "errors*", "skipped*", "time"},
        ("properties", "testcase"),
    ),
    "properties": (set(), ("property",)),
    "property": ({"name*", "value*"}, ()),
    "testcase": ({"name*", "time*", "classname"}, ("failure", "skipped", "error")),
    "failure": ({"type*", "message"}, ()),
    "error": ({"type*", "message"}, ()),
    "skipped": ({"message"}, ()),
}


def faults(element: ElementTree.Element) -> list[str]:
    """The faults that either schema finds in a document of JUnit."""
    attributes, children = SUREFIRE[element.tag]
    names = {name.rstrip("*") for name in attributes}
    wrong = [f"{element.tag}@{name}" for name in set(element.keys()) - names]
    wrong += [
        f"no {n}" for n in attributes if n.endswith("*") and element.get(n.rstrip("*")) is None
    ]
    places = [children.index(child.tag) if child.tag in children else -1 for child in element]
    if places != sorted(places) or -1 in places:
        wrong.append(f"children of {element.tag}: {[child.tag for child in element]}")
    if not re.fullmatch(r"[0-9]+\.[0-9]{3}", element.get("time", "0.000")):
        wrong.append(f"time {element.get('time')}")
    return wrong + [fault for child in element for fault in faults(child)]


@pytest.mark.parametrize("seconds", [None, 0.0, 1234.56789, math.nan, math.inf, -1.0])
def test_junit_has_the_structure_of_surefire_and_jenkins(seconds: float | None) -> None:
    """Elements, their order and attributes are those that both schemas know."""
    rows = [row(status, quantity=status.value, seconds=seconds) for status in Status]
    root = ElementTree.fromstring(junit.junit(rows, [remark("gone"), remark("pass")]))
    assert faults(root) == []
    root[0][1].set("status", "run")
    root[0].append(ElementTree.Element("properties"))
    assert len(faults(root)) == 2


@given(st.text(), st.text(), st.text())
def test_any_text_makes_a_document(scene: str, quantity: str, because: str) -> None:
    """Markup, control characters and lone surrogates of somebody's program are escaped; what XML can
    hold comes back as it was."""
    verdict = row(
        Status.FAIL, scene=scene, quantity=quantity, reason=stated(Cause.NOT_POSED, because)
    )
    text = junit.junit([verdict])
    text.encode()
    (failure,) = ElementTree.fromstring(text).iter("failure")
    if not junit._NOT_XML.search(sentence(verdict)):
        assert failure.get("message") == sentence(verdict)


def test_a_failure_says_what_a_person_needs() -> None:
    """A failure says the quantity, its error and time, the bound, and the reason for the bound."""
    (failure,) = ElementTree.fromstring(junit.junit([row(Status.FAIL)])).iter("failure")
    assert failure.get("message") == (
        "omega: 11 digits are right (largest error 3.3e-12); 10 x attainable; one rounding a step; "
        "larger than f64 rounding explains; largest error 3.30e-12 (max|omega|) at t = 7, where "
        "2.00e-13 is allowed; up to 165 times what perfect rounding would leave at t = 6.5"
    )
    assert (failure.text or "").startswith("euler/generic on f64: omega fail\nomega: 11 digits")


def test_a_regression_fails_the_case_that_passed() -> None:
    """A regression is in the case of its row; a vanished row gets a case in the suite of its run."""
    rows = [row(), row(quantity="T"), row(rung="f32")]
    root = ElementTree.fromstring(junit.junit(rows, [remark(), remark("H2", text="gone")]))
    messages = {
        (suite.get("name"), case.get("name")): [inside.get("message") for inside in case]
        for suite in root
        for case in suite.iter("testcase")
    }
    assert messages == {
        ("euler/generic f64", "omega"): ["grew"],
        ("euler/generic f64", "T"): [],
        ("euler/generic f64", "H2"): ["gone"],
        ("euler/generic f32", "omega"): [],
    }
    assert not is_green(junit.junit(rows, [remark(status=Status.UNDECIDED)]))


def test_the_gravest_counts_and_both_are_told() -> None:
    """A vacuous row that also regressed is a failure with two sentences, and never an error less."""
    (only,) = cases([row(Status.VACUOUS)], [remark()])
    assert (only.status, len(only.sentences)) == (Status.FAIL, 2)
    (only,) = cases([row(Status.FAIL)], [remark(status=Status.UNDECIDED)])
    assert only.status is Status.FAIL
    (only,) = cases([row()], [remark(text="max"), remark(text="mean")])
    assert only.text == "max\nmean"


def test_paths_make_dotted_names() -> None:
    """Readers fold the class names into a tree: a dot of a path makes no branch."""
    shown = {"euler/generic": "euler.generic.f64", "../my.scene.toml": "my_scene.f64"}
    for scene, expected in shown.items():
        (case,) = ElementTree.fromstring(junit.junit([row(scene=scene)])).iter("testcase")
        assert case.get("classname") == expected


# GitHub.

COMMAND = re.compile(r"::(error|warning|notice) ([^:]*)::(.*)")


def read_by_runner(line: str) -> tuple[str, dict[str, str], str]:
    """A line as the runner takes it apart."""
    command = COMMAND.fullmatch(line)
    assert command is not None
    pairs = (pair.partition("=") for pair in command[2].split(","))
    properties = {name: _unescaped(value) for name, _, value in pairs}
    return command[1], properties, _unescaped(command[3])


def _unescaped(text: str) -> str:
    for escape, character in (
        ("%0D", "\r"),
        ("%0A", "\n"),
        ("%3A", ":"),
        ("%2C", ","),
        ("%25", "%"),
    ):
        text = text.replace(escape, character)
    return text


def test_each_status_has_its_level() -> None:
    """A failure is an error, a row that shows nothing a warning; a pass is silent."""
    levels = {s: [read_by_runner(line)[0] for line in annotation_lines([row(s)])] for s in Status}
    assert levels == {
        Status.PASS: [],
        Status.FAIL: ["error"],
        Status.UNDECIDED: ["warning"],
        Status.VACUOUS: ["warning"],
        Status.REFUSED: ["warning"],
        Status.UNAVAILABLE: ["notice"],
    }
    (line,) = annotation_lines([row()], [remark()])
    assert read_by_runner(line) == ("error", {"title": "euler/generic on f64: omega fail"}, "grew")


@given(st.text(), st.text())
def test_the_runner_reads_back_what_was_said(quantity: str, because: str) -> None:
    """Whatever a program wrote to stderr, a verdict is one line and no command of the program's."""
    verdict = row(
        Status.FAIL,
        scene="a,b: 100%.toml",
        quantity=quantity,
        reason=stated(Cause.NOT_POSED, because),
    )
    (line,) = annotation_lines([verdict])
    # GitHub's runner splits its input at these.
    assert not set(line) & {"\r", "\n"}
    if not re.search("%(0D|0A|3A|2C|25)", quantity + because):
        _, properties, text = read_by_runner(line)
        assert text == sentence(verdict)
        assert properties["file"] == "a,b: 100%.toml"


@pytest.mark.parametrize(("count", "last"), [(10, "omega fail"), (11, "2 more"), (30, "21 more")])
def test_no_line_is_dropped_without_a_word(count: int, last: str) -> None:
    """GitHub keeps ten of a level: the tenth counts what it would drop; errors come first."""
    rows = [row(Status.FAIL, scene=f"euler/{i}") for i in range(count)]
    lines = annotation_lines([row(Status.UNDECIDED), *rows])
    levels = [read_by_runner(line)[0] for line in lines]
    assert levels == ["error"] * 10 + ["warning"]
    assert last in read_by_runner(lines[9])[1]["title"]
    assert annotations._MOST == 10


def test_the_summary_has_every_row_and_first_what_is_no_pass() -> None:
    """The reasons of what is no pass, with the figures of the pages; then all rows, folded away."""
    rows = [row(status, quantity=status.value) for status in Status]
    text = step_summary([*rows, row(quantity="T")], [remark("T"), remark("gone", text="no row")])
    first, _, folded = text.partition("<details>")
    lines = [line for line in first.splitlines() if line.startswith("| `euler")]
    named = [re.findall("`([^`]*)`", line)[1] for line in lines]
    assert named == ["fail", "undecided", "vacuous", "refused", "unavailable", "T", "gone"]
    assert all("3.30e-12 |" in line for line in lines[:-1])
    assert re.search(r"\*\*fail\*\* +\| grew \|", lines[5])
    assert re.search(r"\*\*fail\*\* +\| no row \|", lines[6])
    assert len([line for line in folded.splitlines() if line.startswith("| `euler")]) == 8
    assert re.search(r"\| pass \| +fail \|", first)
    assert "**2 more of the rows count as no pass" in first
    assert "regressed" not in step_summary(rows)
    assert text.endswith("\n")


def test_the_summary_breaks_no_table() -> None:
    """Bars, tags and line ends of somebody's words stay within their cell."""
    text = step_summary(
        [row(Status.FAIL, reason=stated(Cause.NOT_POSED, "a | b\n<script> `c`"), unit="x|y")]
    )
    (line,) = [line for line in text.splitlines() if "script" in line]
    assert len(re.findall(r"(?<!\\)\|", line)) == 10
    assert r"\<script\>" in line


def test_the_summary_is_never_longer_than_github_takes() -> None:
    """GitHub drops a summary above 1 MiB as a whole: the reasons are cut, and it says so."""
    rows = [
        row(Status.FAIL, scene=f"s/{i}", reason=stated(Cause.NOT_POSED, "é" * 400))
        for i in range(5000)
    ]
    text = step_summary(rows)
    assert len(text.encode()) < 2**20
    assert re.search(r"And 4[59]00 more", text)
    assert "| **5000** |" in text
    endless = step_summary([row(Status.FAIL, reason=stated(Cause.NOT_POSED, "x" * 2**20))])
    assert len(endless.encode()) < 2**20
    assert "| **1** |" in endless


# JSON.


@pytest.fixture
def short(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene file that is judged in a moment, in the working folder."""
    monkeypatch.chdir(tmp_path)
    return scene_file(Path(), LISTED_INSTANTS)


def test_the_document_of_run_is_of_the_published_schema(short: Path, capsys: Captured) -> None:
    """The document is of the schema with a baseline, and on a rung that cannot hold the scene."""
    # Two instants that float32 cannot tell apart.
    close = Path("close.toml")
    close.write_text(LISTED_INSTANTS.replace('["0.5"', '["0.5", "0.50000000001"'), encoding="utf-8")
    assert main(["run", str(short), "--json"]) == 0
    printed = capsys.readouterr().out
    assert violations(json.loads(printed)) == []
    Path("base.json").write_text(printed, encoding="utf-8")
    call = ["run", str(short), str(close), "--rung", "f32", "f64", "--baseline", "base.json"]
    with on_one_core():
        assert main([*call, "--json"]) == 3
    document = json.loads(capsys.readouterr().out)
    assert violations(document) == []
    assert document["baseline"]["compared"] == 3
    assert len(document["summary"]) == len(Status)
    assert document["summary"]["refused"] == 1


def trajectory(scene: Path, capsys: Captured, factor: float) -> Path:
    """The exact motion as somebody's file, its angular velocity times a factor."""
    times = "0,0.25,0.5,1,1.5,2"
    assert main(["exact", str(scene), "--at", times, "--digits", "20", "--json"]) == 0
    lines = ["t,w1,w2,w3"]
    for exact in json.loads(capsys.readouterr().out)["rows"]:
        omega = (repr(float(number) * factor) for number in exact["omega"])
        lines.append(",".join([exact["t"], *omega]))
    file = Path("mine.csv")
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def test_check_tells_a_ci_the_same_way(short: Path, capsys: Captured) -> None:
    """A file that passes is its own baseline; one in degrees is red, a regression, and of the schema
    with what was found out about it."""
    file = trajectory(short, capsys, 1.0)
    call = ["check", str(file), "--scene", str(short), "--json"]
    assert main(call) == 0
    printed = capsys.readouterr().out
    assert violations(json.loads(printed)) == []
    Path("base.json").write_text(printed, encoding="utf-8")
    call += ["--baseline", "base.json", "--junit", "r.xml"]
    assert main(call) == 0
    assert is_green(Path("r.xml").read_text(encoding="utf-8"))
    capsys.readouterr()
    trajectory(short, capsys, math.degrees(1.0))
    assert main(call) == 1
    out, error = capsys.readouterr()
    document = json.loads(out)
    assert violations(document) == []
    assert document["conventions"]
    assert document["baseline"]["regressions"]
    assert "regression: expected pass, got fail @ short.toml f64 omega verdict" in error
    assert not is_green(Path("r.xml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda row: row.update(verdict="passed"), "'passed' is not one of"),
        (lambda row: row.update(max=None), "None is not of type 'number' @ $.verdicts[0].max"),
        (lambda row: row.update(max="1e-15"), "'1e-15' is not of type 'number'"),
        (lambda row: row.update(mean=-1e-15), "-1e-15 is not valid under any"),
        (lambda row: row.update(steps=1.5), "1.5 is not of type 'integer'"),
        (lambda row: row.update(steps=True), "True is not of type 'integer'"),
        (lambda row: row.update(verdict="fail", because=""), "'' should be non-empty"),
        (lambda row: row.update(rung="double"), "'double' does not match"),
        (lambda row: row.pop("because"), "'because' is a required property @ $.verdicts[0]"),
        (lambda row: row["provenance"].pop("scene"), "'scene' is a required property"),
        (lambda row: row["reason"].update(factor="ten"), "'ten' is not valid under any"),
    ],
)
def test_a_spoiled_document_is_not_of_the_schema(
    spoil: Callable[[dict[str, Any]], Any], message: str
) -> None:
    """The schema names the fault of each broken row; an unknown key is no fault."""
    counts = {status.value: 0 for status in Status}
    document: dict[str, Any] = {"verdicts": [{**row().row(), "new_key": 1}], "summary": counts}
    assert violations(document) == []
    spoil(document["verdicts"][0])
    assert message in "\n".join(violations(document))


def test_the_schema_describes_every_field_of_a_verdict(capsys: Captured) -> None:
    """`list --schema` prints the schema of the types; a row has all its keys, also one that was stored."""
    for call in (["list", "--schema"], ["list", "--schema", "--json"]):
        assert main(call) == 0
        assert json.loads(capsys.readouterr().out) == SCHEMA
    Draft202012Validator.check_schema(SCHEMA)
    described = SCHEMA["$defs"]["Verdict"]["properties"]
    assert {field.name for field in fields(Verdict)} | {"because", "sentence", "digits"} == set(
        described
    )
    assert set(schema.REQUIRED) <= set(row().row())
    stored = (store.row(verdict) for verdict in (row(), row(Status.FAIL, time_shift=0.1)))
    rows = [converted(each, Verdict).row() for each in stored]
    counts = {status.value: 0 for status in Status}
    assert violations({"verdicts": rows, "summary": counts}) == []


# The command.


def test_junit_and_summary_are_written_beside_the_answer(
    short: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """stdout is the document alone; a summary is appended."""
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "summary.md")
    Path("summary.md").write_text("of another command\n", encoding="utf-8")
    assert main(["run", str(short), "--junit", "b.xml", "--github", "--json"]) == 0
    out, error = capsys.readouterr()
    assert set(json.loads(out)) == {"verdicts", "summary", "sha256"}
    assert is_green(Path("b.xml").read_text(encoding="utf-8"))
    assert Path("summary.md").read_text(encoding="utf-8").startswith("of another command\n## ta")
    assert "::" not in error
    assert "wrote b.xml" in error


def test_a_failing_run_is_red_everywhere(
    short: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that crashes: exit 1, a failure in the XML, an error for the runner, a bold verdict."""
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "summary.md")
    Path("crash.py").write_text("import sys; sys.exit('::set-env::\\n::error::mine')")
    solver = f"process:{sys.executable} crash.py"
    call = ["run", str(short), "--solver", solver, "--junit", "r.xml", "--github"]
    assert main(call) == 1
    error = capsys.readouterr().err
    commands = [line for line in error.splitlines() if line.startswith("::")]
    assert len(commands) == 1
    assert commands[0].startswith("::error file=short.toml,line=1,title=short.toml on f64%3A omega")
    assert not is_green(Path("r.xml").read_text(encoding="utf-8"))
    assert "**fail**" in Path("summary.md").read_text(encoding="utf-8")


def test_without_a_runner_there_is_no_summary(
    short: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """--github elsewhere says so, and passes."""
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    assert main(["run", str(short), "--github"]) == 0
    assert "GITHUB_STEP_SUMMARY is not set" in capsys.readouterr().err


@pytest.mark.parametrize("place", ["", ".", "short.toml/r.xml", "none/r.xml"])
def test_a_junit_file_that_cannot_be_written_is_a_wrong_call(
    short: Path, capsys: Captured, place: str
) -> None:
    """Exit 2 and a message that names --junit, before any work; no folder is made for it."""
    assert main(["run", str(short), "--junit", place]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert f"got {place!r}" in error
    assert "--junit" in error
    assert not Path("none").exists()


def test_what_fails_in_writing_hides_no_verdict(
    short: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The run is shown all the same, and the exit status is 2."""
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "no/such/folder/summary.md")
    assert main(["run", str(short), "--github"]) == 2
    out, error = capsys.readouterr()
    assert "3 pass" in out
    assert "no/such/folder/summary.md" in error


# The composite action: it has not been run by GitHub here. Its script has, by bash.


def script(step: str) -> str:
    """The ``run`` of a step: the block below it, which is indented further."""
    text = ACTION.read_text(encoding="utf-8")
    (block,) = re.findall(
        rf"- name: {step}\n(?:      .*\n)*?      run: \|\n((?:        .*\n)+)", text
    )
    return textwrap.dedent(block)


def inputs() -> set[str]:
    """The names below ``inputs:``."""
    text = ACTION.read_text(encoding="utf-8")
    (block,) = re.findall(r"^inputs:\n((?: .*\n)+)", text, re.M)
    return set(re.findall(r"^  ([a-z-]+):$", block, re.M))


def test_the_action_uses_what_it_declares() -> None:
    """All inputs are declared and used, none is written into a script, and steps name a shell."""
    text = ACTION.read_text(encoding="utf-8")
    assert set(re.findall(r"inputs\.([a-z-]+)", text)) == inputs()
    assert {"scenes", "rung", "solver", "baseline", "python-version"} <= inputs()
    assert "using: composite" in text
    assert text.count("      run: |") == text.count("      shell: bash") == 2
    assert "${{" not in script("install taylor-verify") + script("run taylor-verify")
    assert "\t" not in text


def test_the_example_calls_the_action_with_inputs_it_has() -> None:
    """The example starts by hand only, and its action exists."""
    text = EXAMPLE.read_text(encoding="utf-8")
    assert "\non: workflow_dispatch\n" in text
    (used,) = re.findall(r"uses: \./(.*)", text)
    assert (ROOT / used / "action.yml") == ACTION
    (block,) = re.findall(r"        with:\n((?:          .*\n)+)", text)
    named = set(re.findall(r"^          (?:# )?([a-z-]+): ", block, re.M))
    assert "baseline" in named
    assert named <= inputs()


@pytest.mark.skipif(shutil.which("bash") is None, reason="the action's scripts are for bash")
@pytest.mark.parametrize(
    ("solver", "installed"),
    [
        ("", "source[taylor]"),
        ("taylor?tol=1e-9", "source[taylor]"),
        ("scipy:DOP853", "source[scipy]"),
        ("process:./simulator 0.001", "source"),
    ],
)
def test_the_action_installs_what_the_solver_needs(
    solver: str, installed: str, tmp_path: Path
) -> None:
    """heyoka, which is large, comes along for `taylor` alone."""
    python = tmp_path / "python"
    # `-m venv FOLDER` puts it there, `-m pip ...` writes down what it is asked for.
    python.write_text(
        '#!/bin/sh\nif [ "$2" = venv ]; then mkdir -p "$3/bin" && cp "$0" "$3/bin/python"; '
        f'else echo "$*" > "{tmp_path}/asked"; fi\n',
        encoding="utf-8",
    )
    python.chmod(0o755)
    given = {"PYTHON": str(python), "SOURCE": "source", "RUNNER_TEMP": str(tmp_path)}
    step = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c"]
    subprocess.run(
        [*step, script("install taylor-verify")],
        env={**os.environ, **given, "SOLVER": solver},
        check=True,
    )
    assert (tmp_path / "asked").read_text().split()[-1] == installed


@pytest.mark.skipif(shutil.which("bash") is None, reason="the action's scripts are for bash")
def test_the_script_of_the_action_judges(
    short: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The script runs as GitHub calls it: rungs, scenes, a baseline; 1 if a row of that is gone."""
    # The program writes down how it is called. This process answers in its place, and the script is run
    # once more with that answer: to start Python takes longer than all the rest.
    program = Path("taylor-verify/bin/taylor-verify")
    program.parent.mkdir(parents=True)
    program.write_text('#!/bin/sh\nprintf "%s\\0" "$@" > called\ncat answer\nexit $(cat status)\n')
    program.chmod(0o755)
    Path("with space").mkdir()
    shutil.copy(short, "other.toml")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "summary.md")
    _, _, environment_of_step = ACTION.read_text(encoding="utf-8").partition("id: verify")
    names = re.findall(r"^        ([A-Z_]+): \$", environment_of_step, re.M)

    def script_status(**given: str) -> int:
        files = {"GITHUB_OUTPUT": "output", "RUNNER_TEMP": str(Path.cwd())}
        return subprocess.run(
            [
                *("bash", "--noprofile", "--norc", "-eo", "pipefail"),
                *("-c", script("run taylor-verify")),
            ],
            env={**os.environ, **files, **dict.fromkeys(names, ""), **given},
            check=False,
        ).returncode

    def step(**given: str) -> int:
        Path("answer").write_text("")
        Path("status").write_text("0")
        assert script_status(**given) == 0
        call = Path("called").read_text(encoding="utf-8").split("\0")[:-1]
        with on_one_core():
            status = main(call)
        Path("answer").write_text(capsys.readouterr().out, encoding="utf-8")
        Path("status").write_text(str(status))
        assert script_status(**given) == status
        return status

    asked = {"SCENES": "short.toml\nother.toml $(touch injected)", "RUNG": "f32 f64"}
    assert step(**asked) == 2  # what looks like a command is a word, and no scene
    assert not Path("injected").exists()
    asked["SCENES"] = "short.toml\nother.toml"
    assert step(**asked) == 0
    results = dict(line.split("=") for line in Path("output").read_text().splitlines())
    document = json.loads(Path(results["json"]).read_text(encoding="utf-8"))
    assert document["summary"]["pass"] == 12
    assert is_green(Path(results["junit"]).read_text(encoding="utf-8"))
    document["verdicts"][0]["quantity"] = "gone"
    baseline = Path("with space/base line.json")
    baseline.write_text(json.dumps(document), encoding="utf-8")
    assert step(SCENES="short.toml", RUNG="f32", BASELINE=str(baseline), SOLVER="taylor") == 1
    assert not is_green(Path(results["junit"]).read_text(encoding="utf-8"))
    assert Path("summary.md").read_text(encoding="utf-8").count("## taylor-verify") == 2
    assert step(SCENES="short.toml", TOLERANCE="omega=1e-19,T=1e-8", GATE="bound") == 1
    assert step(SCENES="short.toml", GATE="baseline") == 2
    # A file, with a name for a column of its own; on Windows the programs are in Scripts.
    Path("taylor-verify/bin").rename("taylor-verify/Scripts")
    rows = taylor_verify.exact("short.toml", taylor_verify.load("short.toml").times, 20)
    frame = rows.to_dataframe().astype(float).rename(columns={"w1": "rate, axis 1"})
    frame.to_csv("mine.csv", index=False)
    of_file = {"FILES": "mine.csv", "SCENES": "short.toml", "TOLERANCE": "1e-9"}
    assert step(**of_file, COLUMNS_OF_FILES="w1=rate, axis 1") == 0
    assert step(**of_file) == 2
