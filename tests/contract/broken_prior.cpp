// An objective of the state whose Jacobian keeps its contract except for a fault, named by a
// parameter.
#include <array>
#include <cmath>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  wrong_sign,
  forgets_a_parameter,
  transposed,
  infinite_jacobian,
  other_residuals,
  has_no_jacobian,
};
constexpr std::array<std::string_view, 7> kFaults = {
    "none",           "wrong_sign",        "forgets_a_parameter",
    "transposed",     "infinite_jacobian", "other_residuals",
    "has_no_jacobian"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

/// Pulls the palm towards a distance and upright, and bends two joints alike, beyond a kink.
class BrokenPrior final : public Objective, public ResidualTerm {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit BrokenPrior(const Params& params) : fault_(params.fault) {}

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    std::array<float, 3> r{};
    do_write_residuals(hypothesis, r);
    return r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 3; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    const auto x = hypothesis.state;
    residuals[0] = static_cast<float>(std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) - 0.4);
    residuals[1] = static_cast<float>(1 - 2 * (x[4] * x[4] + x[6] * x[6]));
    residuals[2] = static_cast<float>(std::fmax(0, x[8] - x[9]));
  }
  bool do_has_jacobian() const override { return fault_ != Fault::has_no_jacobian; }
  void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                         Jacobian& jacobian) const override {
    do_write_residuals(hypothesis, residuals);
    const auto x = hypothesis.state;
    const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int k = 0; k < 3; ++k) jacobian(0, k) = static_cast<float>(x[k] / length);
    for (const int k : {4, 6}) jacobian(1, k) = static_cast<float>(-4 * x[k]);
    if (x[8] > x[9]) jacobian.row(2).segment<2>(8) << 1, -1;
    if (fault_ == Fault::wrong_sign) jacobian(0, 2) = -jacobian(0, 2);
    if (fault_ == Fault::forgets_a_parameter) jacobian(2, 9) = 0;
    if (fault_ == Fault::transposed) jacobian = jacobian.transpose().eval();
    if (fault_ == Fault::infinite_jacobian) jacobian(1, 5) = INFINITY;
    if (fault_ == Fault::other_residuals) residuals[1] += 1;
  }

  Fault fault_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::BrokenPrior, "breaks the contract of a Jacobian as asked",
                 "residuals jacobian")
