"""Frames of MAVLink 2 (https://mavlink.io/en/guide/serialization.html), as far as stream.py needs them.

A message is a dict of its fields. pymavlink knows all messages; this is the same in a hundred lines, with nothing to install.
"""

from __future__ import annotations

import struct
from typing import Any, Iterator, Mapping, NamedTuple


class Message(NamedTuple):
    """The name of a message and its fields in the order of the wire, each with MAVLink's name of its type."""

    name: str
    fields: Mapping[str, str]

    def format(self) -> str:
        letters = {"uint8_t": "B", "uint16_t": "H", "uint32_t": "I", "float": "f"}
        return "<" + "".join(letters[type_name] for type_name in self.fields.values())


def _of(type_name: str, *names: str) -> dict[str, str]:
    return dict.fromkeys(names, type_name)


MESSAGES = {
    0: Message(
        "HEARTBEAT",
        {
            **_of("uint32_t", "custom_mode"),
            **_of("uint8_t", "type", "autopilot", "base_mode", "system_status", "mavlink_version"),
        },
    ),
    32: Message("LOCAL_POSITION_NED", {**_of("uint32_t", "time_boot_ms"), **_of("float", "x", "y", "z", "vx", "vy", "vz")}),
    76: Message(
        "COMMAND_LONG",
        {
            **_of("float", *(f"param{i}" for i in range(1, 8))),
            **_of("uint16_t", "command"),
            **_of("uint8_t", "target_system", "target_component", "confirmation"),
        },
    ),
    84: Message(
        "SET_POSITION_TARGET_LOCAL_NED",
        {
            **_of("uint32_t", "time_boot_ms"),
            **_of("float", "x", "y", "z", "vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate"),
            **_of("uint16_t", "type_mask"),
            **_of("uint8_t", "target_system", "target_component", "coordinate_frame"),
        },
    ),
}
IDS = {message.name: number for number, message in MESSAGES.items()}

_START, _HEADER, _CHECKSUM = 0xFD, 10, 2


def checksum(data: bytes, before: int = 0xFFFF) -> int:
    """CRC-16/MCRF4XX, which MAVLink calls X.25."""
    for byte in data:
        before ^= byte
        for _ in range(8):
            before = before >> 1 ^ (0x8408 if before & 1 else 0)
    return before


def crc_extra(message: Message) -> int:
    """What makes programs reject frames whose message has other fields than theirs."""
    text = message.name + " " + "".join(f"{type_name} {name} " for name, type_name in message.fields.items())
    both = checksum(text.encode())
    return both & 0xFF ^ both >> 8


CRC_EXTRAS = {number: crc_extra(message) for number, message in MESSAGES.items()}


def frame(sequence: int, system: int, component: int, name: str, **values: Any) -> bytes:
    """The bytes of a frame. Fields that are not given are 0."""
    number = IDS[name]
    message = MESSAGES[number]
    payload = struct.pack(message.format(), *(values.get(field, 0) for field in message.fields))
    payload = payload.rstrip(b"\0") or b"\0"
    body = struct.pack("<BBBBBB", len(payload), 0, 0, sequence % 256, system, component)
    body += number.to_bytes(3, "little") + payload
    return bytes([_START]) + body + checksum(body + bytes([CRC_EXTRAS[number]])).to_bytes(2, "little")


def frames(datagram: bytes) -> Iterator[tuple[str, dict[str, Any]]]:
    """The known messages in a datagram. All other bytes are skipped."""
    place = 0
    while (place := datagram.find(_START, place)) >= 0 and place + _HEADER + _CHECKSUM < len(datagram):
        end = place + _HEADER + datagram[place + 1]
        number = int.from_bytes(datagram[place + 7 : place + 10], "little")
        message = MESSAGES.get(number)
        is_whole = message is not None and datagram[place + 2] == 0 and end + _CHECKSUM <= len(datagram)
        if message is None or not is_whole:
            place += 1
            continue
        expected = checksum(datagram[place + 1 : end] + bytes([CRC_EXTRAS[number]]))
        if int.from_bytes(datagram[end : end + _CHECKSUM], "little") != expected:
            place += 1
            continue
        size = struct.calcsize(message.format())
        payload = datagram[place + _HEADER : end].ljust(size, b"\0")[:size]
        yield message.name, dict(zip(message.fields, struct.unpack(message.format(), payload)))
        place = end + _CHECKSUM
