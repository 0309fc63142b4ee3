// An optimizer that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/random.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  starts_elsewhere,
  overspends,
  miscounts,
  leaves_the_bounds,
  returns_the_last_point,
  ignores_the_seed,
  swallows_exceptions,
  ignores_time,
  hardly_searches,
  crashes,
};
constexpr std::array<std::string_view, 11> kFaults = {"none",
                                                      "starts_elsewhere",
                                                      "overspends",
                                                      "miscounts",
                                                      "leaves_the_bounds",
                                                      "returns_the_last_point",
                                                      "ignores_the_seed",
                                                      "swallows_exceptions",
                                                      "ignores_time",
                                                      "hardly_searches",
                                                      "crashes"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

/// A (1+1) evolution strategy with the 1/5 success rule.
class Broken final : public Optimizer {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit Broken(const Params& params) : fault_(params.fault) {}

  std::int64_t default_evaluations() const override { return 1000; }

  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override {
    static std::atomic<std::uint64_t> calls = 0;
    check_search(cost, region, budget);
    if (fault_ == Fault::crashes) std::abort();
    const Deadline deadline(budget.seconds);
    if (fault_ == Fault::ignores_the_seed) seed = ++calls;
    std::int64_t limit = budget.evaluations + (fault_ == Fault::overspends ? 1 : 0);
    if (fault_ == Fault::hardly_searches) limit = std::min<std::int64_t>(limit, 2);
    double step = 0.5;
    BestSoFar best;
    Eigen::VectorXd point = region.start;
    if (fault_ == Fault::starts_elsewhere) point[0] += 0.1 * region.spread[0];
    for (std::uint32_t i = 1; best.result().evaluations < limit; ++i) {
      Eigen::VectorXd value(1);
      try {
        cost.evaluate(point, value);
      } catch (...) {
        if (fault_ == Fault::swallows_exceptions) break;
        throw;
      }
      step *= best.result().evaluations == 0 || value[0] < best.result().cost ? 1.5 : 0.93;
      best.update(point, value);
      if (deadline.passed() && fault_ != Fault::ignores_time) break;
      if (best.result().evaluations < limit)
        point = sample(region, best.result().point, step, i, seed);
    }
    OptimizerResult result = best.result();
    if (fault_ == Fault::miscounts) ++result.evaluations;
    if (fault_ == Fault::returns_the_last_point) result.point = point;
    return result;
  }

 private:
  Eigen::VectorXd sample(const SearchRegion& region, Eigen::VectorXd point, double step,
                         std::uint32_t number, std::uint64_t seed) const {
    for (Eigen::Index d = 0; d < point.size(); ++d) {
      point[d] += step * region.spread[d] / std::sqrt(static_cast<double>(point.size())) *
                  normal(seed, {static_cast<std::uint32_t>(d), number, 0, 0});
    }
    return fault_ == Fault::leaves_the_bounds ? point : within_bounds(point, region);
  }

  Fault fault_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
