"""Messages of a topic in a rosbag: a .bag of ROS 1 with rosbags, a .db3 or a folder of ROS 2.

Messages are taken apart by the definitions that ROS ships, and no definition in a bag becomes code. A bag
of ROS 2 that is packed is refused: nothing says before how large it is.
"""

from __future__ import annotations

import bz2
import os
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.records.regular_file import read_bytes, regular_file
from taylor_verify.solvers.files.formats import mcap, messages
from taylor_verify.solvers.files.formats.column import BYTES, COLUMNS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.database import Database, database
from taylor_verify.solvers.files.formats.messages import Topic
from taylor_verify.solvers.files.formats.missing_library import unbroken

_METADATA: Final = "metadata.yaml"
_METADATA_BYTES: Final = Limit(2**22, "bytes", "a thousand topics take a megabyte")
_PACKED: Final = re.compile(r"compression_mode:\s*['\"]?(file|message)", re.IGNORECASE)
# The names of files in the metadata, which is YAML: a reader of that takes minutes of a megabyte.
_DATABASES: Final = re.compile(r"[^\s'\"\[\],/]+\.db3\b")
_ROS1: Final = ".bag"


def is_folder(path: Path) -> bool:
    """Return True for the folder of a rosbag of ROS 2."""
    return os.path.isfile(os.path.join(path, _METADATA))


def read_folder(path: Path, part: str) -> Table:
    """Return the columns of a topic in the folder of a rosbag, which is held to the size of one file."""
    names = sorted(os.listdir(path))
    COLUMNS.check(len(names), path)
    size = 0
    for name in names:
        with regular_file(path / name, "a file of a rosbag", BYTES) as file:
            size += os.fstat(file.fileno()).st_size
    BYTES.check(size, path)
    content = read_bytes(path / _METADATA, "the metadata of a rosbag", _METADATA_BYTES)
    metadata = content.decode(errors="replace")
    if _PACKED.search(metadata):
        mend = "`ros2 bag convert` unpacks it"
        raise refusal("a rosbag that is not packed", "a packed one", path, mend)
    recordings = [path / name for name in names if name.endswith(".mcap")]
    if len(recordings) > 1:
        files = ", ".join(cut(file.name) for file in recordings[:3])
        raise refusal("one file", f"{files} ...", path, "name one of them")
    if not recordings:
        listed = list(dict.fromkeys(_DATABASES.findall(metadata)))
        if missing := [name for name in listed if name not in names]:
            raise refusal("the files of the metadata", f"no {cut(missing[0])}", path)
        return _of_ros2([path / name for name in listed], path, part)
    with regular_file(recordings[0], "a trajectory file", BYTES) as file:
        return mcap.read(Content(file, recordings[0]), recordings[0], part)


def read(file: Content, path: Path, part: str) -> Table:
    """Return the columns of a topic in a file; the library opens it again by its name."""
    del file
    return _of_ros1(path, part) if path.suffix.lower() == _ROS1 else _of_ros2([path], path, part)


# ROS 2.


def _of_ros2(files: Sequence[Path], path: Path, part: str) -> Table:
    with unbroken("a rosbag", path), ExitStack() as stack:
        databases = [stack.enter_context(database(file)) for file in files]
        counts = Counter[tuple[str, str]]()
        for each in databases:
            messages_of = each.counts()
            for topic in each.topics():
                counts[topic.name, topic.kind] += messages_of[topic.number]
        topics = [Topic(*names, count) for names, count in sorted(counts.items())]
        chosen = messages.chosen(topics, part, path)
        return messages.table(chosen, _decoded(databases, chosen, path), path)


def _decoded(databases: Sequence[Database], topic: Topic, path: Path) -> Iterator[Any]:
    """Yield the messages of a topic, file by file."""
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.LATEST)
    own = types.hash_rihs01(topic.kind)
    for each in databases:
        stored = [s for s in each.topics() if (s.name, s.kind) == (topic.name, topic.kind)]
        for entry in stored:
            _check_digest(entry.digest, own, topic, path)
            if entry.form != "cdr":
                raise refusal("messages in cdr", cut(entry.form), path)
        for data in each.messages([entry.number for entry in stored]):
            yield types.deserialize_cdr(data, topic.kind)


def _check_digest(digest: str, own: str, topic: Topic, path: Path) -> None:
    if digest not in ("", own):
        raise refusal(f"{topic.kind} as ROS defines it", cut(digest), path)


# ROS 1.


def _of_ros1(path: Path, part: str) -> Table:
    from rosbags import rosbag1

    with unbroken("a rosbag", path), rosbag1.Reader(path) as reader:
        _bound_chunks(reader, path)
        counts = ((entry.topic, entry.msgtype, entry.msgcount) for entry in reader.connections)
        topic = messages.chosen([Topic(*count) for count in sorted(counts)], part, path)
        return messages.table(topic, _decoded_ros1(reader, topic, path), path)


def _decoded_ros1(reader: Any, topic: Topic, path: Path) -> Iterator[Any]:
    """Yield the messages of a topic by the time of their recording."""
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    own = types.generate_msgdef(topic.kind)[1]
    connections = [entry for entry in reader.connections if entry.topic == topic.name]
    for entry in connections:
        _check_digest(entry.digest, own, topic, path)
    for connection, _, data in reader.messages(connections=connections):
        messages.MESSAGE_BYTES.check(len(data), path)
        yield types.deserialize_ros1(data, connection.msgtype)


def _bound_chunks(reader: Any, path: Path) -> None:
    """Have the chunks of a bag of ROS 1 unpacked within the size of a trajectory file, all together."""
    from lz4.frame import LZ4FrameDecompressor
    from rosbags.rosbag1.reader import decompressors

    unpackers: dict[Any, Callable[[], Any]] = {
        decompressors["bz2"]: bz2.BZ2Decompressor,
        decompressors["lz4"]: LZ4FrameDecompressor,
    }
    size = 0

    def unpack(unpacker: Callable[[], Any], data: bytes) -> bytes:
        nonlocal size
        unpacked = bytes(unpacker().decompress(data, BYTES.most - size + 1))
        size += len(unpacked)
        BYTES.check(size, path)
        return unpacked

    for place, chunk in reader.chunks.items():
        if unpacker := unpackers.get(chunk.decompressor):
            reader.chunks[place] = chunk._replace(decompressor=partial(unpack, unpacker))
