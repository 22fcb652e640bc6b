# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""A client of `lanthorn link`, which runs the program as a separate process and exchanges messages with it
(docs/protocol.md).

The client needs only the standard library and does not depend on Blender.
"""
import array
import json
import struct
import subprocess
import tempfile

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

PROTOCOL = 1
SIZE_OF_PIPES = 1 << 20
HEADER = struct.Struct("<4sIQ")
MAGIC = b"LNTH"
TYPE_NAMES = {"b": "int8", "B": "uint8", "h": "int16", "H": "uint16", "i": "int32", "I": "uint32", "q": "int64",
              "Q": "uint64", "f": "float32", "d": "float64"}


class LinkError(Exception):
    """Says why the program refuses a request, cannot be started, or has ended."""


class Array:
    """Holds an array of an answer: its `type` ("float32"), `shape`, and `bytes`, a memoryview. The last index runs fastest."""

    def __init__(self, type, shape, data):
        self.type, self.shape, self.bytes = type, tuple(shape), data


class _Packer:
    """Converts a request to JSON, and collects the bytes of its arrays (of numpy or the standard library)."""

    def __init__(self):
        self.parts, self.size = [], 0

    def pack(self, value):
        if isinstance(value, dict):
            return {key: self.pack(item) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [self.pack(item) for item in value]
        if isinstance(value, array.array):
            return self._add(TYPE_NAMES[value.typecode], [len(value)], value.tobytes())
        if hasattr(value, "dtype") and getattr(value, "ndim", 0) > 0:
            return self._add(value.dtype.name, value.shape, _bytes_of(value))
        if hasattr(value, "item"):  # a scalar of numpy
            return value.item()
        return value

    def _add(self, type_name, shape, data):
        offset = self.size
        self.parts.append(data)
        self.size += len(data)
        return {"$array": type_name, "shape": list(shape), "offset": offset}


def _bytes_of(values):
    """Returns the array's values in C order, without a copy if possible."""
    return memoryview(values).cast("B") if values.flags.c_contiguous and values.size else values.tobytes()


def _unpack(value, data):
    if isinstance(value, list):
        return [_unpack(item, data) for item in value]
    if not isinstance(value, dict):
        return value
    if "$array" not in value:
        return {key: _unpack(item, data) for key, item in value.items()}
    count = struct.calcsize({name: code for code, name in TYPE_NAMES.items()}[value["$array"]])
    for extent in value["shape"]:
        count *= extent
    return Array(value["$array"], value["shape"], data[value["offset"]:value["offset"] + count])


def _widen(pipe):
    """Enlarges the pipe's buffer to the limit for ordinary users (Linux only)."""
    try:
        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, SIZE_OF_PIPES)
    except (AttributeError, OSError):
        pass


class Link:
    """Runs the program until `close`. Only one thread may use it at a time."""

    def __init__(self, program="lanthorn", arguments=()):
        self._messages = tempfile.TemporaryFile()
        try:
            self.process = subprocess.Popen([program, "link", *arguments], stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE, stderr=self._messages, bufsize=0)
        except OSError as error:
            self._messages.close()
            raise LinkError(f"the program {program!r} cannot be started: {error.strerror}") from None
        _widen(self.process.stdin)
        _widen(self.process.stdout)
        try:
            self.about = self.request("hello", protocol=PROTOCOL)
        except LinkError:
            self.close()
            raise

    def request(self, name, **members):
        """Sends a request and waits for its answer, a dict. Raises LinkError."""
        packer = _Packer()
        text = json.dumps(packer.pack({"request": name, **members}), allow_nan=False).encode()
        try:
            self._write(HEADER.pack(MAGIC, len(text), packer.size) + text)
            for part in packer.parts:
                self._write(part)
            magic, json_size, data_size = HEADER.unpack(self._read(HEADER.size))
            if magic != MAGIC:
                raise LinkError("the program does not speak lanthorn's protocol")
            body = json.loads(bytes(self._read(json_size)))
            data = self._read(data_size)
        except (EOFError, OSError, ValueError):
            raise LinkError(self._reason_of_end()) from None
        if body["answer"] == "error":
            raise LinkError(body["message"])
        return _unpack(body, data)

    def close(self):
        """Ends the program, even if it is busy."""
        self.process.stdin.close()
        try:
            self.process.wait(timeout=1)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self._messages.close()

    def _write(self, data):
        view = memoryview(data)
        while len(view):
            view = view[self.process.stdin.write(view):]

    def _read(self, count):
        data = bytearray(count)
        view = memoryview(data)
        while len(view):
            got = self.process.stdout.readinto(view)
            if not got:
                raise EOFError
            view = view[got:]
        return memoryview(data)

    def _reason_of_end(self):
        try:
            code = self.process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            return "the program does not answer"
        self._messages.seek(0)
        said = self._messages.read().decode(errors="replace").strip().splitlines()
        why = said[-1] if said else f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        return f"the program has ended: {why}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
