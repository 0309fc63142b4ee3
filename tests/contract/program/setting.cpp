#include "setting.hpp"

namespace hypotrack::contract {

RenderedHypothesis Setting::drawn(std::size_t i) const {
  const NamedHypothesis& hypothesis = hypotheses[i];
  RenderedHypothesis rendered;
  rendered.state = {hypothesis.state.data(), static_cast<std::size_t>(hypothesis.state.size())};
  if (objective->needs_rendering()) rendered.views = hypothesis.depth.tiles();
  return rendered;
}

std::vector<double> Setting::costs_by(const Objective& other) const {
  std::vector<double> costs;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) costs.push_back(other.cost(drawn(i)));
  return costs;
}

}  // namespace hypotrack::contract
