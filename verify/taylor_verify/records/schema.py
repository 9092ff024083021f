"""The JSON schema of the documents of `run --json` and `check --json`, made from their types."""

from __future__ import annotations

import json
from typing import Any, Final

import msgspec

from taylor_verify.records.answers import Answer, FilesAnswer
from taylor_verify.records.precisions import RUNG_PATTERN
from taylor_verify.records.status import Status

_DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_DESCRIPTION: Final = (
    "What `taylor-verify run --json` and `taylor-verify check --json` print. Keys that are not listed may "
    "be added; those that are listed keep their meaning."
)
# A row is written with these, whatever it compares.
REQUIRED: Final = (
    "scene",
    "solver",
    "rung",
    "setting",
    "quantity",
    "max",
    "mean",
    "final",
    "at",
    "unit",
    "bound",
    "because",
    "attainable",
    "exponent",
    "verdict",
    "outcome",
    "steps",
    "evaluations",
    "provenance",
)
# What is made of the other keys of a row.
_DERIVED: Final = {
    "because": {"description": "The reason in one line.", "type": "string"},
    "sentence": {
        "description": "The digits that are right, the kind of error that is left, and since when.",
        "type": "string",
        "minLength": 1,
    },
    "digits": {
        "description": "The decimal digits that are right at every sample; null where none were compared.",
        "anyOf": [{"type": "integer", "minimum": 0}, {"type": "null"}],
    },
}


def schema() -> dict[str, Any]:
    """Return the schema of an answer, with what a type cannot say of a row."""
    _, definitions = msgspec.json.schema_components(
        (Answer, FilesAnswer), ref_template="#/$defs/{name}"
    )
    answer = _with_files(definitions.pop(Answer.__name__), definitions.pop(FilesAnswer.__name__))
    verdict = definitions["Verdict"]
    verdict["properties"] = {**_DERIVED, **verdict["properties"]}
    verdict["properties"]["rung"]["pattern"] = RUNG_PATTERN
    verdict["properties"]["quantity"]["minLength"] = 1
    verdict["properties"]["provenance"] = {
        "description": "What the row can be traced to: SHA-256 of the scene's text, versions, machine.",
        "type": "object",
        "required": ["scene"],
        "properties": {"scene": {"type": "string"}},
    }
    verdict["required"] = list(REQUIRED)
    number = {"type": "number"}
    compared = dict.fromkeys(("max", "bound", "attainable", "at"), number)
    verdict["if"] = {"properties": {"verdict": {"const": Status.PASS.value}}}
    verdict["then"] = {"description": "What passed has numbers.", "properties": compared}
    verdict["else"] = {
        "description": "What did not says why.",
        "properties": {"because": {"minLength": 1}},
    }
    answer["properties"]["summary"] |= {
        "required": [status.value for status in Status],
        "propertyNames": {"$ref": "#/$defs/Status"},
    }
    head = {"$schema": _DIALECT, **answer, "title": "Verdicts", "description": _DESCRIPTION}
    result: dict[str, Any] = _tidied({**head, "$defs": definitions})
    return result


def _with_files(answer: dict[str, Any], files: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of an answer for one file, a run, or several files: each has such a document."""
    of_files = {
        name: kind for name, kind in files["properties"].items() if name not in answer["properties"]
    }
    of_files["files"]["items"] = {"$ref": "#"}
    return {
        **answer,
        "properties": answer["properties"] | of_files,
        "required": ["summary"],
        "if": {"required": ["files"]},
        "then": {"required": files["required"]},
        "else": {"required": answer["required"]},
    }


def _tidied(schema: Any) -> Any:
    """Return the schema without the defaults of the types, its docstrings in one line."""
    if isinstance(schema, list):
        return [_tidied(item) for item in schema]
    if isinstance(schema, str):
        return " ".join(schema.split())
    if not isinstance(schema, dict):
        return schema
    return {key: _tidied(value) for key, value in schema.items() if key != "default"}


def text() -> str:
    """Return the schema as `list --schema` prints it and as the site has it."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"
