"""The places where a document of verdicts breaks the schema."""

from __future__ import annotations

from typing import Any

from jsonschema import Draft202012Validator

from taylor_verify.records.schema import schema

SCHEMA = schema()


def violations(document: Any) -> list[str]:
    """The places where a document is not of the schema."""
    errors = Draft202012Validator(SCHEMA).iter_errors(document)
    return [f"{error.message} @ {error.json_path}" for error in errors]
