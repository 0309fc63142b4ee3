// Made by tools/fit_judge/fit.py; not to be changed by hand.
#pragma once

#include <array>

#include "judge/evidence.hpp"

/// Weights of logistic regressions over ModelJudge::features(): the probability that a model's
/// landmarks are within 10 mm of where they are in truth, and not more than 20 mm off.
namespace hypotrack::judge_weights {

struct Logistic {
  double bias;
  std::array<double, 2 * Evidence::kCount> factors;
};

/// Before anything was learned.
inline constexpr Logistic kFresh{-9.8536,
                                 {{
                                     -2.0911,   // correlation
                                     6.7887,    // texture
                                     -1.2184,   // agreement
                                     -2.9096,   // contrast
                                     -0.76267,  // difference
                                     0.52975,   // ring_texture
                                     0.43895,   // ring_difference
                                     11.914,    // separation
                                     3.7873,    // edges
                                     -1.5462,   // edge_ratio
                                     0,         // inside
                                     0,         // ring
                                     -10.025,   // paired
                                     9.9663,    // visible
                                     0.38365,   // worst_agreement
                                     0,         // worst_inside
                                     0,         // worst_ring
                                     0.43548,   // worst_edges
                                     0,         // d_correlation
                                     0,         // d_texture
                                     0,         // d_agreement
                                     0,         // d_contrast
                                     0,         // d_difference
                                     0,         // d_ring_texture
                                     0,         // d_ring_difference
                                     0,         // d_separation
                                     0,         // d_edges
                                     0,         // d_edge_ratio
                                     0,         // d_inside
                                     0,         // d_ring
                                     0,         // d_paired
                                     0,         // d_visible
                                     0,         // d_worst_agreement
                                     0,         // d_worst_inside
                                     0,         // d_worst_ring
                                     0,         // d_worst_edges
                                 }}};

/// After that.
inline constexpr Logistic kExperienced{16.416,
                                       {{
                                           -2.7792,    // correlation
                                           3.489,      // texture
                                           2.0322,     // agreement
                                           -1.8827,    // contrast
                                           -0.74312,   // difference
                                           -0.27214,   // ring_texture
                                           0.39052,    // ring_difference
                                           9.3101,     // separation
                                           5.8479,     // edges
                                           -2.8465,    // edge_ratio
                                           10.873,     // inside
                                           10.84,      // ring
                                           -29.533,    // paired
                                           -3.419,     // visible
                                           -0.28379,   // worst_agreement
                                           -0.65139,   // worst_inside
                                           -2.5532,    // worst_ring
                                           -1.0158,    // worst_edges
                                           1.5467,     // d_correlation
                                           0.84269,    // d_texture
                                           -1.7179,    // d_agreement
                                           0.38421,    // d_contrast
                                           -1.6125,    // d_difference
                                           3.3525,     // d_ring_texture
                                           0.052787,   // d_ring_difference
                                           -10.823,    // d_separation
                                           -4.1807,    // d_edges
                                           -3.1073,    // d_edge_ratio
                                           4.011,      // d_inside
                                           -36.884,    // d_ring
                                           24.851,     // d_paired
                                           7.6239,     // d_visible
                                           -0.049288,  // d_worst_agreement
                                           5.1228,     // d_worst_inside
                                           -1.4161,    // d_worst_ring
                                           1.4983,     // d_worst_edges
                                       }}};

}  // namespace hypotrack::judge_weights
