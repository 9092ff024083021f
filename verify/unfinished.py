"""What a run of many scenes has finished so far, kept apart so that an interrupted one can go on.

Each job's judgements are a file of their own in the user's cache, written whole or not at all, named by
all that they depend on: scene, solver, rungs, versions and the text of this package. Nothing of it is
read unless it is asked for, and it is removed when a run has come to its end.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import shutil
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from platformdirs import user_cache_path

if TYPE_CHECKING:
    from verify.job import Job
    from verify.judge.judgement import Judgement


def folder() -> Path:
    return user_cache_path("taylor-verify") / "unfinished"


def forget() -> None:
    """Remove what is kept; a cache that cannot be changed is left alone."""
    shutil.rmtree(folder(), ignore_errors=True)


def kept(job: Job) -> list[Judgement] | None:
    """The judgements of a job that was finished before; None of one that was not."""
    try:
        content = _file(job).read_bytes()
    except OSError:
        return None
    # Of our own writing, in the user's own cache.
    found: list[Judgement] = pickle.loads(content)
    return found


def keep(job: Job, judgements: list[Judgement]) -> None:
    """Store the judgements of a job; where the cache cannot be written, nothing is kept."""
    with suppress(OSError):
        folder().mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder())
        with open(handle, "wb") as file:
            pickle.dump(judgements, file)
        os.replace(name, _file(job))


def _file(job: Job) -> Path:
    from verify.judge.provenance import versions
    from verify.scenes.reader import load

    depends = (load(job.scene).digest, job.scene, job.solver, job.rungs, versions(), _package())
    return folder() / f"{hashlib.sha256(repr(depends).encode()).hexdigest()}.pickle"


@cache
def _package() -> str:
    """A digest of this package's own text: a judgement of other code is no judgement of this one."""
    digest = hashlib.sha256()
    package = Path(__file__).parent
    for file in sorted(package.rglob("*.py")):
        digest.update(str(file.relative_to(package)).encode() + file.read_bytes())
    return digest.hexdigest()
