"""A bound on the memory of a library that unpacks whatever a file holds.

Parquet says the size of a page twice, and a file that lies in its footer becomes a million times as large
while it is read. Where the system can bound the memory of a process, such a file is refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from taylor_verify.records.limit import Limit

MEMORY: Final = Limit(
    7 * 2**27, "bytes of memory", "twice what a file may hold, and some for its reader"
)


@contextmanager
def bounded_memory(place: object) -> Iterator[None]:
    """Refuse the file at ``place`` if the block asks for more memory than the limit; on Linux alone."""
    try:
        import resource

        pages = int(Path("/proc/self/statm").read_text().split()[5])
    except (ImportError, OSError):
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    most = pages * resource.getpagesize() + MEMORY.most
    is_bounded = soft == resource.RLIM_INFINITY or most < soft
    if is_bounded:
        resource.setrlimit(resource.RLIMIT_DATA, (most, hard))
    try:
        yield
    except MemoryError:
        raise MEMORY.refusal("more", place) from None
    finally:
        if is_bounded:
            resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))
