#include "session/checked_output.hpp"

#include <utility>

#include "plugin/plugin_call.hpp"

namespace hypotrack {

using detail::call_explaining_plugin;

CheckedOutput::CheckedOutput(std::unique_ptr<Output> output, std::string who)
    : output_(std::move(output)), who_(std::move(who)) {}

std::vector<std::string> CheckedOutput::file_names() const {
  return call_explaining_plugin(who_, [&] { return output_->file_names(); });
}

void CheckedOutput::begin(OutputContext& run) {
  call_explaining_plugin(who_, [&] { output_->begin(run); });
}

bool CheckedOutput::wants_search(const Frame& frame) const {
  return call_explaining_plugin(who_, [&] { return output_->wants_search(frame); });
}

void CheckedOutput::search(const Frame& frame, const Solution& solution,
                           const SearchRecord& record) {
  const detail::ThreadFrame of_thread(frame.index);
  call_explaining_plugin(who_, [&] { output_->search(frame, solution, record); });
}

void CheckedOutput::online(const Frame& frame, const Solution& solution) {
  const detail::ThreadFrame of_thread(frame.index);
  call_explaining_plugin(who_, [&] { output_->online(frame, solution); });
}

void CheckedOutput::frame(const Frame& frame, const Solution& solution) {
  const detail::ThreadFrame of_thread(frame.index);
  call_explaining_plugin(who_, [&] { output_->frame(frame, solution); });
}

std::vector<std::string> CheckedOutput::columns() const {
  return call_explaining_plugin(who_, [&] { return output_->columns(); });
}

void CheckedOutput::values(const Frame& frame, const Solution& solution, std::span<double> values) {
  const detail::ThreadFrame of_thread(frame.index);
  call_explaining_plugin(who_, [&] { output_->values(frame, solution, values); });
}

void CheckedOutput::finish(bool complete) {
  call_explaining_plugin(who_, [&] { output_->finish(complete); });
}

}  // namespace hypotrack
