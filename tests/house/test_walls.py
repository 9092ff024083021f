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


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources, in which imports are planted."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copy(ROOT / "pyproject.toml", folder)
    shutil.copytree(ROOT / "verify", folder / "verify", ignore=lambda *_: ["__pycache__"])
    return folder


def test_the_tree_breaks_no_contract(copy: Path) -> None:
    """Rooms, packages and libraries are imported where the contracts of pyproject.toml allow it."""
    assert broken(copy) == []


def test_every_contract_has_a_planted_import() -> None:
    """Each contract is broken by the test below."""
    assert {*CONTRACTS} == {*PLANTED}


@pytest.mark.parametrize("contract", PLANTED)
def test_a_planted_import_breaks_its_contract(copy: Path, contract: str) -> None:
    """One import within a function is enough."""
    path, target = PLANTED[contract]
    file = copy / "verify" / path
    sound = file.read_text(encoding="utf-8")
    file.write_text(f"{sound}\n\ndef planted():\n    import {target}\n", encoding="utf-8")
    try:
        assert CONTRACTS[contract] in broken(copy)
    finally:
        file.write_text(sound, encoding="utf-8")
