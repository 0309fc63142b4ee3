// A plugin that is as it should be.
#include "sample_optimizer.hpp"

namespace {

struct Params {
  int particles = 64;
  double range = 10 * hypotrack::kDegree;

  void visit(hypotrack::ParamVisitor& v) {
    v("particles", particles, {.help = "particles of the swarm", .min = 2, .max = 1000});
    v("range_deg", range, {.help = "where they start", .unit = "deg", .to_si = hypotrack::kDegree});
  }
};

/// Its default budget tells the test what it was given.
class Sample : public hypotrack::test::OptimizerOfSize {
 public:
  using Params = ::Params;
  explicit Sample(const Params& params) : OptimizerOfSize(params.particles) {}
};

}  // namespace

HYPOTRACK_PLUGIN(Sample, "does what it is told", "deterministic batch")
