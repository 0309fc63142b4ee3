"""Reads the parts of a TensorFlow Lite file that a network of one graph needs.

The format is FlatBuffers: tables whose fields are found by number. Field numbers and enumerators are
those of TensorFlow's schema.fbs.
"""
import struct
from dataclasses import dataclass
from typing import Optional

import numpy as np

OPERATORS = {
    0: "ADD", 2: "CONCATENATION", 3: "CONV_2D", 4: "DEPTHWISE_CONV_2D", 6: "DEQUANTIZE",
    9: "FULLY_CONNECTED", 14: "LOGISTIC", 17: "MAX_POOL_2D", 22: "RESHAPE", 23: "RESIZE_BILINEAR",
    34: "PAD", 40: "MEAN", 54: "PRELU",
}
TYPES = {0: np.float32, 1: np.float16, 2: np.int32}
SAME, VALID = 0, 1  # padding
NO_ACTIVATION, RELU, RELU6 = 0, 1, 3

# Field number and struct format of the options of operators that have some.
OPTIONS = {
    "ADD": {"activation": (0, "b")},
    "CONCATENATION": {"axis": (0, "i"), "activation": (1, "b")},
    "CONV_2D": {"padding": (0, "b"), "stride_x": (1, "i"), "stride_y": (2, "i"), "activation": (3, "b")},
    "DEPTHWISE_CONV_2D": {"padding": (0, "b"), "stride_x": (1, "i"), "stride_y": (2, "i"),
                          "activation": (4, "b")},
    "FULLY_CONNECTED": {"activation": (0, "b")},
    "MAX_POOL_2D": {"padding": (0, "b"), "stride_x": (1, "i"), "stride_y": (2, "i"), "width": (3, "i"),
                    "height": (4, "i"), "activation": (5, "b")},
    "RESIZE_BILINEAR": {"align_corners": (2, "b"), "half_pixel_centers": (3, "b")},
}


@dataclass
class Tensor:
    """An array of the graph; `data` is None if the graph computes it."""
    name: str
    shape: list
    data: Optional[np.ndarray]


@dataclass
class Operation:
    """One step of the graph; inputs and outputs are indices of tensors."""
    name: str
    inputs: list
    outputs: list
    options: dict


@dataclass
class Graph:
    """A network: steps in the order of computation."""
    tensors: list
    operations: list
    inputs: list
    outputs: list


class Table:
    """A FlatBuffers table at a position in the file's bytes."""

    def __init__(self, data, position):
        self.data = data
        self.position = position
        self.fields = position - self._read("i", position)

    def number(self, field, kind, default=0):
        """Returns a number that is stored in the table itself."""
        offset = self._offset(field)
        return self._read(kind, self.position + offset) if offset else default

    def table(self, field):
        """Returns a table, or None if the field is absent."""
        start = self._target(field)
        return None if start is None else Table(self.data, start)

    def array(self, field, dtype):
        """Returns a vector of numbers, empty if the field is absent."""
        start = self._target(field)
        if start is None:
            return np.zeros(0, dtype)
        return np.frombuffer(self.data, dtype, self._read("I", start), start + 4)

    def text(self, field):
        """Returns a string, empty if the field is absent."""
        return self.array(field, np.uint8).tobytes().decode()

    def tables(self, field):
        """Returns a vector of tables, empty if the field is absent."""
        start = self._target(field)
        if start is None:
            return []
        places = [start + 4 + 4 * i for i in range(self._read("I", start))]
        return [Table(self.data, place + self._read("I", place)) for place in places]

    def _read(self, kind, position):
        return struct.unpack_from("<" + kind, self.data, position)[0]

    def _offset(self, field):
        place = 4 + 2 * field
        return self._read("H", self.fields + place) if place < self._read("H", self.fields) else 0

    def _target(self, field):
        offset = self._offset(field)
        return self.position + offset + self._read("I", self.position + offset) if offset else None


def read(path):
    """Returns the first graph of a TensorFlow Lite file."""
    with open(path, "rb") as stream:
        data = stream.read()
    model = Table(data, struct.unpack_from("<I", data, 0)[0])
    names = [_operator(code) for code in model.tables(1)]
    buffers = model.tables(4)
    graph = model.tables(2)[0]
    return Graph(tensors=[_tensor(table, buffers) for table in graph.tables(0)],
                 operations=[_operation(table, names) for table in graph.tables(3)],
                 inputs=graph.array(1, np.int32).tolist(),
                 outputs=graph.array(2, np.int32).tolist())


def _operator(table):
    """Returns an operator's name; newer files store its code in a second, wider field."""
    code = max(table.number(0, "b"), table.number(3, "i"))
    if code not in OPERATORS:
        raise ValueError(f"operator {code} is not supported")
    return OPERATORS[code]


def _tensor(table, buffers):
    shape = table.array(0, np.int32).tolist()
    data = buffers[table.number(2, "I")].array(0, np.uint8)
    if len(data) == 0:
        return Tensor(table.text(3), shape, None)
    kind = table.number(1, "b")
    if kind not in TYPES:
        raise ValueError(f"tensor {table.text(3)} has the unsupported type {kind}")
    return Tensor(table.text(3), shape, np.frombuffer(data.tobytes(), TYPES[kind]).reshape(shape))


def _operation(table, names):
    name = names[table.number(0, "I")]
    stored = table.table(4)
    options = {key: stored.number(*field) if stored else 0
               for key, field in OPTIONS.get(name, {}).items()}
    return Operation(name, table.array(1, np.int32).tolist(), table.array(2, np.int32).tolist(), options)
