"""The folder of a measurement: what was finished before an interrupt is there the next time.

It lies in the user's cache, one for each study, report and text of both packages. It is removed when the
measurement is whole.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from platformdirs import user_cache_path

from taylor_verify.batch.finished_jobs import package_digest
from taylor_verify.batch.lock import alone_in
from taylor_verify.records.replacement import replace_files


@dataclass(frozen=True)
class Parts:
    """Finished parts as texts, each in a file by the digest of its key, whole or not at all."""

    folder: Path
    suffix: str = ".json"

    def find(self, key: bytes) -> str | None:
        """Return a part; None if it is not finished."""
        file = self.file_of(key)
        return file.read_text(encoding="utf-8") if file.exists() else None

    def keep(self, key: bytes, text: str) -> None:
        """Store a part. Raises OSError."""
        replace_files(self.folder, {self.file_of(key).name: text})

    def file_of(self, key: bytes) -> Path:
        """Return the file of a part."""
        return self.folder / f"{hashlib.sha256(key).hexdigest()[:32]}{self.suffix}"


@contextmanager
def unfinished(study: str, report: Path) -> Iterator[Path]:
    """Open the folder of a study of a report; after an interrupt or an error it stays.

    Where the cache cannot be written, nothing stays. Raises Occupied if the same study is being made.
    """
    own = hashlib.sha256(str(report.resolve()).encode()).hexdigest()[:32]
    place = user_cache_path("taylor-verify") / study / own
    with ExitStack() as stack:
        try:
            stack.enter_context(alone_in(place))
        except OSError:
            place = Path(stack.enter_context(TemporaryDirectory(prefix=f"taylor-verify-{study}-")))
        text = _text()
        for old in place.iterdir():
            if old.is_dir() and old.name != text:
                shutil.rmtree(old, ignore_errors=True)
        yield place / text
        shutil.rmtree(place / text, ignore_errors=True)


def _text() -> str:
    """Return a digest of the text of both packages."""
    package, digest = Path(__file__).parents[1], hashlib.sha256(package_digest().encode())
    for file in sorted(package.rglob("*.py")):
        digest.update(str(file.relative_to(package)).encode() + file.read_bytes())
    return digest.hexdigest()
