// A plugin whose search works for a few frames and then throws or dies.
#include <array>
#include <csignal>
#include <stdexcept>

#include "hypotrack/plugin.hpp"

namespace {

enum class How { kException, kInt, kSegfault };

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 3> kNames = {"exception", "int", "segfault"};
  return kNames;
}

struct Params {
  int frames = 2;
  How how = How::kException;
  void visit(hypotrack::ParamVisitor& v) {
    v("frames", frames, {.help = "that work", .min = 0});
    v("how", how, {.help = "it fails then"});
  }
};

class Failing : public hypotrack::Optimizer {
 public:
  using Params = ::Params;
  explicit Failing(const Params& params) : params_(params) {}
  std::int64_t default_evaluations() const override { return 1; }
  hypotrack::OptimizerResult minimize(hypotrack::CostFunction& cost,
                                      const hypotrack::SearchRegion& region,
                                      const hypotrack::Budget&, std::uint64_t) override {
    if (done_++ >= params_.frames) fail();
    Eigen::VectorXd costs(1);
    cost.evaluate(region.start, costs);
    return {region.start, costs[0], 1};
  }

 private:
  void fail() const {
    if (params_.how == How::kInt) throw 42;
    if (params_.how == How::kSegfault) raise(SIGSEGV);
    throw std::runtime_error("the search is broken");
  }
  Params params_;
  int done_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
