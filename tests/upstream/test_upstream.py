"""The minimal reproductions of reports/upstream show what they say, with the heyoka that is installed."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from builders.turns import by_turns
from traps.table import TRAPS

FOLDER = Path(__file__).resolve().parents[2] / "reports" / "upstream"
SCRIPTS = sorted(FOLDER.glob("*.py"))


def test_every_script_belongs_to_a_trap_and_to_a_paragraph() -> None:
    """The scripts that the page names, those that are there and those of the README are the same."""
    named = {trap.script for trap in TRAPS if trap.script}
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    keys = dict(re.findall(r"^## \[(\w+)\.py\]\(\w+\.py\) \((\w+)\)$", text, re.MULTILINE))
    assert named == {script.stem for script in SCRIPTS} == set(keys)
    assert keys == {trap.script: trap.key for trap in TRAPS if trap.script}


@pytest.mark.parametrize("script", by_turns(SCRIPTS), ids=lambda path: path.stem)
def test_script_shows_its_behaviour_with_the_heyoka_that_is_installed(
    script: Path, tmp_path: Path
) -> None:
    """A script names one heyoka in its header, prints expected and actual results, and exits with 1."""
    if script.stem == "sympy_float" and find_spec("sympy") is None:
        pytest.skip("sympy asks for mpmath below 1.4 and is not installed")
    assert re.search(r'^# dependencies = \["heyoka==[\d.]+"', script.read_text(), re.MULTILINE)
    done = subprocess.run(
        [sys.executable, script],
        env={**os.environ, "HEYOKA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (1, "")
    assert re.search(r"^expected .*^got ", done.stdout, re.MULTILINE | re.DOTALL)
