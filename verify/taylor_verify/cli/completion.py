"""Completion of words in a shell: the script that shtab makes of the arguments and of the scenes."""

from __future__ import annotations

import argparse
from typing import Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall

SHELLS: Final = ("bash", "zsh", "fish")
_SCENES: Final = "_taylor_verify_scenes"
# Names of shipped scenes or files, as each shell has it.
_FUNCTIONS: Final = {
    "bash": '{name}() {{ compgen -W "{words}" -- "$1"; compgen -f -- "$1"; }}',
    "zsh": "{name}() {{ compadd -- {words}; _files }}",
    "fish": "",
}


def completion(parser: argparse.ArgumentParser, shell: str) -> Answer:
    """Return the script that makes a shell complete verbs, options, words and scenes.

    Raises WrongCall without shtab.
    """
    try:
        import shtab
    except ModuleNotFoundError as error:
        expected = "expected shtab (pip install 'taylor-verify[completion]')"
        raise WrongCall(f"{expected}, got none @ --completion") from error
    from taylor_verify.scenes.library import ENGINES, EXTREMES, STANDARD_SET, WORST, names

    words = " ".join((*STANDARD_SET, EXTREMES, *names(*STANDARD_SET, EXTREMES, WORST, ENGINES)))
    files = shtab.FILE
    scenes = {**files, "bash": _SCENES, "zsh": _SCENES, "fish": f"{words} {files['fish']}"}
    for action in _actions(parser):
        if action.metavar == "SCENE":
            action.complete = scenes  # type: ignore[attr-defined]
        elif action.metavar in ("FILE", "DIR"):
            action.complete = files if action.metavar == "FILE" else shtab.DIRECTORY  # type: ignore[attr-defined]
    function = _FUNCTIONS[shell].format(name=_SCENES, words=words)
    script = shtab.complete(parser, shell, preamble=function)
    return Answer(PASS, {"script": script}, lambda: script)


def _actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Return the arguments of a parser and of its verbs."""
    actions: list[argparse.Action] = []
    for action in parser._actions:  # no public way to them; shtab reads the same
        actions.append(action)
        if isinstance(action, argparse._SubParsersAction):
            actions += [each for verb in action.choices.values() for each in _actions(verb)]
    return actions
