// A plugin whose search works for a few frames and then throws, ends the program or breaks its
// contract.
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <limits>
#include <new>
#include <stdexcept>

#include "fill_stack.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How {
  kException,
  kInt,
  kNoMemory,
  kSegfault,
  kExit,
  kUnderscoreExit,
  kInterruptedCode,
  kHang,
  kShortPoint,
  kOutside,
  kTooCheap,
  kMinusInfinity,
  kNegativeCount,
  kOverBudget,
  kEndless,
  kLongBatch,
  kStackOverflow,
};

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 17> kNames = {
      "exception",        "int",           "no_memory",
      "segfault",         "exit",          "underscore_exit",
      "interrupted_code", "hang",          "short_point",
      "outside",          "too_cheap",     "minus_infinity",
      "negative_count",   "over_budget",   "endless",
      "long_batch",       "stack_overflow"};
  return kNames;
}

struct Params {
  int frames = 2;
  How how = How::kException;
  void visit(hypotrack::ParamVisitor& v) {
    v("frames", frames, {.help = "that work; -1: not even the constructor", .min = -1});
    v("how", how, {.help = "it fails then"});
  }
};

class Failing : public hypotrack::Optimizer {
 public:
  using Params = ::Params;
  explicit Failing(const Params& params) : params_(params) {
    if (params.frames < 0) fail();
  }
  std::int64_t default_evaluations() const override { return 2; }
  hypotrack::OptimizerResult minimize(hypotrack::CostFunction& cost,
                                      const hypotrack::SearchRegion& region,
                                      const hypotrack::Budget&, std::uint64_t) override {
    const bool works = done_++ < params_.frames;
    if (!works) fail();
    Eigen::VectorXd costs(1);
    cost.evaluate(region.start, costs);
    while (!works && params_.how == How::kEndless) cost.evaluate(region.start, costs);
    hypotrack::OptimizerResult answer{region.start, costs[0], 1};
    if (!works) spoil(answer, cost, region);
    return answer;
  }

 private:
  void fail() const {
    if (params_.how == How::kInt) throw 42;
    if (params_.how == How::kNoMemory) throw std::bad_alloc();
    if (params_.how == How::kSegfault) raise(SIGSEGV);
    if (params_.how == How::kStackOverflow) fill_stack(0);
    if (params_.how == How::kExit) exit(0);
    if (params_.how == How::kUnderscoreExit) _exit(0);
    if (params_.how == How::kInterruptedCode) _exit(130);
    if (params_.how == How::kHang) std::fputs("hangs\n", stderr);
    while (params_.how == How::kHang) pause();
    if (params_.how == How::kException) throw std::runtime_error("the search is broken");
  }
  void spoil(hypotrack::OptimizerResult& answer, hypotrack::CostFunction& cost,
             const hypotrack::SearchRegion& region) const {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (params_.how == How::kShortPoint) answer.point.conservativeResize(3);
    if (params_.how == How::kOutside) answer.point[0] = kInfinite;
    if (params_.how == How::kTooCheap) answer.cost -= 1e-3;
    if (params_.how == How::kMinusInfinity) answer.cost = -kInfinite;
    if (params_.how == How::kNegativeCount) answer.evaluations = -5;
    if (params_.how == How::kOverBudget) {
      Eigen::VectorXd costs(96);
      cost.evaluate(region.start.replicate(1, costs.size()), costs);
    }
    if (params_.how == How::kLongBatch) {
      Eigen::VectorXd costs(1 << 22);  // minutes
      cost.evaluate(region.start.replicate(1, costs.size()), costs);
    }
  }
  Params params_;
  int done_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
