"""Files of others are opened in one place, which refuses what never ends and what is too large."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import taylor_verify

PACKAGE = Path(taylor_verify.__file__).parent
OPENER = "records/regular_file.py"
READING = {
    "open",
    "fdopen",
    "read_text",
    "read_bytes",
    "memmap",
    "fromfile",
    "loadtxt",
    "genfromtxt",
}
# Modules that open something else, and what it is.
OTHERS = {
    "batch/lock.py": "the lock of a folder",
    "batch/finished_jobs.py": "the text of this package, programs, and files that it writes",
    "cli/ci.py": "the summary of a step, to which it writes",
    "cli/streams.py": "the null device",
    "draw/moving.py": "the template of this package",
    "judge/provenance.py": "the processor, by Linux",
    "records/replacement.py": "files that it writes",
    "scenes/expected.py": "expectations of this package",
    "solvers/engines/native.py": "scripts of engines",
    "solvers/engines/node.py": "scripts and locks of engines",
    "solvers/engines/script.py": "scripts of engines",
    "solvers/files/formats/memory.py": "the memory of its own process, by Linux",
    "solvers/files/formats/binary.py": "members of an archive that is open",
    "solvers/files/columns/programs.py": "a table of this package",
}


def opening(path: Path) -> list[str]:
    """The calls by which a module opens or reads a file; our own `read_bytes` is a plain name."""
    text = path.read_text()
    if not any(f"{word}(" in text for word in READING):
        return []
    calls = [node.func for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)]
    methods = [call.attr for call in calls if isinstance(call, ast.Attribute)]
    names = [call.id for call in calls if isinstance(call, ast.Name) and call.id == "open"]
    return [name for name in (*methods, *names) if name in READING]


def test_files_are_opened_in_one_place() -> None:
    """No other module opens a file, but for those that open what nobody else writes."""
    modules = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}
    # Scripts of engines run in environments of their own.
    ours = {name: path for name, path in modules.items() if "solvers/outside/" not in name}
    assert {name for name, path in ours.items() if opening(path)} == {OPENER, *OTHERS}


@pytest.mark.parametrize(
    "text", ["open(x)", "path.open()", "Path(x).read_text()", "np.fromfile(x)"]
)
def test_a_module_that_opens_a_file_is_noticed(text: str, tmp_path: Path) -> None:
    """Whatever it calls it."""
    module = tmp_path / "module.py"
    module.write_text(text)
    assert opening(module)
