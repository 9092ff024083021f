"""A report folder as one archive, with the same bytes on every machine and day."""

from __future__ import annotations

import gzip
import hashlib
import io
import tarfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files

SUMS: Final = "SHA256SUMS"
# Folders that a user's own runs and the site write.
_LOCAL: Final = ("local", "site")


def pack(folder: Path, target: Path, name: str) -> list[Path]:
    """Write ``target``/NAME.tar.gz and NAME.tar.gz.sha256, and return both.

    The archive has one folder, NAME, with the files of ``folder`` and with SHA256SUMS, a list that
    `sha256sum --check` reads. Hidden files, compiled Python and the folders ``local`` and ``site`` are left
    out. Names are sorted; no date, owner or machine is stored. Raises OSError.
    """
    contents = {path: (folder / path).read_bytes() for path in _paths(folder)}
    sums = "".join(f"{_digest(content)}  {path}\n" for path, content in contents.items())
    files = {**contents, SUMS: sums.encode()}
    packed = gzip.compress(tar({f"{name}/{path}": file for path, file in files.items()}), mtime=0)
    file = f"{name}.tar.gz"
    texts: dict[str, str | bytes] = {file: packed, f"{file}.sha256": f"{_digest(packed)}  {file}\n"}
    return list(replace_files(target, texts))


def _paths(folder: Path) -> list[str]:
    """Return the paths of all files except hidden ones, local ones and compiled Python."""
    paths = [file.relative_to(folder) for file in folder.rglob("*") if file.is_file()]
    return sorted(
        path.as_posix()
        for path in paths
        if path.parts[0] not in _LOCAL
        and not any(part.startswith((".", "__pycache__")) for part in path.parts)
    )


def tar(contents: Mapping[str, bytes]) -> bytes:
    """Return a tar archive of ``contents``, the files by their names, with the same bytes every time."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path, content in contents.items():
            member = tarfile.TarInfo(path)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return stream.getvalue()


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
