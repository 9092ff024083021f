"""The README of the packages: its links lead to the repository, once the repository has an address."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

LINK = re.compile(r"(\]\()(?!\w+:|#)([^()\s]+\))")
PICTURE = re.compile(r"(!\[[^\]]*\]\()(?!\w+:)([^()\s]+\))")


def absolute(text: str, address: str) -> str:
    """Return Markdown whose relative links begin with ``address``; unchanged without one."""
    if not address:
        return text
    # GitHub shows a page at blob, and the picture itself at raw.
    pictures = PICTURE.sub(rf"\1{address.replace('/blob/', '/raw/')}/\2", text)
    return LINK.sub(rf"\1{address}/\2", pictures)


class Readme(MetadataHookInterface):
    """Metadata hook of hatchling; `address` stands in pyproject.toml."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Set the readme of the package."""
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        text = absolute(text, self.config["address"])
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
