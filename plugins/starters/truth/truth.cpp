#include <fmt/format.h>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class Truth final : public Starter {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  explicit Truth(const Params&) {}

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    const Frame* frame = context.frame;
    if (!frame) return std::nullopt;
    const bool has_state = frame->truth && frame->truth->state.size() > 0;
    if (!has_state && frame->truth && frame->truth->landmarks.size() > 0)
      throw ConfigError(
          "init.from is 'truth' but the source knows only the true landmarks of its first frame, "
          "not the state; the starter `landmarks` fits the models to them. Write init: {from: "
          "{type: "
          "landmarks, file: FILE}} with the source's truth_landmarks as FILE");
    if (!has_state)
      throw ConfigError(
          "init.from is 'truth' but the source knows no true state for its first frame; give "
          "init.pose or init.file instead");
    context.scene.check(frame->truth->state,
                        fmt::format("the source's true state of frame {}", frame->index));
    return frame->truth->state;
  }
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Truth, "the source's ground truth of the first frame", "")
