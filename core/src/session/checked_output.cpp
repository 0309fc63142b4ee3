#include "session/checked_output.hpp"

#include <fmt/format.h>

#include <utility>

#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {

CheckedOutput::CheckedOutput(std::unique_ptr<Output> output, std::string who)
    : output_(std::move(output)),
      who_(std::move(who)),
      explains_(detail::comes_with_hypotrack(output_.get())) {}

template <class Function>
decltype(auto) CheckedOutput::call(const Frame& frame, Function&& function) const {
  const detail::ThreadFrame of_thread(frame.index);
  return detail::call_plugin(who_, explains_, fmt::format("frame {}", frame.index),
                             std::forward<Function>(function));
}

template <class Function>
decltype(auto) CheckedOutput::call(Function&& function) const {
  return detail::call_plugin(who_, explains_, "", std::forward<Function>(function));
}

std::vector<std::string> CheckedOutput::file_names() const {
  return call([&] { return output_->file_names(); });
}

void CheckedOutput::begin(OutputContext& run) {
  call([&] { output_->begin(run); });
}

bool CheckedOutput::wants_search(const Frame& frame) const {
  return call(frame, [&] { return output_->wants_search(frame); });
}

void CheckedOutput::search(const Frame& frame, const Solution& solution,
                           const SearchRecord& record) {
  call(frame, [&] { output_->search(frame, solution, record); });
}

void CheckedOutput::online(const Frame& frame, const Solution& solution) {
  call(frame, [&] { output_->online(frame, solution); });
}

void CheckedOutput::frame(const Frame& frame, const Solution& solution) {
  call(frame, [&] { output_->frame(frame, solution); });
}

std::vector<std::string> CheckedOutput::columns() const {
  return call([&] { return output_->columns(); });
}

void CheckedOutput::values(const Frame& frame, const Solution& solution, std::span<double> values) {
  call(frame, [&] { output_->values(frame, solution, values); });
}

void CheckedOutput::finish(bool complete) {
  call([&] { output_->finish(complete); });
}

}  // namespace hypotrack::internal
