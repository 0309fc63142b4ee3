"""Converts MediaPipe's palm detectors and hand landmark networks from TensorFlow Lite to flat files.

    python3 convert.py IN.tflite OUT.net

A flat file is a line of text per step, then all weights, 32-bit floats, in the order of the steps. Tensor 0
is the picture, RGB from 0 to 1; each step makes the next tensor. Tensors are [y, x, channel], weights of
convolutions [out, y, x, in], of depthwise ones [y, x, channel]; then comes the bias. Equal input gives equal
bytes. plugins/hands/detector/network_file.cpp reads them. Needs python3-numpy.
"""
import sys

import numpy as np

import tflite

# The networks' outputs in their order, by the number of outputs.
OUTPUT_NAMES = {2: ["boxes", "scores"], 4: ["landmarks", "presence", "right", "relative"]}
ACTIVATIONS = {tflite.NO_ACTIVATION: "none", tflite.RELU: "relu", tflite.RELU6: "relu6"}


def same_padding(size, kernel, stride):
    """Returns TensorFlow's SAME padding before and after; the odd pixel goes after."""
    total = max((-(-size // stride) - 1) * stride + kernel - size, 0)
    return total // 2, total - total // 2


class Converter:
    """Rebuilds a graph step by step. Lists count as pictures of one pixel."""

    def __init__(self, graph):
        self.graph = graph
        self.lines = []
        self.weights = []
        self.data = {i: t.data for i, t in enumerate(graph.tensors) if t.data is not None}
        self.numbers = {graph.inputs[0]: 0}  # of computed tensors
        self.parts = {}  # of concatenated lists

    def convert(self):
        """Returns the flat file's bytes."""
        for operation in self.graph.operations:
            getattr(self, "_" + operation.name.lower())(operation)
        _, height, width, channels = self._shape(self.graph.inputs[0])
        if height != width or channels != 3:
            raise ValueError("the picture is not square or has no three channels")
        head = ["hypotrack network 1", f"picture {height}", *self.lines]
        for tensor, name in zip(self.graph.outputs, OUTPUT_NAMES[len(self.graph.outputs)]):
            numbers = [self.numbers[part] for part in self.parts.get(tensor, [tensor])]
            head.append(f"output {name} {' '.join(map(str, numbers))}")
        weights = np.concatenate(self.weights)
        head.append(f"weights {len(weights)}\n")
        return "\n".join(head).encode() + weights.astype("<f4").tobytes()

    def _shape(self, tensor):
        return self.graph.tensors[tensor].shape

    def _step(self, operation, *words):
        """Adds a step whose output is the next tensor."""
        self.lines.append(" ".join(map(str, words)))
        self.numbers[operation.outputs[0]] = len(self.lines)

    def _add_weights(self, values):
        self.weights.append(np.ascontiguousarray(values, np.float32).ravel())

    def _convolution(self, operation, kind):
        source, weights, bias = operation.inputs
        weights = self.data[weights]
        options = operation.options
        kernel = weights.shape[1:3]
        strides = [options["stride_y"], options["stride_x"]]
        pads = [0, 0, 0, 0]
        if options["padding"] == tflite.SAME:
            _, height, width, _ = self._shape(source)
            pads = [*same_padding(height, kernel[0], strides[0]), *same_padding(width, kernel[1], strides[1])]
        channels = [weights.shape[0]] if kind == "conv" else []
        self._step(operation, kind, self.numbers[source], *channels, *kernel, *strides, *pads,
                   ACTIVATIONS[options["activation"]])
        self._add_weights(weights)
        self._add_weights(self.data[bias])

    def _conv_2d(self, operation):
        self._convolution(operation, "conv")

    def _depthwise_conv_2d(self, operation):
        self._convolution(operation, "depthwise")

    def _dequantize(self, operation):
        self.data[operation.outputs[0]] = self.data[operation.inputs[0]].astype(np.float32)

    def _add(self, operation):
        if operation.options["activation"] != tflite.NO_ACTIVATION:
            raise ValueError("sums with an activation are not supported")
        self._step(operation, "add", *(self.numbers[i] for i in operation.inputs))

    def _prelu(self, operation):
        value, slopes = operation.inputs
        self._step(operation, "prelu", self.numbers[value])
        self._add_weights(self.data[slopes])

    def _max_pool_2d(self, operation):
        options = operation.options
        kernel = [options["height"], options["width"]]
        strides = [options["stride_y"], options["stride_x"]]
        _, height, width, _ = self._shape(operation.inputs[0])
        if height % strides[0] or width % strides[1] or kernel != strides:
            raise ValueError("pooling with padding is not supported")
        self._step(operation, "max_pool", self.numbers[operation.inputs[0]], *kernel)

    def _pad(self, operation):
        """Appends channels of zeros, which is what the networks pad."""
        pads = self.data[operation.inputs[1]].reshape(-1, 2)
        if pads[:3].any() or pads[3, 0]:
            raise ValueError("padding is supported after the channels only")
        self._step(operation, "widen", self.numbers[operation.inputs[0]],
                   self._shape(operation.outputs[0])[3])

    def _resize_bilinear(self, operation):
        if not operation.options["half_pixel_centers"]:
            raise ValueError("resizing is supported with half_pixel_centers only")
        _, height, width, _ = self._shape(operation.outputs[0])
        self._step(operation, "resize", self.numbers[operation.inputs[0]], height, width)

    def _mean(self, operation):
        """Averages over the whole picture, which is what the networks use it for."""
        if sorted(self.data[operation.inputs[1]].ravel().tolist()) != [1, 2]:
            raise ValueError("only means over height and width are supported")
        self._step(operation, "mean", self.numbers[operation.inputs[0]])

    def _fully_connected(self, operation):
        value, weights, bias = operation.inputs
        weights = self.data[weights]
        if self._shape(value) != [1, weights.shape[1]]:
            raise ValueError("only lists are fully connected")
        self._step(operation, "conv", self.numbers[value], weights.shape[0], 1, 1, 1, 1, 0, 0, 0, 0,
                   ACTIVATIONS[operation.options["activation"]])
        self._add_weights(weights)
        self._add_weights(self.data[bias])

    def _logistic(self, operation):
        self._step(operation, "sigmoid", self.numbers[operation.inputs[0]])

    def _reshape(self, operation):
        self.numbers[operation.outputs[0]] = self.numbers[operation.inputs[0]]

    def _concatenation(self, operation):
        if operation.options["axis"] != 1 or len(self._shape(operation.outputs[0])) == 4:
            raise ValueError("only lists are concatenated")
        self.parts[operation.outputs[0]] = operation.inputs


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    converted = Converter(tflite.read(sys.argv[1])).convert()
    with open(sys.argv[2], "wb") as stream:
        stream.write(converted)


if __name__ == "__main__":
    main()
