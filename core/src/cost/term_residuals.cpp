#include "cost/term_residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {

std::string TermResiduals::why_none(const std::vector<ObjectiveTerm>& terms) {
  constexpr const char* kInstead =
      "take an optimizer that needs costs only, such as `optimizer: {type: pso}`, and leave "
      "uncertainty off and smoothing.fixed_lag off";
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
    part.first = static_cast<std::size_t>(count_);
    part.count = static_cast<std::size_t>(count);
    count_ += count;
  }
}

std::vector<ResidualRows> pose_only_rows(const std::vector<TermRows>& terms) {
  std::vector<ResidualRows> rows;
  bool others = false;
  Eigen::Index first = 0;
  for (const TermRows& term : terms) {
    if (term.count > 0 && !term.draws) rows.push_back({first, term.count});
    others |= term.count > 0 && term.draws;
    first += term.count;
  }
  return others ? rows : std::vector<ResidualRows>();
}

std::vector<ResidualRows> TermResiduals::pose_only() const {
  std::vector<TermRows> rows;
  for (const Part& part : parts_) {
    rows.push_back({static_cast<Eigen::Index>(part.count), part.objective->needs_rendering()});
  }
  return pose_only_rows(rows);
}

double TermResiduals::write(std::size_t term, const RenderedHypothesis& hypothesis,
                            std::span<float> all) const {
  const Part& part = parts_[term];
  const std::span<float> own = all.subspan(part.first, part.count);
  const double cost = part.objective->cost_and_residuals(hypothesis, own);
  if (part.factor != 1) {
    Eigen::Map<Eigen::ArrayXf>(own.data(), static_cast<Eigen::Index>(own.size())) *= part.factor;
  }
  return cost;
}

}  // namespace hypotrack::internal
