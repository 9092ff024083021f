"""Kinds of bodies are told apart in tables alone: adding one changes no room that treats all alike."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest

import taylor_verify
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import State

PACKAGE: Final = Path(taylor_verify.__file__).parent
# Elsewhere a solver, a control, a reader or a study may be made for one kind of body, and asks for it.
ROOMS: Final = ("batch", "cli", "judge", "models", "plotting", "records", "testing", "words")
KINDS: Final = {kind.__name__ for base in (Body, State) for kind in base.__subclasses__()}


def questions(source: str) -> Iterator[str]:
    """The lines in which a kind of body or state is asked for."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Call(func=ast.Name(id="isinstance"), args=[_, kind]):
                if KINDS & {part.id for part in ast.walk(kind) if isinstance(part, ast.Name)}:
                    yield f"line {node.lineno}: {ast.unparse(node)}"


@pytest.mark.parametrize("room", ROOMS)
def test_no_kind_of_body_is_asked_for(room: str) -> None:
    """These rooms ask a body for its parts, or look its class up in a table."""
    files = sorted((PACKAGE / room).rglob("*.py"))
    assert files
    asked = [f"{file.name} {q}" for file in files for q in questions(file.read_text("utf-8"))]
    assert asked == []


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_planted_question_is_named(kind: str) -> None:
    """Every kind is recognised, alone and in a union."""
    assert len(list(questions(f"isinstance(body, {kind})\nisinstance(b, int | m.x | {kind})"))) == 2
