#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::test {

/// Returns the residuals of a hypothesis. Expects that every one is written and nothing behind
/// them, that write_residuals() and cost_and_residuals() write the same, and that the latter
/// returns the cost.
inline std::vector<float> written_residuals(const Objective& objective,
                                            const RenderedHypothesis& hypothesis) {
  const ResidualTerm& term = *objective.residual_term();
  const auto count = static_cast<std::size_t>(term.residual_count());
  std::vector<float> alone(count + 32, NAN), beside_cost(alone);  // what is not written stays NaN
  term.write_residuals(hypothesis, {alone.data(), count});
  const double cost = objective.cost_and_residuals(hypothesis, {beside_cost.data(), count});
  EXPECT_NEAR(cost, objective.cost(hypothesis), 1e-6 * std::abs(cost));
  for (std::vector<float>* written : {&alone, &beside_cost}) {
    for (std::size_t i = count; i < written->size(); ++i) EXPECT_TRUE(std::isnan((*written)[i]));
    written->resize(count);
    for (const float r : *written) EXPECT_FALSE(std::isnan(r));
  }
  EXPECT_EQ(alone, beside_cost);
  return alone;
}

inline double sum_of_squares(const std::vector<float>& residuals) {
  double sum = 0;
  for (const float r : residuals) sum += static_cast<double>(r) * r;
  return sum;
}

}  // namespace hypotrack::test
