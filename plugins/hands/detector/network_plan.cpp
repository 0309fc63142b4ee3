#include "network_plan.hpp"

#include <algorithm>
#include <limits>

#include "dnnl_primitives.hpp"

namespace hypotrack::hands {
namespace {

using Desc = dnnl::memory::desc;
using Dims = dnnl::memory::dims;
using Tag = dnnl::memory::format_tag;
using Arguments = std::vector<std::pair<int, std::size_t>>;
constexpr auto kFloat = dnnl::memory::data_type::f32;
constexpr auto kInference = dnnl::prop_kind::forward_inference;
constexpr int kAlways = std::numeric_limits<int>::max();

Dims dims_of(const TensorShape& s) { return {1, s.channels, s.height, s.width}; }

/// Returns a description of float numbers without gaps.
Desc plain(const Dims& dims, Tag tag) { return {dims, kFloat, tag}; }

/// Returns the bytes of a buffer that lies in a context's memory.
std::size_t bytes_of(const PlanBuffer& buffer) {
  constexpr std::size_t kAlignment = 64;
  return (buffer.desc.get_size() + kAlignment - 1) / kAlignment * kAlignment;
}

/// Returns the attributes of a primitive that several threads can run at the same time.
dnnl::primitive_attr without_own_memory() {
  dnnl::primitive_attr out;
  out.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  return out;
}

/// Makes the operations of a graph, step by step.
class Planner {
 public:
  explicit Planner(const NetworkGraph& graph) : graph_(graph), buffers_(graph.tensors.size()) {
    buffers_[0] = add_buffer(desc_of(0));
    for (std::size_t i = 0; i < graph.steps.size(); ++i)
      add_step(graph.steps[i], static_cast<int>(i) + 1);
    find_last_uses();
    place_buffers();
  }

  NetworkPlan plan;

 private:
  const TensorShape& shape(int tensor) const {
    return graph_.tensors[static_cast<std::size_t>(tensor)];
  }
  Desc desc_of(int tensor) const { return plain(dims_of(shape(tensor)), Tag::nhwc); }
  std::size_t& buffer_of(int tensor) { return buffers_[static_cast<std::size_t>(tensor)]; }

  /// Adds a buffer that the next operation is the first to use.
  std::size_t add_buffer(const Desc& desc) {
    const int now = static_cast<int>(plan.operations.size());
    plan.buffers.push_back({.desc = desc, .first = now, .last = now});
    return plan.buffers.size() - 1;
  }

  /// Adds weights, which `given` describes, in the order that a primitive wants.
  std::size_t add_constant(const Desc& given, std::size_t at, const Desc& wanted) {
    // oneDNN has no memory for reading only.
    dnnl::memory from(given, plan.engine, const_cast<float*>(graph_.weights.data() + at));
    dnnl::memory to(wanted, plan.engine);
    dnnl::stream stream(plan.engine);
    dnnl::reorder(from, to).execute(stream, from, to);
    stream.wait();
    plan.buffers.push_back({.desc = wanted, .constant = to});
    return plan.buffers.size() - 1;
  }

  /// Adds the operation that makes the tensor `out`.
  template <class Primitive>
  void add_operation(const typename Primitive::primitive_desc& description, Arguments arguments,
                     int out) {
    buffer_of(out) = add_buffer(desc_of(out));
    arguments.emplace_back(DNNL_ARG_DST, buffer_of(out));
    if (const Desc scratchpad = description.scratchpad_desc(); scratchpad.get_size() > 0)
      arguments.emplace_back(DNNL_ARG_SCRATCHPAD, add_buffer(scratchpad));
    plan.operations.push_back({Primitive(description), std::move(arguments)});
  }

  void add_step(const NetworkStep& step, int out) {
    switch (step.layer) {
      case Layer::conv:
      case Layer::depthwise:
        return add_convolution(step, out);
      case Layer::prelu:
        return add_prelu(step, out);
      case Layer::add:
        return add_sum(step, out);
      case Layer::max_pool:
        return add_pooling(step, out, dnnl::algorithm::pooling_max,
                           {step.kernel_height, step.kernel_width});
      case Layer::mean:
        return add_pooling(step, out, dnnl::algorithm::pooling_avg_exclude_padding,
                           {shape(step.input).height, shape(step.input).width});
      case Layer::widen:
        return add_widening(step, out);
      case Layer::resize:
        return add_resizing(step, out);
      case Layer::sigmoid:
        return add_sigmoid(step, out);
    }
  }

  void add_convolution(const NetworkStep& step, int out) {
    const bool depthwise = step.layer == Layer::depthwise;
    const int in_channels = shape(step.input).channels, out_channels = shape(out).channels;
    const int rows = step.kernel_height, columns = step.kernel_width;
    const Dims kernel = depthwise ? Dims{in_channels, 1, 1, rows, columns}
                                  : Dims{out_channels, in_channels, rows, columns};
    const Desc given =
        depthwise ? Desc(kernel, kFloat,
                         Dims{1, in_channels, in_channels, columns * in_channels, in_channels})
                  : plain(kernel, Tag::ohwi);
    const Desc bias = plain({out_channels}, Tag::x);
    const auto description = onednn::describe<dnnl::convolution_forward>(
        plan.engine, limited_to(step.activation), kInference, dnnl::algorithm::convolution_direct,
        desc_of(step.input), plain(kernel, Tag::any), bias, desc_of(out),
        Dims{step.stride_y, step.stride_x}, Dims{step.top, step.left},
        Dims{step.bottom, step.right});
    add_operation<dnnl::convolution_forward>(
        description,
        {{DNNL_ARG_SRC, buffer_of(step.input)},
         {DNNL_ARG_WEIGHTS, add_constant(given, step.weights, description.weights_desc())},
         {DNNL_ARG_BIAS, add_constant(bias, step.bias, bias)}},
        out);
  }

  static dnnl::primitive_attr limited_to(Activation activation) {
    dnnl::primitive_attr out = without_own_memory();
    if (activation == Activation::none) return out;
    dnnl::post_ops after;
    onednn::append_limits(
        after, 0, activation == Activation::relu6 ? 6 : std::numeric_limits<float>::infinity());
    out.set_post_ops(after);
    return out;
  }

  void add_prelu(const NetworkStep& step, int out) {
    const Desc slopes = plain({1, shape(out).channels, 1, 1}, Tag::nhwc);
    add_operation<dnnl::prelu_forward>(
        onednn::describe_prelu(plan.engine, attributes_, desc_of(out), slopes),
        {{DNNL_ARG_SRC, buffer_of(step.input)},
         {DNNL_ARG_WEIGHTS, add_constant(slopes, step.weights, slopes)}},
        out);
  }

  void add_sum(const NetworkStep& step, int out) {
    const Desc desc = desc_of(out);
    add_operation<dnnl::binary>(
        onednn::describe<dnnl::binary>(plan.engine, attributes_, dnnl::algorithm::binary_add, desc,
                                       desc, desc),
        {{DNNL_ARG_SRC_0, buffer_of(step.input)}, {DNNL_ARG_SRC_1, buffer_of(step.second)}}, out);
  }

  void add_pooling(const NetworkStep& step, int out, dnnl::algorithm algorithm,
                   const Dims& window) {
    add_operation<dnnl::pooling_forward>(
        onednn::describe_pooling(plan.engine, attributes_, algorithm, desc_of(step.input),
                                 desc_of(out), window),
        {{DNNL_ARG_SRC, buffer_of(step.input)}}, out);
  }

  /// Copies a tensor into the first channels of a buffer. Its other channels are zero from the
  /// start, and no other buffer shares its memory.
  void add_widening(const NetworkStep& step, int out) {
    const Desc part = desc_of(out).submemory_desc(dims_of(shape(step.input)), {0, 0, 0, 0});
    add_operation<dnnl::reorder>({plan.engine, desc_of(step.input), plan.engine, part, attributes_},
                                 {{DNNL_ARG_SRC, buffer_of(step.input)}}, out);
    plan.buffers[buffer_of(out)].first = 0;
    plan.buffers[buffer_of(out)].last = kAlways;
  }

  void add_resizing(const NetworkStep& step, int out) {
    add_operation<dnnl::resampling_forward>(
        onednn::describe<dnnl::resampling_forward>(plan.engine, attributes_, kInference,
                                                   dnnl::algorithm::resampling_linear,
                                                   desc_of(step.input), desc_of(out)),
        {{DNNL_ARG_SRC, buffer_of(step.input)}}, out);
  }

  void add_sigmoid(const NetworkStep& step, int out) {
    add_operation<dnnl::eltwise_forward>(
        onednn::describe_sigmoid(plan.engine, attributes_, desc_of(out)),
        {{DNNL_ARG_SRC, buffer_of(step.input)}}, out);
  }

  void find_last_uses() {
    for (std::size_t i = 0; i < plan.operations.size(); ++i) {
      for (const auto& [kind, buffer] : plan.operations[i].arguments)
        plan.buffers[buffer].last = std::max(plan.buffers[buffer].last, static_cast<int>(i));
    }
    for (const NetworkOutput& output : graph_.outputs) {
      std::vector<std::size_t>& buffers = plan.outputs.emplace_back();
      for (const int tensor : output.tensors) {
        buffers.push_back(buffer_of(tensor));
        plan.buffers[buffers.back()].last = kAlways;
      }
    }
  }

  /// Places each buffer at the lowest offset that is free while it is in use.
  void place_buffers() {
    std::vector<const PlanBuffer*> placed;  // by offset
    for (PlanBuffer& buffer : plan.buffers) {
      if (buffer.constant) continue;
      for (const PlanBuffer* other : placed) {
        if (other->last < buffer.first || buffer.last < other->first) continue;
        if (buffer.offset + bytes_of(buffer) <= other->offset) break;
        buffer.offset = std::max(buffer.offset, other->offset + bytes_of(*other));
      }
      placed.insert(std::ranges::upper_bound(placed, buffer.offset, {}, &PlanBuffer::offset),
                    &buffer);
      plan.size = std::max(plan.size, buffer.offset + bytes_of(buffer));
    }
  }

  const NetworkGraph& graph_;
  const dnnl::primitive_attr attributes_ = without_own_memory();
  std::vector<std::size_t> buffers_;  // by tensor
};

}  // namespace

NetworkPlan plan_network(const NetworkGraph& graph, int threads) {
  const OmpThreads own_threads(threads);
  return std::move(Planner(graph).plan);
}

}  // namespace hypotrack::hands
