#!/usr/bin/env python3
"""Converts MediaPipe's palm detectors and hand landmark networks from TensorFlow Lite to ONNX.

    convert.py IN.tflite OUT.onnx

Writes what OpenCV 4.5 and later read; equal input gives equal bytes. Pictures, `input`, are RGB from 0 to
1, channel by channel. Needs python3-onnx and python3-numpy.
"""
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

import tflite

# The networks' outputs in their order, by the number of outputs.
OUTPUT_NAMES = {2: ["boxes", "scores"], 4: ["landmarks", "presence", "right", "relative"]}


def same_padding(size, kernel, stride):
    """Returns TensorFlow's SAME padding before and after; the odd pixel goes after."""
    total = max((-(-size // stride) - 1) * stride + kernel - size, 0)
    return total // 2, total - total // 2


class Converter:
    """Rebuilds a graph step by step; tensors of four dimensions change from NHWC to NCHW."""

    def __init__(self, graph):
        self.graph = graph
        self.nodes = []
        self.constants = []
        self.data = {i: t.data for i, t in enumerate(graph.tensors) if t.data is not None}
        self.names = {graph.inputs[0]: "input"}  # of computed tensors
        # OpenCV 4.6 reads the limits of Clip as attributes, until 10, and half_pixel, since 11.
        resizes = any(operation.name == "RESIZE_BILINEAR" for operation in graph.operations)
        self.opset = 11 if resizes else 10

    def convert(self):
        """Returns the ONNX model."""
        for operation in self.graph.operations:
            getattr(self, "_" + operation.name.lower())(operation)
        outputs = []
        for tensor, name in zip(self.graph.outputs, OUTPUT_NAMES[len(self.graph.outputs)]):
            self.nodes.append(helper.make_node("Identity", [self.names[tensor]], [name], name=name))
            outputs.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, self._shape(tensor)))
        _, height, width, channels = self._shape(self.graph.inputs[0])
        picture = helper.make_tensor_value_info("input", TensorProto.FLOAT, [1, channels, height, width])
        graph = helper.make_graph(self.nodes, "hand_detector", [picture], outputs, self.constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", self.opset)])
        model.ir_version = 6
        onnx.checker.check_model(model)
        return model

    def _shape(self, tensor):
        return self.graph.tensors[tensor].shape

    def _constant(self, values, dtype=np.float32):
        name = f"constant_{len(self.constants)}"
        array = np.ascontiguousarray(values, dtype)
        self.constants.append(numpy_helper.from_array(array, name))
        return name

    def _node(self, kind, inputs, **attributes):
        name = f"{kind.lower()}_{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, inputs, [name], name=name, **attributes))
        return name

    def _activated(self, value, activation):
        if activation == tflite.NO_ACTIVATION:
            return value
        if activation == tflite.RELU:
            return self._node("Relu", [value])
        if activation == tflite.RELU6 and self.opset < 11:
            return self._node("Clip", [value], min=0.0, max=6.0)
        raise ValueError(f"activation {activation} is not supported")

    def _padded(self, value, before, after):
        """Pads with zeros, by the four numbers of NCHW."""
        pads = [*before, *after]
        if self.opset < 11:
            return self._node("Pad", [value], mode="constant", pads=pads, value=0.0)
        return self._node("Pad", [value, self._constant(pads, np.int64), self._constant(0)],
                          mode="constant")

    def _convolution(self, operation, weights, groups):
        source = operation.inputs[0]
        value = self.names[source]
        options = operation.options
        strides = [options["stride_y"], options["stride_x"]]
        kernel = list(weights.shape[2:])
        pads = [0, 0, 0, 0]
        if options["padding"] == tflite.SAME:
            _, height, width, _ = self._shape(source)
            top, bottom = same_padding(height, kernel[0], strides[0])
            left, right = same_padding(width, kernel[1], strides[1])
            if top == bottom and left == right:
                pads = [top, left, bottom, right]
            else:  # OpenCV takes no uneven padding of a convolution
                value = self._padded(value, [0, 0, top, left], [0, 0, bottom, right])
        size = self._shape(operation.outputs[0])[1:3]
        filled = groups == 1 and kernel == [1, 1] and (size[0] * size[1]) % 4
        if filled:
            # OpenCV shares the pixels of a layer out to threads and rounds those that do not fill a
            # vector differently: a wider layer has none, and equal pictures give equal results.
            value = self._padded(value, [0, 0, 0, 0], [0, 0, 0, -size[1] % 8])
        inputs = [value, self._constant(weights), self._constant(self.data[operation.inputs[2]])]
        value = self._node("Conv", inputs, kernel_shape=kernel, strides=strides, pads=pads, group=groups,
                           dilations=[1, 1])
        if filled:
            ends = [self._constant([n], np.int64) for n in (0, size[1], 3)]
            value = self._node("Slice", [value, *ends])
        self.names[operation.outputs[0]] = self._activated(value, options["activation"])

    def _conv_2d(self, operation):
        self._convolution(operation, self.data[operation.inputs[1]].transpose(0, 3, 1, 2), 1)

    def _depthwise_conv_2d(self, operation):
        channels = self._shape(operation.inputs[0])[3]
        self._convolution(operation, self.data[operation.inputs[1]].transpose(3, 0, 1, 2), channels)

    def _dequantize(self, operation):
        self.data[operation.outputs[0]] = self.data[operation.inputs[0]].astype(np.float32)

    def _add(self, operation):
        value = self._node("Add", [self.names[i] for i in operation.inputs])
        self.names[operation.outputs[0]] = self._activated(value, operation.options["activation"])

    def _prelu(self, operation):
        slopes = self.data[operation.inputs[1]].reshape(-1, 1, 1)
        inputs = [self.names[operation.inputs[0]], self._constant(slopes)]
        self.names[operation.outputs[0]] = self._node("PRelu", inputs)

    def _max_pool_2d(self, operation):
        options = operation.options
        kernel = [options["height"], options["width"]]
        strides = [options["stride_y"], options["stride_x"]]
        _, height, width, _ = self._shape(operation.inputs[0])
        if height % strides[0] or width % strides[1] or kernel != strides:
            raise ValueError("pooling with padding is not supported")
        self.names[operation.outputs[0]] = self._node(
            "MaxPool", [self.names[operation.inputs[0]]], kernel_shape=kernel, strides=strides,
            pads=[0, 0, 0, 0])

    def _pad(self, operation):
        pads = self.data[operation.inputs[1]].reshape(-1, 2)[[0, 3, 1, 2]]
        self.names[operation.outputs[0]] = self._padded(
            self.names[operation.inputs[0]], pads[:, 0].tolist(), pads[:, 1].tolist())

    def _resize_bilinear(self, operation):
        if not operation.options["half_pixel_centers"]:
            raise ValueError("resizing is supported with half_pixel_centers only")
        _, height, width, _ = self._shape(operation.inputs[0])
        _, new_height, new_width, _ = self._shape(operation.outputs[0])
        scales = self._constant([1, 1, new_height / height, new_width / width])
        self.names[operation.outputs[0]] = self._node(
            "Resize", [self.names[operation.inputs[0]], self._constant([]), scales], mode="linear",
            coordinate_transformation_mode="half_pixel")

    def _mean(self, operation):
        """Averages over the whole picture, which is what the networks use it for."""
        if sorted(self.data[operation.inputs[1]].ravel().tolist()) != [1, 2]:
            raise ValueError("only means over height and width are supported")
        pooled = self._node("GlobalAveragePool", [self.names[operation.inputs[0]]])
        self.names[operation.outputs[0]] = self._node("Flatten", [pooled], axis=1)

    def _fully_connected(self, operation):
        value, weights, bias = operation.inputs
        inputs = [self.names[value], self._constant(self.data[weights]), self._constant(self.data[bias])]
        value = self._node("Gemm", inputs, transB=1)
        self.names[operation.outputs[0]] = self._activated(value, operation.options["activation"])

    def _logistic(self, operation):
        self.names[operation.outputs[0]] = self._node("Sigmoid", [self.names[operation.inputs[0]]])

    def _reshape(self, operation):
        value = self.names[operation.inputs[0]]
        if len(self._shape(operation.inputs[0])) == 4:
            value = self._node("Transpose", [value], perm=[0, 2, 3, 1])
        shape = self._constant(self._shape(operation.outputs[0]), np.int64)
        self.names[operation.outputs[0]] = self._node("Reshape", [value, shape])

    def _concatenation(self, operation):
        if len(self._shape(operation.outputs[0])) == 4:
            raise ValueError("only lists are concatenated")
        self.names[operation.outputs[0]] = self._node(
            "Concat", [self.names[i] for i in operation.inputs], axis=operation.options["axis"])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    model = Converter(tflite.read(sys.argv[1])).convert()
    with open(sys.argv[2], "wb") as stream:
        stream.write(model.SerializeToString(deterministic=True))


if __name__ == "__main__":
    main()
