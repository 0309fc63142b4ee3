#pragma once

#include <cstdint>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

struct CmaEsParams {
  int population = 16;
  int generations = 64;
  double sigma = 0.3;
  double box = 2;
  void visit(ParamVisitor& v) {
    v("population", population,
      {.help = "lambda, points of a generation, evaluated as one batch", .min = 5, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations where the scene names no budget", .min = 1, .max = 1 << 20});
    v("sigma", sigma,
      {.help = "first step size, as a share of the search region's spread",
       .min = 1e-6,
       .max = 10});
    v("box", box,
      {.help = "how far from the start it looks, in spreads, within the bounds",
       .min = 1e-3,
       .max = 1000});
  }
};

/// The covariance matrix adaptation evolution strategy (Hansen and Ostermeier 2001) of pagmo,
/// `cmaes`, with its automatic learning rates. Its first mean is the start, which costs one
/// evaluation. Its first covariance is the square of `sigma` times the spread, less where a bound
/// is nearer than the box. Points outside the bounds or the box are clamped. Budget and batches are
/// those of search_in_generations().
class CmaEs : public Optimizer {
 public:
  explicit CmaEs(const CmaEsParams& params) : params_(params) {}

  std::int64_t default_evaluations() const override {
    return 1 + std::int64_t{params_.population} * params_.generations;
  }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  CmaEsParams params_;
};

}  // namespace hypotrack
