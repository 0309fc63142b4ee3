#pragma once

#include <oneapi/dnnl/dnnl.hpp>

/// What oneDNN 2 and 3 write differently.
namespace hypotrack::hands::onednn {

/// Describes a primitive by the arguments that both versions have in the same order.
template <class Primitive, class... Arguments>
typename Primitive::primitive_desc describe(const dnnl::engine& engine,
                                            const dnnl::primitive_attr& attributes,
                                            const Arguments&... arguments) {
#if DNNL_VERSION_MAJOR >= 3
  return {engine, arguments..., attributes};
#else
  return {typename Primitive::desc(arguments...), attributes, engine};
#endif
}

inline dnnl::pooling_forward::primitive_desc describe_pooling(
    const dnnl::engine& engine, const dnnl::primitive_attr& attributes, dnnl::algorithm algorithm,
    const dnnl::memory::desc& from, const dnnl::memory::desc& to,
    const dnnl::memory::dims& window) {
  constexpr auto kKind = dnnl::prop_kind::forward_inference;
  const dnnl::memory::dims none{0, 0};
#if DNNL_VERSION_MAJOR >= 3
  return {engine, kKind, algorithm, from, to, window, window, none, none, none, attributes};
#else
  return {{kKind, algorithm, from, to, window, window, none, none}, attributes, engine};
#endif
}

inline dnnl::prelu_forward::primitive_desc describe_prelu(const dnnl::engine& engine,
                                                          const dnnl::primitive_attr& attributes,
                                                          const dnnl::memory::desc& data,
                                                          const dnnl::memory::desc& slopes) {
  constexpr auto kKind = dnnl::prop_kind::forward_inference;
#if DNNL_VERSION_MAJOR >= 3
  return {engine, kKind, data, slopes, data, attributes};
#else
  return {{kKind, data, slopes}, attributes, engine};
#endif
}

inline dnnl::eltwise_forward::primitive_desc describe_sigmoid(
    const dnnl::engine& engine, const dnnl::primitive_attr& attributes,
    const dnnl::memory::desc& data) {
  constexpr auto kKind = dnnl::prop_kind::forward_inference;
  constexpr auto kSigmoid = dnnl::algorithm::eltwise_logistic;
#if DNNL_VERSION_MAJOR >= 3
  return {engine, kKind, kSigmoid, data, data, 0.0f, 0.0f, attributes};
#else
  return {{kKind, kSigmoid, data, 0.0f, 0.0f}, attributes, engine};
#endif
}

/// Appends that values are limited to [low, high].
inline void append_limits(dnnl::post_ops& after, float low, float high) {
#if DNNL_VERSION_MAJOR >= 3
  after.append_eltwise(dnnl::algorithm::eltwise_clip, low, high);
#else
  after.append_eltwise(1, dnnl::algorithm::eltwise_clip, low, high);
#endif
}

}  // namespace hypotrack::hands::onednn
