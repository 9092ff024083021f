"""Messages of a topic in an MCAP file, read with mcap: ROS 2 messages in CDR, and messages in JSON.

Chunks are unpacked here and not by the library, which unpacks as much as they claim.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from io import BytesIO, StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.formats import messages
from taylor_verify.solvers.files.formats.column import BYTES, CHUNK_BYTES, COLUMNS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.messages import MESSAGE_BYTES, Topic
from taylor_verify.solvers.files.formats.missing_library import unbroken

_OF_NO_SIZE: Final = re.compile(rb"\[[\s<=]*0+\s*\]")
_MESSAGES: Final = Limit(20_000_000, "messages", "a minute of reading, all topics together")


def read(file: Content, path: Path, part: str) -> Table:
    """Return the columns of a topic; the file is read twice, first for the topics there are."""
    with unbroken("an MCAP file", path):
        recording = _Recording.of(file, path)
        topic = messages.chosen(recording.topics(), part, path)
        return messages.table(topic, recording.decoded(topic, path), path)


class _Recording(NamedTuple):
    """The schemas and channels of an MCAP file by their numbers, and the number of messages by channel."""

    file: Content
    schemas: dict[int, Any]
    channels: dict[int, Any]
    counts: Counter[int]

    @classmethod
    def of(cls, file: Content, path: Path) -> _Recording:
        from mcap.records import Channel, Message, Schema

        recording = cls(file, {}, {}, Counter())
        for number, record in enumerate(_records(file, path)):
            if isinstance(record, Message):
                recording.counts[record.channel_id] += 1
            elif isinstance(record, Schema):
                recording.schemas[record.id] = record
            elif isinstance(record, Channel):
                recording.channels[record.id] = record
            COLUMNS.check(len(recording.channels) + len(recording.schemas), path)
            _MESSAGES.check(number, path)
        return recording

    def topics(self) -> list[Topic]:
        """Return the topics, by name; the messages of all channels of a topic are counted together."""
        counts = Counter[tuple[str, str]]()
        for number, channel in self.channels.items():
            schema = self.schemas.get(channel.schema_id)
            name = (channel.topic, schema.name if schema else channel.message_encoding)
            counts[name] += self.counts[number]
        return [Topic(name, kind, count) for (name, kind), count in sorted(counts.items())]

    def decoded(self, topic: Topic, path: Path) -> Iterator[Any]:
        """Yield the messages of a topic in the order of the file."""
        from mcap.records import Message

        decoders = {
            number: _decoder(channel, self.schemas.get(channel.schema_id), path)
            for number, channel in self.channels.items()
            if channel.topic == topic.name
        }
        for record in _records(self.file, path):
            if isinstance(record, Message) and record.channel_id in decoders:
                MESSAGE_BYTES.check(len(record.data), path)
                yield decoders[record.channel_id](record.data)


def _decoder(channel: Any, schema: Any, path: Path) -> Callable[[bytes], Any]:
    if channel.message_encoding == "json":
        return _from_json
    from mcap_ros2.decoder import DecoderFactory

    if _OF_NO_SIZE.search(schema.data if schema else b""):
        raise ValueError("an array of no elements, of which a message could hold any number")
    # It prints a definition that it cannot read before it raises.
    with redirect_stderr(StringIO()):
        decode = DecoderFactory().decoder_for(channel.message_encoding, schema)
    if decode is None:
        got = f"{channel.message_encoding or 'no encoding'} with schemas in {schema.encoding or 'none'}"
        expected = "ROS 2 messages (cdr, ros2msg) or JSON"
        raise refusal(expected, cut(got), f"{path}, topic {cut(channel.topic)}")
    decoded: Callable[[bytes], Any] = decode
    return decoded


def _from_json(data: bytes) -> Any:
    """Return a message with its numbers as text, so that none is rounded."""
    return json.loads(
        data, parse_float=str, parse_int=str, object_hook=lambda pairs: SimpleNamespace(**pairs)
    )


# Records and chunks.


class _Bounded:
    """A file of which no call reads more than a trajectory file has, whatever a record claims."""

    def __init__(self, file: Content) -> None:
        self._file = file.binary

    def read(self, size: int) -> bytes:
        return self._file.read(min(size, BYTES.most))


def _records(file: Content, path: Path) -> Iterator[Any]:
    """Yield the records of the file from its beginning, those in chunks among them."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader

    unpacked = 0
    stream: Any = _Bounded(file)
    for record in StreamReader(stream, emit_chunks=True, record_size_limit=BYTES.most).records:
        if isinstance(record, Chunk):
            data = _unpacked(record, CHUNK_BYTES.most + 1)
            CHUNK_BYTES.check(len(data), path)
            unpacked += len(data)
            BYTES.check(unpacked, path)
            yield from _in_chunk(data)
        else:
            yield record


def _unpacked(chunk: Any, most: int) -> bytes:
    """Return the content of a chunk, of at most so many bytes."""
    if chunk.compression == "zstd":
        import zstandard

        reader = zstandard.ZstdDecompressor().stream_reader(chunk.data)
        return bytes(reader.read(most))
    if chunk.compression == "lz4":
        from lz4.frame import LZ4FrameDecompressor

        return bytes(LZ4FrameDecompressor().decompress(chunk.data, most))
    if chunk.compression:
        raise ValueError(f"the compression {cut(chunk.compression)}")
    return bytes(chunk.data)


def _in_chunk(data: bytes) -> Iterator[Any]:
    from mcap.data_stream import ReadDataStream
    from mcap.opcode import Opcode
    from mcap.records import Channel, Message, Schema

    stream = ReadDataStream(BytesIO(data))
    while stream.count < len(data):
        opcode, length = stream.read1(), stream.read8()
        if opcode == Opcode.MESSAGE:
            yield Message.read(stream, length)
        elif opcode in (Opcode.CHANNEL, Opcode.SCHEMA):
            yield (Channel if opcode == Opcode.CHANNEL else Schema).read(stream)
        else:
            stream.read(length)
