#include "session/checked_start.hpp"

#include <utility>

#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {

CheckedStart::CheckedStart(std::unique_ptr<Start> start, std::string who)
    : start_(std::move(start)),
      who_(std::move(who)),
      explains_(detail::comes_with_hypotrack(start_.get())) {}

std::optional<Eigen::VectorXd> CheckedStart::state(const StartContext& context) {
  return detail::call_plugin(who_, explains_, "", [&] { return start_->state(context); });
}

void CheckedStart::find(const StartContext& context, std::size_t model, const TakePose& take) {
  detail::call_plugin(who_, explains_, "", [&] { start_->find(context, model, take); });
}

std::optional<double> CheckedStart::size(const StartContext& context, std::size_t model) {
  return detail::call_plugin(who_, explains_, "", [&] { return start_->size(context, model); });
}

}  // namespace hypotrack::internal
