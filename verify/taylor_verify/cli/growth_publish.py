"""`publish --growth`: follow the published ensembles, then write down how their errors grow."""

from __future__ import annotations

from pathlib import Path
from time import monotonic

from taylor_verify.cli.answer import Answer, WrongCall, files_written
from taylor_verify.cli.streams import say

# Below the folder that is published: what is local there is nobody else's.
_CHECKPOINTS = "local/growth"
# Between two signs of life, in seconds.
_PATIENCE = 10.0


def publish_growth(folder: Path, periods: str | None, long: bool) -> Answer:
    """Follow what is published, or the long ensemble alone, and write data, picture and page."""
    from taylor_verify.studies.growth import page as growth
    from taylor_verify.studies.growth.published import LONG, PUBLISHED, followed, forget

    entries, checkpoints = LONG if long else PUBLISHED, folder / _CHECKPOINTS
    most = _read(periods)
    try:
        found = followed(entries, checkpoints, _Progress(), most)
    except ValueError as error:
        raise WrongCall(f"{error} (--growth)") from error
    paths = growth.write(folder, found, long)
    # Only what is stored is done: until then it could still be taken up.
    forget(entries, checkpoints)
    return files_written(paths)


def _read(periods: str | None) -> float | None:
    from taylor_verify.scenes.reading.table import exact_number

    if periods is None:
        return None
    try:
        return float(exact_number(periods))
    except (OverflowError, ValueError) as error:
        raise WrongCall(f"expected a number of periods, got {periods!r} @ --periods") from error


class _Progress:
    """A line for every ensemble, and now and then how far it is."""

    def __init__(self) -> None:
        self._label, self._said = "", 0.0

    def __call__(self, label: str, done: int, of: int) -> None:
        if done == of:
            say(f"{label}: done")
        elif label != self._label or monotonic() - self._said >= _PATIENCE:
            say(f"{label}: piece {done} of {of}")
        else:
            return
        self._label, self._said = label, monotonic()
