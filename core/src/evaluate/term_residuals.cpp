#include "evaluate/term_residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hypotrack {

std::string TermResiduals::why_none(const std::vector<ObjectiveTerm>& terms) {
  constexpr const char* kInstead =
      "take an optimizer that needs costs only, such as `optimizer: {type: pso}`, and leave "
      "tracker.uncertainty off";
  for (const ObjectiveTerm& term : terms) {
    if (term.weight == 0) continue;
    if (term.weight < 0) {
      return fmt::format(
          "the weight of objective {} is {}, and squares cannot be taken off; expected 0 or more, "
          "or {}",
          term.name, term.weight, kInstead);
    }
    if (!term.objective->residual_term()) {
      return fmt::format(
          "objective {}, as it is set up, offers no residuals (`hypotrack plugins info {}` says "
          "what it offers); leave it out, or {}",
          term.name, term.name, kInstead);
    }
  }
  return {};
}

TermResiduals::TermResiduals(const std::vector<ObjectiveTerm>& terms) {
  for (const ObjectiveTerm& term : terms) {
    parts_.push_back({term.objective.get(), static_cast<float>(std::sqrt(term.weight))});
  }
}

void TermResiduals::prepare() {
  count_ = 0;
  for (Part& part : parts_) {
    if (part.factor == 0) continue;
    const std::int64_t count = part.objective->residual_term()->residual_count();
    part.count = static_cast<std::size_t>(count);
    count_ += count;
  }
}

std::vector<ResidualRows> TermResiduals::pose_only() const {
  std::vector<ResidualRows> rows;
  Eigen::Index first = 0;
  for (const Part& part : parts_) {
    const auto count = static_cast<Eigen::Index>(part.count);
    if (count > 0 && !part.objective->needs_rendering()) rows.push_back({first, count});
    first += count;
  }
  const bool all = rows.size() == static_cast<std::size_t>(std::ranges::count_if(
                                      parts_, [](const Part& part) { return part.count > 0; }));
  return all ? std::vector<ResidualRows>() : rows;
}

double TermResiduals::write(std::size_t term, const RenderedHypothesis& hypothesis,
                            std::span<float>& rest) const {
  const Part& part = parts_[term];
  const std::span<float> own = rest.first(part.count);
  rest = rest.subspan(part.count);
  const double cost = part.objective->cost_and_residuals(hypothesis, own);
  if (part.factor != 1) {
    for (float& r : own) r *= part.factor;
  }
  return cost;
}

}  // namespace hypotrack
