#include "hypotrack/plugin/start.hpp"

#include "plugin/plugin_call.hpp"

namespace hypotrack {

GlobalSearch::~GlobalSearch() = default;
Start::~Start() = default;

std::optional<Eigen::VectorXd> Start::state(const StartContext& context) {
  return detail::call_explained(*this, "", [&] { return do_state(context); });
}

void Start::find(const StartContext& context, std::size_t model, const TakePose& take) {
  detail::call_explained(*this, "", [&] { do_find(context, model, take); });
}

std::optional<double> Start::size(const StartContext& context, std::size_t model) {
  return detail::call_explained(*this, "", [&] { return do_size(context, model); });
}

bool Start::do_recognizes(std::size_t /*model*/) const { return false; }

std::optional<Eigen::VectorXd> Start::do_state(const StartContext& /*context*/) {
  return std::nullopt;
}

void Start::do_find(const StartContext& /*context*/, std::size_t /*model*/,
                    const TakePose& /*take*/) {}

std::optional<double> Start::do_size(const StartContext& /*context*/, std::size_t /*model*/) {
  return std::nullopt;
}

}  // namespace hypotrack
