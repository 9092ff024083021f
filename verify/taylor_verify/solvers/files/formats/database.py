"""The topics and messages in a database of a rosbag of ROS 2: tables alone, in bounded time.

A view, a virtual table and a recursive query can run for ever without a byte of data, so SQLite is told
which tables it may read, and stops after a bounded number of its steps.
"""

from __future__ import annotations

import sqlite3
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.formats.column import COLUMNS, ROWS
from taylor_verify.solvers.files.formats.messages import MESSAGE_BYTES

_TABLES: Final = ("topics", "messages")
_READABLE: Final = (*_TABLES, "sqlite_master")
_STEPS_AT_ONCE: Final = 10**6
_STEPS: Final = Limit(500, "million steps of SQLite", "ten million messages take a fifth of them")


class Stored(NamedTuple):
    """A topic as its table has it; ``digest`` is that of its type, and empty in old recordings."""

    number: int
    name: str
    kind: str
    form: str
    digest: str


class Database:
    """An open database."""

    def __init__(self, connection: sqlite3.Connection, path: Path) -> None:
        self._connection, self._path = connection, path
        self._million = 0
        connection.row_factory = sqlite3.Row
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MESSAGE_BYTES.most)
        connection.set_authorizer(_permission)
        connection.set_progress_handler(self._goes_on, _STEPS_AT_ONCE)
        self._check_tables()

    def topics(self) -> list[Stored]:
        """Return the topics."""
        rows = self._rows(f"SELECT * FROM topics LIMIT {COLUMNS.most + 1}")
        topics = [_topic(dict(row)) for row in rows]
        COLUMNS.check(len(topics), self._path)
        return topics

    def counts(self) -> Counter[int]:
        """Return the number of messages by the number of their topic."""
        return Counter(
            dict(self._rows("SELECT topic_id, count(*) FROM messages GROUP BY topic_id"))
        )

    def messages(self, topics: Sequence[int]) -> Iterator[bytes]:
        """Yield the messages of some topics by the time of their recording."""
        among = f"topic_id IN ({', '.join(map(str, topics))}) LIMIT {ROWS.most + 1}"
        rows = self._rows(f"SELECT timestamp, rowid FROM messages WHERE {among}")
        # They are sorted here: without an index SQLite would sort the messages themselves.
        for _, row in sorted(map(tuple, rows)):
            # As a list: a reader that ends early must leave no cursor behind.
            one = self._rows(f"SELECT data FROM messages WHERE rowid = {row}")
            yield from [data for (data,) in one]

    def _check_tables(self) -> None:
        """Refuse a database whose topics or messages are a view or a virtual table, which has no page."""
        rows = self._rows("SELECT name FROM sqlite_master WHERE type = 'table' AND rootpage > 0")
        names = {name for (name,) in rows}
        if missing := [name for name in _TABLES if name not in names]:
            raise refusal("the tables topics and messages", f"no {missing[0]}", self._path)

    def _rows(self, query: str) -> Iterator[Any]:
        """Yield the rows of a query, each by number or by name."""
        try:
            yield from self._connection.execute(query)
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode != sqlite3.SQLITE_INTERRUPT:
                raise
            if self._million <= _STEPS.most:
                raise KeyboardInterrupt from None
            raise _STEPS.refusal("more", self._path) from None

    def _goes_on(self) -> bool:
        """Return True to stop SQLite. Python raises KeyboardInterrupt here, and sqlite3 swallows it."""
        self._million += 1
        return self._million > _STEPS.most


@contextmanager
def database(path: Path) -> Iterator[Database]:
    """Open a database for reading; a journal beside it is not looked at."""
    address = f"{path.absolute().as_uri()}?mode=ro&immutable=1"
    with closing(sqlite3.connect(address, uri=True)) as connection:
        yield Database(connection, path)


def _permission(action: int, first: str | None, second: str | None, *where: str | None) -> int:
    """Return whether SQLite may do something: read our tables by no view, and count."""
    _, view = where
    is_reading = action == sqlite3.SQLITE_READ and first in _READABLE and view is None
    is_counting = action == sqlite3.SQLITE_FUNCTION and second == "count"
    is_allowed = action == sqlite3.SQLITE_SELECT or is_reading or is_counting
    return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY


def _topic(row: dict[str, Any]) -> Stored:
    number, name, kind = row["id"], row["name"], row["type"]
    form, digest = row["serialization_format"], row.get("type_description_hash", "")
    if type(number) is not int or not all(isinstance(x, str) for x in (name, kind, form, digest)):
        raise ValueError(f"the topic {cut(repr(name))}")
    return Stored(number, name, kind, form, digest)
