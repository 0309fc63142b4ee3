// A plugin that scores a few frames and then loses its device.
#include "hypotrack/plugin.hpp"

namespace {

class Failing : public hypotrack::Objective {
 public:
  struct Params {
    int frames = 2;
    void visit(hypotrack::ParamVisitor& v) { v("frames", frames, {.help = "that work", .min = 0}); }
  };
  explicit Failing(const Params& params) : params_(params) {}

  void prepare(const hypotrack::Observation&) override { ++frames_; }
  double cost(const hypotrack::RenderedHypothesis& hypothesis) const override {
    if (frames_ > params_.frames) throw hypotrack::DeviceError("the device is lost");
    return hypothesis.state[0];
  }

 private:
  Params params_;
  int frames_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "loses its device in the middle of a run", "")
