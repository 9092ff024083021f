"""The parser of arguments, whose sentences are those of this program, and the text of an argument."""

from __future__ import annotations

import argparse
import difflib
import re
import sys
from collections.abc import Iterable, Sequence
from typing import Any, Final, NoReturn

from taylor_verify.cli.streams import print_out
from taylor_verify.records.escapes import one_line

# Name, whether it must be given, sign, value, default and help of an argument.
_ARGUMENT: Final = re.compile(r"([-\w]+)(!?)([*+]?)(?: ([^ ]+))?(?: \[(.+?)\])?(?:  (.*))?")

# What argparse says of a wrong call, and the same as a sentence of this program.
_SENTENCES: Final = tuple(
    (re.compile(pattern), sentence)
    for pattern, sentence in (
        (r"the following arguments are required: (.*)", r"expected \1, got none"),
        (
            r"argument ([^:]+): invalid choice: (.+) \(choose from (.+)\)",
            r"expected \3, got \2 @ \1",
        ),
        (
            r"argument ([^:]+): expected (?:one|at least one) argument",
            r"expected a value, got none @ \1",
        ),
        (r"argument ([^:]+): ignored explicit argument (.+)", r"expected no value, got \2 @ \1"),
        (r"argument ([^:]+): (expected .+)", r"\2 @ \1"),
    )
)


class Misused(SystemExit):
    """The end of a call that the parser refuses, which has been printed; ``faults`` are its lines."""

    def __init__(self, code: Any, faults: Sequence[str]) -> None:
        self.faults = faults
        super().__init__(code)


class Parser(argparse.ArgumentParser):
    """A parser whose message is one harmless line: it repeats words that may be names of files."""

    def error(self, message: str) -> NoReturn:
        for pattern, sentence in _SENTENCES:
            if match := pattern.fullmatch(message):
                message = match.expand(sentence)
                break
        line = one_line(message)
        try:
            super().error(line)
        except SystemExit as end:
            raise Misused(end.code, [line]) from None

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print help and version as any answer: argparse says nothing of a disk that is full."""
        if file is sys.stderr:
            super()._print_message(message, file)
        else:
            print_out(message.removesuffix("\n"))


def unknown_words(words: Sequence[str], verb: argparse.ArgumentParser) -> str:
    """Return the message for words that a verb does not take, with the options that may be meant."""
    known = re.findall(r"--[a-z-]+", verb.format_usage())
    options = [word for word in words if word.startswith("-")]
    named = [f"{word} ({near_word(word, known, 'there is none like it')})" for word in options]
    expected = "the options" if named else "no words but those"
    return f"expected {expected} above, got {', '.join(named or words)}"


def near_word(word: str, known: Iterable[str], otherwise: str) -> str:
    close = difflib.get_close_matches(word.partition("=")[0], [*known], n=3, cutoff=0.65)
    return f"did you mean {', '.join(close)}?" if close else otherwise


def _whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected a whole number, got {text!r:.60}") from None


def add_argument(verb: argparse.ArgumentParser, line: str) -> None:
    """Add the argument that a line of the text describes."""
    match = _ARGUMENT.fullmatch(line)
    assert match is not None, line
    name, required, sign, value, default, meaning = match.groups()
    if value is None:
        verb.add_argument(name, action="store_true", help=meaning)
        return
    first, *others = value.split("|")
    given: dict[str, Any] = {"help": meaning, "metavar": None if others else first}
    if others:
        given["choices"] = [first, *others]
    if value == "N":
        given["type"] = _whole_number
    if required:
        given["required"] = True
    if sign and name.startswith("-"):
        given |= {"action": "append", "nargs": "+" if sign == "+" else None}
    elif sign:
        given["nargs"] = sign
    verb.add_argument(name, default=default, **given)
