"""Verbs that other packages add: the entry points `taylor_verify.verbs`.

An entry point's name is the verb. It points to a module or an object with

    add(parser)      add arguments to the parser of the verb
    run(arguments)   return an Answer (taylor_verify.cli.answer), or an exit status after printing by itself
    help, example    texts, which may be left out

A plug-in is imported when its verb is called. One that cannot be imported, or whose name is taken, is named
in one line, and everything else goes on.
"""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall
from taylor_verify.cli.streams import say

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP: Final = "taylor_verify.verbs"


@dataclass(frozen=True)
class Verb:
    """A verb of another package: its name, the package's and where it points to."""

    entry: EntryPoint

    @property
    def name(self) -> str:
        return self.entry.name

    @property
    def package(self) -> str:
        """The distribution that brings it."""
        return self.entry.dist.name if self.entry.dist is not None else "an unknown package"

    def loaded(self) -> Any:
        """Return the object behind the entry point.

        Raises WrongCall if it cannot be imported or lacks a part of the contract.
        """
        try:
            plugin = self.entry.load()
        except Exception as error:
            raise WrongCall(
                f"expected the verb {self.name} of {self.package}, got {type(error).__name__}: {error}"
            ) from error
        lacking = [part for part in ("add", "run") if not callable(getattr(plugin, part, None))]
        if lacking:
            raise WrongCall(
                f"expected the verb {self.name} of {self.package} to have {' and '.join(lacking)}, "
                "got none"
            )
        return plugin

    def described(self) -> tuple[str, str]:
        """Return what the verb does and an example, as far as the plug-in says so."""
        plugin = self.loaded()
        return getattr(plugin, "help", f"a verb of the package {self.package}"), getattr(
            plugin, "example", ""
        )


def verbs(taken: Collection[str]) -> Iterator[Verb]:
    """Yield the verbs of other packages, each name once; one that is ``taken`` is named on stderr."""
    from importlib.metadata import entry_points

    known = set(taken)
    for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name):
        verb = Verb(entry)
        if verb.name in known:
            say(f"the verb {verb.name} of {verb.package} is left out: there is one of this name")
            continue
        known.add(verb.name)
        yield verb


def add(parser: argparse.ArgumentParser, verb: Verb) -> None:
    """Let a plug-in add its arguments to the parser of its verb. Raises WrongCall as ``loaded`` does."""
    plugin = verb.loaded()
    plugin.add(parser)
    parser.set_defaults(act=partial(_act, plugin))


def _act(plugin: Any, options: argparse.Namespace) -> Answer:
    """Run a verb; an exit status stands for an answer that is printed already."""
    result = plugin.run(options)
    if isinstance(result, Answer):
        return result
    return Answer(PASS if result is None else int(result), {}, str)
