// An objective that keeps its contract except for a fault, named by a parameter.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <thread>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  nan_where_nothing_is_covered,
  overflows_on_noise,
  remembers,
  depends_on_the_thread,
  depends_on_the_object,
  never_repeats,
  refuses_everything,
  throws_a_stranger,
  needs_a_first_frame,
  infinite_residual,
  leaves_residuals_out,
  writes_too_many_residuals,
  scales_residuals,
  residuals_that_ignore_the_cost,
  other_residuals_with_the_cost,
  crashes,
  has_no_residuals,
};
constexpr std::array<std::string_view, 18> kFaults = {"none",
                                                      "nan_where_nothing_is_covered",
                                                      "overflows_on_noise",
                                                      "remembers",
                                                      "depends_on_the_thread",
                                                      "depends_on_the_object",
                                                      "never_repeats",
                                                      "refuses_everything",
                                                      "throws_a_stranger",
                                                      "needs_a_first_frame",
                                                      "infinite_residual",
                                                      "leaves_residuals_out",
                                                      "writes_too_many_residuals",
                                                      "scales_residuals",
                                                      "residuals_that_ignore_the_cost",
                                                      "other_residuals_with_the_cost",
                                                      "crashes",
                                                      "has_no_residuals"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

/// Rewards inverse depth: the cost is its negative mean.
class Broken final : public Objective, public ResidualTerm {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit Broken(const Params& params) : fault_(params.fault), number_(++objects_) {}

 private:
  void do_prepare(const Observation& observation) override {
    if (fault_ == Fault::refuses_everything) throw DataError("this is not what I asked for");
    if (fault_ == Fault::throws_a_stranger) throw std::runtime_error("no luck");
    if (observation.views.size() < 2) throw DataError("expected two views");
    ++frames_;
  }

  double do_cost(const RenderedHypothesis& hypothesis) const override {
    double sum = 0;
    int covered = 0;
    if (fault_ == Fault::crashes) std::abort();
    for (const DepthTile& tile : hypothesis.views) {
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          const float z = tile.inverse_depth[y * tile.stride + x];
          sum += fault_ == Fault::overflows_on_noise ? std::exp(z) : std::fmin(z, 100.0f);
          covered += z > 0;
        }
      }
    }
    const double count = fault_ == Fault::nan_where_nothing_is_covered ? covered : covered + 1;
    return -sum / count + extra(sum);
  }

  const ResidualTerm* do_residual_term() const override {
    return fault_ == Fault::has_no_residuals ? nullptr : this;
  }
  std::int64_t do_residual_count() const override { return 2; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    const bool covered = hypothesis.views[0].x1 > hypothesis.views[0].x0;
    residuals[0] = fault_ == Fault::infinite_residual ? 1.0f / static_cast<float>(covered) : 1.0f;
    if (fault_ != Fault::leaves_residuals_out) residuals[1] = second_residual(hypothesis);
    if (fault_ == Fault::writes_too_many_residuals) residuals.data()[2] = 1.0f;
  }
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override {
    do_write_residuals(hypothesis, residuals);
    if (fault_ == Fault::other_residuals_with_the_cost) residuals[0] = 2;
    return do_cost(hypothesis);
  }

  float second_residual(const RenderedHypothesis& hypothesis) const {
    constexpr double kLowestCost = -100;
    if (fault_ == Fault::residuals_that_ignore_the_cost) return 1;
    const double residual = std::sqrt(std::max(0.0, do_cost(hypothesis) - kLowestCost));
    return static_cast<float>(fault_ == Fault::scales_residuals ? 7 * residual : residual);
  }
  double extra(double sum) const {
    switch (fault_) {
      case Fault::remembers: {
        return std::exchange(last_, sum) * 1e-3;
      }
      case Fault::depends_on_the_thread:
        return static_cast<double>(std::hash<std::thread::id>{}(std::this_thread::get_id()) % 997);
      case Fault::depends_on_the_object:
        return number_;
      case Fault::never_repeats:
        return ++calls_;
      case Fault::needs_a_first_frame:
        return frames_ > 2 ? std::numeric_limits<double>::quiet_NaN() : 0;
      default:
        return 0;
    }
  }

  static inline std::atomic<int> objects_ = 0;
  Fault fault_;
  int number_;
  int frames_ = 0;
  mutable double last_ = 0;
  mutable std::atomic<int> calls_ = 0;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "residuals")
