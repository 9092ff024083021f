"""A document of a study, stored as its measurement stores it and published as the command does."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Study


def publish_document(
    folder: Path, study: Study[Any], stored: Stored[Any], document: Any
) -> list[Path]:
    """Store a document, draw its pictures and make its pages; return the files written."""
    return [*stored.write(folder, document), *study.publish(folder).written]
