"""Trajectory files as the libraries of each format write them, from columns t, w1 w2 w3, q0 ... q3."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow as pa
from ccsds_ndm import mapping, ndm_io
from ccsds_ndm.models import ndmxml4
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from mcap_ros2.writer import Writer as Ros2Writer
from pyarrow import parquet
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_typestore
from scipy.io import savemat

OMEGA, QUATERNION = ("w1", "w2", "w3"), ("q0", "q1", "q2", "q3")
# A second of a clock: the time of a recording that was made by a robot, and no simulation.
CLOCK = 1_700_000_000
HEADER = "std_msgs/Header header\n"
IMU = f"""{HEADER}geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
SCALAR_FIRST = ("qc", "q1", "q2", "q3")
Columns = Mapping[str, Sequence[float]]
_ZEROS = [0.0] * 9


def nanoseconds(time: float) -> int:
    """The time of a row as a stamp; a test's times are whole nanoseconds."""
    count = Decimal(repr(time)).scaleb(9)
    assert count == int(count)
    return int(count)


def imu(columns: Columns, start: int = CLOCK) -> Iterator[tuple[int, dict[str, Any]]]:
    """A message of sensor_msgs/Imu for each row, as a dictionary, with its time of recording."""
    for k, time in enumerate(columns["t"]):
        stamp = start * 10**9 + nanoseconds(time)
        q, w = ([columns[n][k] for n in names] for names in (QUATERNION, OMEGA))
        header = {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}, "frame_id": "base"}
        yield (
            stamp,
            {
                "header": header,
                "orientation": dict(zip("wxyz", q, strict=True)),
                "orientation_covariance": _ZEROS,
                "angular_velocity": dict(zip("xyz", w, strict=True)),
                "angular_velocity_covariance": _ZEROS,
                "linear_acceleration": dict.fromkeys("xyz", 0.0),
                "linear_acceleration_covariance": _ZEROS,
            },
        )


# MCAP and rosbags.


def write_mcap(
    file: Path,
    columns: Columns,
    topics: Sequence[str] = ("/imu",),
    compression: CompressionType = CompressionType.ZSTD,
    start: int = CLOCK,
) -> None:
    with file.open("wb") as stream:
        writer = Ros2Writer(stream, compression=compression)
        schema = writer.register_msgdef("sensor_msgs/msg/Imu", IMU)
        for stamp, message in imu(columns, start):
            for topic in topics:
                writer.write_message(topic, schema, message, log_time=stamp)
        writer.finish()


def write_json_mcap(file: Path, columns: Columns) -> None:
    with file.open("wb") as stream:
        writer = McapWriter(stream)
        writer.start()
        schema = writer.register_schema("sensor_msgs/Imu", "jsonschema", b"{}")
        channel = writer.register_channel("/imu", "json", schema)
        for stamp, message in imu(columns):
            data = json.dumps(message).encode()
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()


def _made(types: Mapping[str, Any], name: str, values: Mapping[str, Any]) -> Any:
    """The message of a type of rosbags, which asks for its class and for arrays."""
    kind = types[name]
    inner = {
        "header": "std_msgs/msg/Header",
        "stamp": "builtin_interfaces/msg/Time",
        "orientation": "geometry_msgs/msg/Quaternion",
    }
    made = {
        key: _made(types, inner.get(key, "geometry_msgs/msg/Vector3"), value)
        if isinstance(value, dict)
        else np.array(value)
        if isinstance(value, list)
        else value
        for key, value in values.items()
    }
    if name == "std_msgs/msg/Header" and "seq" in kind.__dataclass_fields__:
        made["seq"] = 0
    return kind(**made)


def write_rosbag1(
    file: Path, columns: Columns, compression: rosbag1.Writer.CompressionFormat | None = None
) -> None:
    types = get_typestore(Stores.ROS1_NOETIC)
    writer = rosbag1.Writer(file)
    if compression is not None:
        writer.set_compression(compression)
    with writer:
        name = "sensor_msgs/msg/Imu"
        connection = writer.add_connection("/imu", name, typestore=types)
        for stamp, values in imu(columns):
            message = _made(types.types, name, values)
            writer.write(connection, stamp, types.serialize_ros1(message, name))


def write_rosbag2(
    folder: Path,
    columns: Columns,
    plugin: rosbag2.StoragePlugin = rosbag2.StoragePlugin.SQLITE3,
    packed: rosbag2.CompressionMode | None = None,
) -> None:
    types = get_typestore(Stores.LATEST)
    writer = rosbag2.Writer(folder, version=9, storage_plugin=plugin)
    if packed is not None:
        writer.set_compression(packed, rosbag2.CompressionFormat.ZSTD)
    with writer:
        name = "sensor_msgs/msg/Imu"
        connection = writer.add_connection("/imu", name, typestore=types)
        for stamp, values in imu(columns):
            message = _made(types.types, name, values)
            writer.write(connection, stamp, types.serialize_cdr(message, name))


# CCSDS.


def epoch(time: float, day: str = "2024-03-01T00:00:") -> str:
    """The epoch of a time below a minute, with every digit of it."""
    whole, _, part = f"{Decimal(repr(time)):f}".partition(".")
    return f"{day}{int(whole):02d}.{part or '0'}"


def aem(columns: Columns, **metadata: Any) -> Any:
    """An AEM of version 2 with the quaternions, A the space and B the body."""
    kind = ndmxml4.QuaternionEphemerisType
    states = [
        ndmxml4.AttitudeStateType(
            quaternion_ephemeris=kind(
                epoch=epoch(columns["t"][k]),
                quaternion=ndmxml4.QuaternionType(
                    **{n: columns[c][k] for n, c in zip(SCALAR_FIRST, QUATERNION, strict=True)}
                ),
            )
        )
        for k in range(len(columns["t"]))
    ]
    described = {
        "object_name": "TOP",
        "object_id": "2024-001A",
        "ref_frame_a": "EME2000",
        "ref_frame_b": "SC_BODY_1",
        "time_system": "TAI",
        "start_time": epoch(columns["t"][0]),
        "stop_time": epoch(columns["t"][-1]),
        "attitude_type": ndmxml4.AttitudeTypeType.QUATERNION_1,
        **metadata,
    }
    segment = ndmxml4.AemSegment(
        metadata=ndmxml4.AemMetadata(**described), data=ndmxml4.AemData(attitude_state=states)
    )
    header = ndmxml4.AdmHeader(creation_date="2024-03-01T00:00:00", originator="TESTS")
    return ndmxml4.Aem(header=header, body=ndmxml4.AemBody(segment=[segment]))


def with_rates(message: Any, columns: Columns, frame: str = "SC_BODY_1") -> Any:
    """The AEM with angular velocities too, in degrees a second."""
    (segment,) = message.body.segment
    segment.metadata.attitude_type = ndmxml4.AttitudeTypeType.QUATERNION_ANGVEL_1
    segment.metadata.angvel_frame = frame
    for k, state in enumerate(segment.data.attitude_state):
        plain, state.quaternion_ephemeris = state.quaternion_ephemeris, None
        rates = [np.degrees(columns[name][k]) for name in OMEGA]
        state.quaternion_ang_vel = ndmxml4.QuaternionAngVelType(
            epoch=plain.epoch,
            quaternion=plain.quaternion,
            ang_vel=ndmxml4.AngVelType(
                **{
                    f"angvel_{letter}": ndmxml4.AngVelComponentType(value=float(rate))
                    for letter, rate in zip("xyz", rates, strict=True)
                }
            ),
        )
    return message


def write_aem(file: Path, message: Any) -> None:
    """Write a message as text (KVN), or as XML by the name of the file."""
    form = mapping.NDMFileFormats.XML if file.suffix == ".xml" else mapping.NDMFileFormats.KVN
    ndm_io.NdmIo().to_file(message, form, file)


# Arrays.


def arrays(columns: Columns) -> dict[str, Any]:
    return {name: np.array(values) for name, values in columns.items()}


def write_mat(file: Path, columns: Columns) -> None:
    savemat(file, arrays(columns), do_compression=True, oned_as="column")


def write_struct_mat(file: Path, columns: Columns) -> None:
    savemat(file, {"log": arrays(columns)}, oned_as="row")


def write_hdf5(file: Path, columns: Columns) -> None:
    with h5py.File(file, "w") as content:
        for name, values in arrays(columns).items():
            content.create_dataset(f"sim/{name}", data=values, compression="gzip", shuffle=True)


def write_parquet(file: Path, columns: Columns) -> None:
    parquet.write_table(pa.table(arrays(columns)), file)


def write_npz(file: Path, columns: Columns) -> None:
    np.savez(file, **arrays(columns))


WRITERS: Mapping[str, Callable[[Path, Columns], None]] = {
    "run.mat": write_mat,
    "struct.mat": write_struct_mat,
    "run.h5": write_hdf5,
    "run.parquet": write_parquet,
    "run.npz": write_npz,
    "run.mcap": write_mcap,
    "json.mcap": write_json_mcap,
    "run.bag": write_rosbag1,
    "folder": write_rosbag2,
}
