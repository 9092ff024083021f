"""Messages of a topic in a rosbag, read with rosbags: a .bag of ROS 1, a .db3 or a folder of ROS 2.

Messages are taken apart by the definitions that ROS ships, and no definition in a bag becomes code. A bag
of ROS 2 that is packed is refused: nothing says before how large it is.
"""

from __future__ import annotations

import bz2
import os
import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.regular_file import read_bytes, regular_file
from taylor_verify.solvers.files.formats import mcap, messages
from taylor_verify.solvers.files.formats.column import BYTES, COLUMNS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.messages import Topic
from taylor_verify.solvers.files.formats.package import unbroken

_METADATA: Final = "metadata.yaml"
_PACKED: Final = re.compile(r"compression_mode:\s*['\"]?(file|message)", re.IGNORECASE)
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
    metadata = read_bytes(path / _METADATA, "the metadata of a rosbag", BYTES)
    if _PACKED.search(metadata.decode(errors="replace")):
        mend = "`ros2 bag convert` unpacks it"
        raise refusal("a rosbag that is not packed", "a packed one", path, mend)
    recordings = [path / name for name in names if name.endswith(".mcap")]
    if len(recordings) > 1:
        files = ", ".join(cut(file.name) for file in recordings[:3])
        raise refusal("one file", f"{files} ...", path, "name one of them")
    if not recordings:
        return _table(path, part)
    with regular_file(recordings[0], "a trajectory file", BYTES) as file:
        return mcap.read(Content(file, recordings[0]), recordings[0], part)


def read(file: Content, path: Path, part: str) -> Table:
    """Return the columns of a topic in a file; the library opens it again by its name."""
    del file
    return _table(path, part)


def _table(path: Path, part: str) -> Table:
    from rosbags import rosbag1, rosbag2

    with unbroken("a rosbag", path):
        is_ros1 = path.suffix.lower() == _ROS1
        with rosbag1.Reader(path) if is_ros1 else rosbag2.Reader(path) as reader:
            if is_ros1:
                _bound_chunks(reader, path)
            counts = ((entry.topic, entry.msgtype, entry.msgcount) for entry in reader.connections)
            topic = messages.chosen([Topic(*count) for count in sorted(counts)], part, path)
            return messages.table(topic, _decoded(reader, topic, path), path)


def _decoded(reader: Any, topic: Topic, path: Path) -> Iterator[Any]:
    """Yield the messages of a topic by the time of their recording."""
    from rosbags.typesys import Stores, get_typestore

    is_ros1 = path.suffix.lower() == _ROS1
    types = get_typestore(Stores.ROS1_NOETIC if is_ros1 else Stores.LATEST)
    decode = types.deserialize_ros1 if is_ros1 else types.deserialize_cdr
    own = types.generate_msgdef(topic.kind)[1] if is_ros1 else types.hash_rihs01(topic.kind)
    connections = [entry for entry in reader.connections if entry.topic == topic.name]
    if foreign := [entry for entry in connections if entry.digest not in ("", own)]:
        raise refusal(f"{topic.kind} as ROS defines it", cut(foreign[0].digest), path)
    for connection, _, data in reader.messages(connections=connections):
        yield decode(data, connection.msgtype)


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
