#include "track/loop/picture_watch.hpp"

#include <algorithm>
#include <span>

#include "base/profile.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/plugin_call.hpp"
#include "track/faults/picture_checks.hpp"

namespace hypotrack::internal {

PictureWatch::PictureWatch(const std::vector<Camera>& cameras,
                           const std::vector<ObjectiveTerm>& terms, bool is_on,
                           bool corrects_turn) {
  if (is_on) {
    checks_.emplace(cameras, joined_use(terms).depth);
    rig_ = RigWatch::make(cameras, corrects_turn);
    for (const ObjectiveTerm& term : terms)
      if (const auto* views = dynamic_cast<const CameraTurnTerm*>(term.objective.get()); !views_)
        views_ = views, turning_ = term.objective.get();
  }
  const bool is_fisheye = std::ranges::any_of(cameras, [](const Camera& camera) {
    return camera.distortion_model == DistortionModel::fisheye;
  });
  if (corrects_turn && (!rig_ || !views_ || is_fisheye))
    throw ConfigError(
        "status.correct_turn takes two nearly parallel cameras without fisheye lenses, rigid "
        "models and the objective `contour`; leave it off");
}

ViewFault PictureWatch::check(const Frame& frame) {
  const ProfiledPart part("check pictures");
  const ViewFault found = checks_ ? checks_->check(frame) : ViewFault{};
  if (checks_) brightness_.next(checks_->jumps());
  if (rig_ && !spoils_pictures(found.fault)) {
    const bool waits = rig_->learns_rows();
    if (waits) rig_->look(frame);
    correction_ = rig_->correction();
    if (!waits) looking_.begin([this, frame] { rig_->look(frame); });
  }
  return found.fault == FrameFault::none ? ViewFault{frame.fault} : found;
}

PictureWatch::FrameEnd::~FrameEnd() {
  try {
    watch_.looking_.wait();
  } catch (...) {  // lack of memory: the frame teaches nothing
  }
}

Frame PictureWatch::steadied(const Frame& frame) const {
  return corrected(brightness_.applied_to(frame), correction_);
}

void PictureWatch::tell_drifts(FrameSearch& search) {
  const std::optional<int> before = std::exchange(searched_, std::nullopt);
  if (rig_ && before && search.photometric().knows())
    colors_.emplace(*before, search.second_view_colors());
  if (checks_) search.follow_brightness(checks_->drifts());
}

bool PictureWatch::doubts_depth(int frame, bool is_searched) {
  const ProfiledPart part("check rig");
  if (!rig_) return false;
  looking_.wait();
  if (const auto colors = std::exchange(colors_, std::nullopt))
    rig_->look_at_colors(colors->first, colors->second);
  if (is_searched) searched_ = frame;
  return rig_->is_doubtful();
}

void PictureWatch::compare_views(int frame, const Eigen::VectorXd& state) {
  if (!rig_ || !views_) return;
  const std::span all(state.data(), static_cast<std::size_t>(state.size()));
  if (const auto turn = detail::call_plugin(*turning_, [&] { return views_->camera_turn(all); }))
    rig_->look_at_turn(frame, *turn);
}

std::vector<std::string> PictureWatch::take_notes() {
  return rig_ ? rig_->take_notes() : std::vector<std::string>();
}

}  // namespace hypotrack::internal
