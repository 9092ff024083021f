"""The findings about engines: each script is a report by itself, short, and free of this project."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

import pytest

from taylor_verify.studies.engines.findings import FOLDER, PARTS, findings, read, scripts

REPORTS = Path(__file__).resolve().parents[2] / "reports"
SCRIPTS = scripts(REPORTS)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_is_a_report(script: Path) -> None:
    """It has its title, versions, expectation, finding and evidence, and at most 40 lines of code."""
    found = read(script)
    assert found.title
    assert set(found.parts) == set(PARTS)
    assert re.search(r"\d+\.\d+", found.parts["Versions"])
    code = script.read_text(encoding="utf-8").rpartition('"""\n\nimport')[2]
    assert len([line for line in code.splitlines() if line.strip()]) <= 40


@pytest.mark.parametrize(
    "script", [s for s in SCRIPTS if s.suffix == ".py"], ids=lambda script: script.stem
)
def test_a_script_needs_its_engine_alone(script: Path) -> None:
    """It imports the pinned packages of its first lines and the standard library, and nothing of ours."""
    text = script.read_text(encoding="utf-8")
    (pinned,) = re.findall(r"^# dependencies = \[(.*)\]$", text, re.MULTILINE)
    packages = {re.split("[=><]", name.strip(' "'))[0] for name in pinned.split(",")}
    nodes = [*ast.walk(ast.parse(text))]
    modules = [name.name for node in nodes if isinstance(node, ast.Import) for name in node.names]
    modules += [node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)]
    imported = {module.partition(".")[0] for module in modules}
    assert "numpy" in packages
    assert re.search(r'"[\w-]+==[\d.]+"', pinned)
    others = imported - packages - sys.stdlib_module_names
    assert len(others) <= 1, "the engine, where its package has another name"
    assert "taylor_verify" not in text


def test_the_page_lists_every_script() -> None:
    """Each has a line on the page of the board, with what came and in which versions."""
    page = "\n".join(findings(REPORTS))
    assert all(f"../{FOLDER}/{script.name})" in page for script in SCRIPTS)
    assert len(SCRIPTS) >= 3


def test_a_script_in_javascript_is_a_report_too(tmp_path: Path) -> None:
    """Its first comment has the paragraphs; what follows is no part of them."""
    file = tmp_path / "it.mjs"
    words = ["A title", "", *(f"{part}: of {part}\n" for part in PARTS)]
    comment = "\n".join(words).replace("\n", "\n// ")
    file.write_text(f"// {comment}\nimport it from 'it';\n// Came: not this.\n", encoding="utf-8")
    found = read(file)
    assert found.title == "A title"
    assert found.parts == {part: f"of {part}" for part in PARTS}


def test_a_script_without_a_part_is_named(tmp_path: Path) -> None:
    """The fault has the parts that lack, and the file."""
    file = tmp_path / "it.py"
    file.write_text('"""A title.\n\nVersions: 1.0.\n\nCame: 2.\n"""\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"paragraphs Expected, Evidence, got none @ it\.py"):
        read(file)
