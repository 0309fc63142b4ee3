#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class Rest final : public Starter {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  explicit Rest(const Params&) {}

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    return context.scene.rest_state();
  }
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Rest, "the rest state of the models", "")
