"""The worked pages: read from Markdown, executed block by block, held to the output they show.

A reader goes from top to bottom in an empty folder, and so does `work`:

    ```python   whose first line is `# NAME.py`: the file of that name; without a name it is executed,
                and what it prints must be the ```text block that follows
    ```toml     likewise a file, and so is ```cpp, whose first line is `// NAME.cpp`
    ```diff     a change of a file that is there: each hunk's old lines must occur in it once
    ```console  `$ COMMAND` and what it prints, on stdout and, as a terminal mixes them, stderr

Words are compared to the letter and blanks not at all; `...` stands for anything. A number is
compared by what it is (see Numbers). `<!-- given: PATH -->` is a file of the checkout that the page has
told its reader to copy.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, Final

import pytest

from builders.processes import PATIENCE
from taylor_verify.cli import main

ROOT: Final = Path(__file__).resolve().parents[2]
DOCS: Final = ROOT / "docs"

_FENCE: Final = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_REMARK: Final = re.compile(r"<!-- (numbers|given): (.+?) -->")
_NAMED: Final = re.compile(r"(?:#|//) ([\w./-]+\.(?:py|toml|cpp))\n")
_NUMBER: Final = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
_TOKEN: Final = re.compile(rf"\.\.\.|{_NUMBER.pattern}|[\w/]+|\S")
_OWN_COMMAND: Final = re.compile(r"(taylor-verify|pytest) [^|&;<]*")
# What a terminal shows and wipes away, and files do not: see taylor_verify.cli.progress.
_SIGN_OF_LIFE: Final = re.compile(
    r"taylor-verify: (?:.*: computing|.*\d % of .*|\d+/\d+ .* on [\w ]+)$"
)


class Untrue(AssertionError):
    """The page says something else than what happens."""


class Numbers(Enum):
    """What a number of a page promises.

    AS_PRINTED: integers are equal, others agree to a fiftieth, which forgives the last of two digits.
    ROUNDING_CLASS: made of roundings that another processor draws anew: of the same size, to a
    factor of ten, as batch.differences has it. MEASURED: a time, or a count that follows from
    one: any number.
    """

    AS_PRINTED = "as printed"
    ROUNDING_CLASS = "in their rounding class"
    MEASURED = "measured"

    def agree(self, shown: str, printed: str) -> bool:
        if self is Numbers.MEASURED or shown == printed:
            return True
        a, b = float(shown), float(printed)
        if self is Numbers.ROUNDING_CLASS:
            return abs(b) <= 10 * abs(a) and abs(a) <= 10 * abs(b)
        both_whole = all(re.fullmatch(r"[-+]?\d+", text) for text in (shown, printed))
        return not both_whole and abs(a - b) <= abs(a) / 50


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, text, line in the page, and how its numbers are compared."""

    language: str
    text: str
    line: int
    numbers: Numbers = Numbers.AS_PRINTED


def blocks(page: str) -> Iterator[Block]:
    """Every fenced block; ``given`` files come as blocks of that language."""
    end = 0
    for fence in _FENCE.finditer(page):
        numbers = Numbers.AS_PRINTED
        for remark in _REMARK.finditer(page, end, fence.start()):
            line = page.count("\n", 0, remark.start()) + 1
            if remark[1] == "given":
                yield Block("given", remark[2], line)
            else:
                numbers = Numbers(remark[2])
        line = page.count("\n", 0, fence.start()) + 1
        yield Block(fence[1], fence[2], line, numbers)
        end = fence.end()


def compare(shown: str, printed: str, numbers: Numbers = Numbers.AS_PRINTED) -> None:
    """Raise Untrue where what was printed is not what is shown."""
    expected, got = _TOKEN.findall(shown), _TOKEN.findall(printed)
    if not _matches(expected, got, numbers):
        raise Untrue(f"the page shows\n{shown}\nand what is printed is\n{printed}")


def _matches(expected: Sequence[str], got: Sequence[str], numbers: Numbers) -> bool:
    """Return True if the tokens agree; a gap in ``expected`` takes as few as it can, then more."""
    i = j = 0
    gap: tuple[int, int] | None = None
    while j < len(got):
        if i < len(expected) and expected[i] == "...":
            gap = (i, j)
            i += 1
        elif i < len(expected) and _same(expected[i], got[j], numbers):
            i, j = i + 1, j + 1
        elif gap is not None:
            gap = (gap[0], gap[1] + 1)
            i, j = gap[0] + 1, gap[1]
        else:
            return False
    return all(token == "..." for token in expected[i:])


def _same(shown: str, printed: str, numbers: Numbers) -> bool:
    if _NUMBER.fullmatch(shown) and _NUMBER.fullmatch(printed):
        return numbers.agree(shown, printed)
    return shown == printed


@dataclass
class Desk:
    """The folder in which a page is worked, the names its Python blocks have made, the last status."""

    folder: Path
    names: dict[str, Any] = field(default_factory=dict)
    status: int = 0
    printed: str | None = None

    def work(self, block: Block) -> None:
        acts: dict[str, Callable[[Block], object]] = {
            "given": self._given,
            "python": self._python,
            "toml": self._file,
            "cpp": self._file,
            "diff": self._diff,
            "console": self._console,
            "text": self._text,
        }
        if self.printed and block.language != "text":
            raise Untrue(f"something is printed that the page does not show:\n{self.printed}")
        if block.language in acts:
            acts[block.language](block)

    def _given(self, block: Block) -> None:
        shutil.copy(ROOT / block.text, self.folder)

    def _file(self, block: Block) -> bool:
        if named := _NAMED.match(block.text):
            (self.folder / named[1]).write_text(block.text, encoding="utf-8")
        return named is not None

    def _python(self, block: Block) -> None:
        if self._file(block):
            return
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile(block.text, f"line {block.line}", "exec"), self.names)
        self.printed = out.getvalue()

    def _text(self, block: Block) -> None:
        compare(block.text, self.printed or "", block.numbers)
        self.printed = None

    def _diff(self, block: Block) -> None:
        head, *hunks = re.split(r"^@@.*\n", block.text, flags=re.MULTILINE)
        file = self.folder / head.split()[1]
        for hunk in hunks:
            lines = hunk.splitlines(keepends=True)
            old = "".join(line[1:] for line in lines if line[0] in " -")
            new = "".join(line[1:] for line in lines if line[0] in " +")
            text = file.read_text(encoding="utf-8")
            if text.count(old) != 1:
                raise Untrue(f"{text.count(old)} places for this change:\n{hunk}")
            file.write_text(text.replace(old, new), encoding="utf-8")

    def _console(self, block: Block) -> None:
        for part in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
            command, _, shown = part.partition("\n")
            compare(shown, self._run(command), block.numbers)

    def _run(self, command: str) -> str:
        if command == "echo $?":
            return str(self.status)
        if _OWN_COMMAND.fullmatch(command):
            return self._own(command)
        environment = {
            **os.environ,
            "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        done = subprocess.run(
            ["bash", "-c", command],
            cwd=self.folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=PATIENCE,
        )
        self.status = done.returncode
        return done.stdout

    def _names(self, word: str) -> list[str]:
        paths = sorted(self.folder.glob(word)) if "*" in word else []
        return [path.name for path in paths] or [word]

    def _own(self, command: str) -> str:
        """taylor-verify and pytest in this process, where everything is imported already."""
        call, _, file = command.partition(">")
        name, *words = shlex.split(call)
        # A shell replaces a pattern by the names that fit it.
        arguments = [one for word in words for one in self._names(word)]
        with (
            contextlib.redirect_stdout(io.StringIO()) as out,
            contextlib.redirect_stderr(io.StringIO()) as err,
        ):
            if name == "pytest":
                # Without its own capture of file descriptors, which are those of the outer run.
                quiet = [
                    "-W",
                    "ignore::pytest.PytestAssertRewriteWarning",
                    "-p",
                    "no:cacheprovider",
                ]
                self.status = pytest.main(["--capture=sys", *quiet, *arguments])
            else:
                self.status = main(arguments)
        _forget_modules(self.folder)
        messages = [line for line in err.getvalue().splitlines() if not _SIGN_OF_LIFE.match(line)]
        if file:
            (self.folder / file.strip()).write_text(out.getvalue(), encoding="utf-8")
        return "\n".join(["" if file else out.getvalue(), *messages])


def work(page: Path, folder: Path) -> int:
    """Do all that a page says, in that folder; how many blocks there were. Raises Untrue."""
    desk, blocks_of_page = Desk(folder), list(blocks(page.read_text(encoding="utf-8")))
    before, wrote_none = Path.cwd(), sys.dont_write_bytecode
    os.chdir(folder)
    sys.path.insert(0, str(folder))
    # Python takes compiled code of the same size and second for that of the source: a page that turns
    # one sign and turns it back would run the wrong one on a fast machine.
    sys.dont_write_bytecode = True
    try:
        for block in blocks_of_page:
            try:
                desk.work(block)
            except Untrue as error:
                raise Untrue(f"{page.name}, line {block.line}: {error}") from None
    finally:
        sys.dont_write_bytecode = wrote_none
        os.chdir(before)
        sys.path.remove(str(folder))
        _forget_modules(folder)
    if desk.printed:
        raise Untrue(f"something is printed that the page does not show:\n{desk.printed}")
    return len(blocks_of_page)


def _forget_modules(folder: Path) -> None:
    """The reader's modules are of this folder: they are read anew once changed, and go with it."""
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__file__", "")).startswith(str(folder)):
            del sys.modules[name]
