"""The contracts of import-linter in pyproject.toml: the tree keeps them, and each can be broken."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
_SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
# The name of each contract by its key.
CONTRACTS = {each["id"]: each["name"] for each in _SETTINGS["tool"]["importlinter"]["contracts"]}
# Each contract with a module and an import that breaks it.
PLANTED = {
    "truth": ("taylor_verify/exact/kind.py", "taylor_verify.run"),
    "equations": ("taylor_verify/models/registry.py", "taylor_verify.exact.kind"),
    "ledger": ("taylor_verify_reports/claims/claim.py", "taylor_verify.judge.gates"),
    "packages": ("taylor_verify/run.py", "taylor_verify_reports.verbs"),
    "rooms": ("taylor_verify/scenes/scene.py", "taylor_verify.run"),
    "published": ("taylor_verify_reports/studies/study.py", "taylor_verify_reports.verbs"),
    "heyoka": ("taylor_verify/solvers/scipy.py", "heyoka"),
    "processes": ("taylor_verify/draw/stage.py", "multiprocessing"),
    "printing": ("taylor_verify/run.py", "rich"),
    "circles": ("taylor_verify/batch/lock.py", "taylor_verify.batch.sweeps.sweep"),
}


def broken(folder: Path) -> list[str]:
    """Return the contracts that the sources in a folder break, by their names."""
    command = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    done = subprocess.run(
        [sys.executable, "-c", command, "--no-cache", "--no-logo"],
        cwd=folder,
        env={"PYTHONPATH": str(folder / "verify"), "COLUMNS": "200"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert " kept, " in done.stdout, done.stdout + done.stderr
    return re.findall(r"^(.*) BROKEN$", done.stdout, re.MULTILINE)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the sources, in which imports are planted."""
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    shutil.copytree(ROOT / "verify", tmp_path / "verify", ignore=lambda *_: ["__pycache__"])
    return tmp_path


def test_the_tree_breaks_no_contract() -> None:
    """Rooms, packages and libraries are imported where the contracts of pyproject.toml allow it."""
    assert broken(ROOT) == []


def test_a_planted_import_breaks_its_contract(copy: Path) -> None:
    """One import within a function is enough, and each contract has one that breaks it."""
    assert {*CONTRACTS} == {*PLANTED}
    for path, target in PLANTED.values():
        with (copy / "verify" / path).open("a", encoding="utf-8") as file:
            file.write(f"\n\ndef planted():\n    import {target}\n")
    assert {*broken(copy)} == {*CONTRACTS.values()}
