// A plugin with a parameter whose name is the scene's.
#include "hypotrack/plugin/plugin.hpp"

namespace {

class Weighty : public hypotrack::Objective {
 public:
  struct Params {
    double weight = 70;
    void visit(hypotrack::ParamVisitor& v) { v("weight", weight, {.help = "of the hand, in kg"}); }
  };
  explicit Weighty(const Params& params) : weight_(params.weight) {}

 private:
  void do_prepare(const hypotrack::Observation&) override {}
  double do_cost(const hypotrack::RenderedHypothesis&) const override { return weight_; }

  double weight_;
};

}  // namespace

HYPOTRACK_PLUGIN(Weighty, "takes a name of the scene", "")
