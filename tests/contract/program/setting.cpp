#include "setting.hpp"

#include "hypotrack/api/error.hpp"
#include "report.hpp"

namespace hypotrack::contract {

RenderedHypothesis Setting::drawn(std::size_t i) const {
  const NamedHypothesis& hypothesis = hypotheses[i];
  RenderedHypothesis rendered;
  rendered.state = {hypothesis.state.data(), static_cast<std::size_t>(hypothesis.state.size())};
  if (objective->needs_rendering()) rendered.views = hypothesis.depth.tiles();
  return rendered;
}

double Setting::cost_by(const Objective& other, std::size_t i) const {
  try {
    return other.cost(drawn(i));
  } catch (const PluginError& error) {
    throw Violation(at(i) + ": " + error.what());
  }
}

std::vector<double> Setting::costs_by(const Objective& other) const {
  std::vector<double> costs;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) costs.push_back(cost_by(other, i));
  return costs;
}

}  // namespace hypotrack::contract
