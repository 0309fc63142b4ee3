// A plugin that scores a few frames and then throws, crashes or breaks its contract.
#include <array>
#include <csignal>
#include <limits>
#include <stdexcept>

#include "fill_stack.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How {
  kDevice,
  kException,
  kInt,
  kSegfault,
  kStackOverflow,
  kNanCost,
  kMinusInfinity,
  kNanResidual,
  kNegativeCount,
  kNanJacobian,
  kNarrowJacobian,
};

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 11> kNames = {
      "device",         "exception",      "int",          "segfault",       "stack_overflow",
      "nan_cost",       "minus_infinity", "nan_residual", "negative_count", "nan_jacobian",
      "narrow_jacobian"};
  return kNames;
}

class Failing : public hypotrack::Objective, public hypotrack::ResidualTerm {
 public:
  struct Params {
    int frames = 2;
    int failures = 1'000'000;
    How how = How::kDevice;
    void visit(hypotrack::ParamVisitor& v) {
      v("frames", frames, {.help = "that work", .min = 0});
      v("failures", failures, {.help = "frames after them that fail", .min = 0});
      v("how", how, {.help = "it fails then"});
    }
  };
  explicit Failing(const Params& params) : params_(params) {}

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const hypotrack::Observation&) override { ++frames_; }
  double do_cost(const hypotrack::RenderedHypothesis& hypothesis) const override {
    if (fails()) fail();
    if (fails() && params_.how == How::kNanCost) return std::numeric_limits<double>::quiet_NaN();
    if (fails() && params_.how == How::kMinusInfinity)
      return -std::numeric_limits<double>::infinity();
    return hypothesis.state[0] * hypothesis.state[0];
  }

  const hypotrack::ResidualTerm* do_residual_term() const override {
    return has_residuals() ? this : nullptr;
  }
  std::int64_t do_residual_count() const override {
    return fails() && params_.how == How::kNegativeCount ? -7 : 1;
  }
  void do_write_residuals(const hypotrack::RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    residuals[0] = static_cast<float>(hypothesis.state[0]);
    if (fails() && params_.how == How::kNanResidual)
      residuals[0] = std::numeric_limits<float>::quiet_NaN();
  }
  bool do_has_jacobian() const override {
    return params_.how == How::kNanJacobian || params_.how == How::kNarrowJacobian;
  }
  void do_write_jacobian(const hypotrack::RenderedHypothesis& hypothesis,
                         std::span<float> residuals, hypotrack::Jacobian& jacobian) const override {
    do_write_residuals(hypothesis, residuals);
    jacobian(0, 0) = 1;
    if (!fails()) return;
    if (params_.how == How::kNanJacobian) jacobian(0, 2) = std::numeric_limits<float>::quiet_NaN();
    if (params_.how == How::kNarrowJacobian) jacobian.resize(1, 6);
  }

  bool has_residuals() const {
    return params_.how == How::kNanResidual || params_.how == How::kNegativeCount ||
           do_has_jacobian();
  }
  bool fails() const {
    const int after = frames_ - params_.frames;
    return after > 0 && after <= params_.failures;
  }
  void fail() const {
    if (params_.how == How::kDevice) throw hypotrack::DeviceError("the device is lost");
    if (params_.how == How::kException) throw std::runtime_error("the cost is broken");
    if (params_.how == How::kInt) throw 42;
    if (params_.how == How::kSegfault) raise(SIGSEGV);
    if (params_.how == How::kStackOverflow) fill_stack(0);
  }
  Params params_;
  int frames_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
