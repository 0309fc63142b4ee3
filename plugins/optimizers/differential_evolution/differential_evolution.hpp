#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

/// Mutation (the points that are combined) and crossover of neighbouring (exp) or any (bin)
/// dimensions. In pagmo's order.
enum class DifferentialVariant {
  best_1_exp,
  rand_1_exp,
  rand_to_best_1_exp,
  best_2_exp,
  rand_2_exp,
  best_1_bin,
  rand_1_bin,
  rand_to_best_1_bin,
  best_2_bin,
  rand_2_bin
};
std::span<const std::string_view> enum_names(DifferentialVariant);

struct DifferentialEvolutionParams {
  int population = 32;
  int generations = 32;
  DifferentialVariant variant = DifferentialVariant::best_1_exp;
  double weight = 0.7;
  double crossover = 0.9;
  double box = 2;
  StartParams start;
  void visit(ParamVisitor& v) {
    v("population", population,
      {.help = "individuals, evaluated as one batch", .min = 5, .max = 1 << 20});
    v("generations", generations,
      {.help = "generations, the initial one included, where the scene names no budget",
       .min = 1,
       .max = 1 << 20});
    v("variant", variant, {.help = "base of the differences, their number and the crossover"});
    v("weight", weight, {.help = "F, factor of the differences", .min = 0, .max = 1});
    v("crossover", crossover,
      {.help = "CR, probability of a dimension to change", .min = 0, .max = 1});
    v("box", box,
      {.help = "how far from the start it looks, in spreads, within the bounds",
       .min = 1e-3,
       .max = 1000});
    start.visit(v);
  }
};

/// Differential evolution (Storn and Price 1997) of pagmo, `de`. The initial population is the
/// start and samples around it (start_points.hpp), within the bounds and the box. A dimension that
/// leaves them is drawn again within them. Budget and batches are those of search_in_generations().
class DifferentialEvolution : public Optimizer {
 public:
  explicit DifferentialEvolution(const DifferentialEvolutionParams& params) : params_(params) {}

  std::int64_t default_evaluations() const override {
    return std::int64_t{params_.population} * params_.generations;
  }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  DifferentialEvolutionParams params_;
};

}  // namespace hypotrack
