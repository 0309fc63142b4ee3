// An objective that keeps its contract except for a fault of its device part, named by a parameter.
#include "broken_device.hpp"

#include <array>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault { none, another_cost, never_repeats, accepts_everything };
constexpr std::array<std::string_view, 4> kFaults = {"none", "another_cost", "never_repeats",
                                                     "accepts_everything"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

class BrokenDevice final : public Objective {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit BrokenDevice(const Params& params) : fault_(params.fault) {}

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation& observation) override {
    if (observation.views.size() < 2) throw DataError("expected two views");
  }
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    return SquaredLength().cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()));
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return hypotrack::on_device({.another_cost = fault_ == Fault::another_cost,
                                 .never_repeats = fault_ == Fault::never_repeats,
                                 .accepts_everything = fault_ == Fault::accepts_everything});
  }

  Fault fault_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::BrokenDevice, "breaks the device's contract as asked", "device")
