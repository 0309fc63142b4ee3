#pragma once

#include <span>
#include <string_view>

#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

/// Method of computing Jacobians.
enum class JacobianMethod {
  automatic,  ///< analytic if the cost can be linearised, otherwise numerical
  numerical,  ///< an evaluation per dimension
  analytic,   ///< ResidualCost::linearize
};
std::span<const std::string_view> enum_names(JacobianMethod);

struct LevenbergMarquardtParams {
  int evaluations = 512;
  int iterations = 0;
  JacobianMethod jacobian = JacobianMethod::automatic;
  double blur = 1.5;
  int trials = 3;
  double difference = 0.05;
  double finest = 0.2;
  double damping = 0.1;
  double damping_factor = 4;
  double mean_share = 0.05;
  double tolerance = 1e-4;
  int restarts = 1;
  StartParams around;
  void visit(ParamVisitor& v) {
    v("evaluations", evaluations,
      {.help = "evaluations where the scene names no budget", .min = 1, .max = 1 << 30});
    v("iterations", iterations,
      {.help = "Jacobians per search; 0: as many as the budget allows", .min = 0, .max = 1 << 20});
    v("jacobian", jacobian,
      {.help = "numerical: differences, an evaluation per number. analytic: slopes of pixels and "
               "Jacobians of terms; terms without them by differences. auto: analytic where a term "
               "over pixels allows it"});
    v("blur_px", blur,
      {.help = "for analytic Jacobians: first width in pixels of the blur of silhouettes; halved "
               "together with differences",
       .min = 1e-2,
       .max = 100});
    v("trials", trials,
      {.help = "steps of different damping that are evaluated together, the best is taken",
       .min = 1,
       .max = 64});
    v("difference", difference,
      {.help = "the first finite differences, as a share of the search region's spread",
       .min = 1e-6,
       .max = 1});
    v("finest", finest,
      {.help = "halve differences (or the blur) when steps no longer help; stop below this share "
               "of the first ones",
       .min = 1e-3,
       .max = 1});
    v("damping", damping, {.help = "the first damping", .min = 1e-9, .max = 1e9});
    v("damping_factor", damping_factor,
      {.help = "between the dampings of neighbouring trials", .min = 1.01, .max = 1000});
    v("mean_share", mean_share,
      {.help = "share of the mean curvature in the damping of each number; holds numbers with "
               "little influence in place",
       .min = 0,
       .max = 1});
    v("tolerance", tolerance,
      {.help = "a step below this share of the spread in every number does not help",
       .min = 0,
       .max = 1});
    v("restarts", restarts,
      {.help = "searches from different starts that share the evaluations; the first begins at the "
               "start",
       .min = 1,
       .max = 4096});
    around.visit(v);
  }
};

}  // namespace hypotrack
