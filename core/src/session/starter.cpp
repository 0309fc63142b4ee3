#include "hypotrack/plugin/starter.hpp"

#include "plugin/plugin_call.hpp"

namespace hypotrack {

GlobalSearch::~GlobalSearch() = default;
Starter::~Starter() = default;

std::optional<Eigen::VectorXd> Starter::state(const StarterContext& context) {
  return detail::call_explained(*this, "", [&] { return do_state(context); });
}

void Starter::find(const StarterContext& context, std::size_t model, const TakePose& take) {
  detail::call_explained(*this, "", [&] { do_find(context, model, take); });
}

std::optional<double> Starter::size(const StarterContext& context, std::size_t model) {
  return detail::call_explained(*this, "", [&] { return do_size(context, model); });
}

bool Starter::do_detects(std::size_t /*model*/) const { return false; }

std::optional<Eigen::VectorXd> Starter::do_state(const StarterContext& /*context*/) {
  return std::nullopt;
}

void Starter::do_find(const StarterContext& /*context*/, std::size_t /*model*/,
                      const TakePose& /*take*/) {}

std::optional<double> Starter::do_size(const StarterContext& /*context*/, std::size_t /*model*/) {
  return std::nullopt;
}

}  // namespace hypotrack
