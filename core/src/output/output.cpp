#include "hypotrack/plugin/output.hpp"

#include <fmt/format.h>

#include <utility>

#include "plugin/plugin_call.hpp"

namespace hypotrack {
namespace {

/// Calls a function of an output with a frame, which may be another than the one that is tracked.
template <class Function>
decltype(auto) call_with(const Output& output, const Frame& frame, Function&& function) {
  const detail::ThreadFrame of_thread(frame.index);
  return detail::call_explained(output, fmt::format("frame {}", frame.index),
                                std::forward<Function>(function));
}

}  // namespace

OutputContext::~OutputContext() = default;
Output::~Output() = default;

std::vector<std::string> Output::file_names() const {
  return detail::call_explained(*this, "", [&] { return do_file_names(); });
}

void Output::begin(OutputContext& run) {
  detail::call_explained(*this, "", [&] { do_begin(run); });
}

bool Output::wants_search(const Frame& frame) const {
  return call_with(*this, frame, [&] { return do_wants_search(frame); });
}

void Output::search(const Frame& frame, const Solution& solution, const SearchRecord& record) {
  call_with(*this, frame, [&] { do_search(frame, solution, record); });
}

void Output::online(const Frame& frame, const Solution& solution) {
  call_with(*this, frame, [&] { do_online(frame, solution); });
}

void Output::frame(const Frame& frame, const Solution& solution) {
  call_with(*this, frame, [&] { do_frame(frame, solution); });
}

std::vector<std::string> Output::columns() const {
  return detail::call_explained(*this, "", [&] { return do_columns(); });
}

void Output::values(const Frame& frame, const Solution& solution, std::span<double> values) {
  call_with(*this, frame, [&] { do_values(frame, solution, values); });
}

void Output::finish(bool complete) {
  detail::call_explained(*this, "", [&] { do_finish(complete); });
}

}  // namespace hypotrack
