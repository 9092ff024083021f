"""Verbs that other packages add: the entry points `taylor_verify.verbs`.

An entry point's name is the verb. It points to a module or an object with

    add(parser)      add arguments to the parser of the verb
    run(arguments)   return an Answer (taylor_verify.cli.answer), or an exit status; stdout is for it,
                     what a verb prints by itself goes to stderr
    help, example    texts, which may be left out

A plug-in is imported when its verb is called. One that cannot be imported, whose name is taken, or that
raises, is named in one line, and everything else goes on.
"""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall, wrong_calls
from taylor_verify.cli.streams import say
from taylor_verify.records.faults import Refused
from taylor_verify.records.plugins import (
    BrokenPlugin,
    entries,
    in_one_line,
    load,
    package_of,
    taken,
)

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

KIND: Final = "verbs"
OWN_PACKAGE: Final = "taylor-verify"


def described(verb: EntryPoint) -> tuple[str, str]:
    """Return what a verb does and an example, as far as the plug-in says so.

    Raises WrongCall if it cannot be imported or lacks a part of the contract.
    """
    plugin = _loaded(verb)
    what = getattr(plugin, "help", f"a verb of the package {package_of(verb)}")
    return what, getattr(plugin, "example", "")


def _loaded(verb: EntryPoint) -> Any:
    """Return the object behind an entry point. Raises WrongCall as ``described`` does."""
    with wrong_calls(kinds=BrokenPlugin):
        return load(KIND, verb)


def verbs(own: Collection[str]) -> Iterator[EntryPoint]:
    """Yield the verbs of other packages, each name once; one that is our ``own`` is named on stderr."""
    known = set(own)
    for verb in entries(KIND):
        if verb.name in known:
            say(taken(KIND, verb.name, package_of(verb)))
            continue
        known.add(verb.name)
        yield verb


def add(parser: argparse.ArgumentParser, verb: EntryPoint) -> None:
    """Let a plug-in add its arguments to the parser of its verb. Raises WrongCall as ``described`` does."""
    plugin = _loaded(verb)
    with _named(verb, "arguments"):
        plugin.add(parser)
    parser.set_defaults(act=partial(_act, plugin, verb))


def _act(plugin: Any, verb: EntryPoint, options: argparse.Namespace) -> Answer:
    """Run a verb; an exit status stands for an answer that is printed already."""
    with _named(verb, "an answer"):
        result = plugin.run(options)
    if isinstance(result, Answer):
        return result._replace(text=partial(_text, verb, result))
    if result is not None and not isinstance(result, int):
        expected = f"expected an Answer or a status of the verb {verb.name}"
        raise WrongCall(f"{expected}, got {result!r:.60}")
    return Answer(PASS if result is None else result, {}, str)


def _text(verb: EntryPoint, answer: Answer) -> str:
    with _named(verb, "a text"):
        return answer.text()


@contextmanager
def _named(verb: EntryPoint, what: str) -> Iterator[None]:
    """Name the verb and its package where its code raises an error that names neither."""
    try:
        yield
    except (WrongCall, Refused):
        raise
    except (Exception, SystemExit) as error:
        if package_of(verb) == OWN_PACKAGE and isinstance(error, Exception):
            raise
        got = (
            f"sys.exit({error.code!r:.60})" if isinstance(error, SystemExit) else in_one_line(error)
        )
        source = f"the verb {verb.name} of {package_of(verb)}"
        raise WrongCall(f"expected {what} of {source}, got {got}") from error
