"""The published schema of a document of verdicts, and the places where a document breaks it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator

SCHEMA_FILE = (
    Path(__file__).resolve().parents[2] / "verify/taylor_verify/records/verdicts.schema.json"
)

SCHEMA = json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))


def violations(document: Any) -> list[str]:
    """The places where a document is not of the published schema."""
    errors = Draft202012Validator(SCHEMA).iter_errors(document)
    return [f"{error.message} @ {error.json_path}" for error in errors]
