// An objective with a parameter that scenes read themselves, and with one without help.
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class BrokenNames final : public Objective {
 public:
  struct Params {
    double weight = 1, sigma = 1;
    void visit(ParamVisitor& v) {
      v("weight", weight, {.help = "of the state"});
      v("sigma", sigma, {});
    }
  };
  explicit BrokenNames(const Params&) {}

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis&) const override { return 0; }
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::BrokenNames, "breaks the contract of parameters", "devices of_its_own")
