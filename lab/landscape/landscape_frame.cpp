#include "lab/landscape/landscape_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/stop_scope.hpp"
#include "hypotrack/api/error.hpp"
#include "session/opened_scene.hpp"
#include "track/loop/scene_tracker.hpp"
#include "track/search/frame_search.hpp"

namespace hypotrack::internal {
namespace {

/// The state around which a frame is sliced.
struct Centre {
  Frame frame;
  Eigen::VectorXd state;
  std::vector<bool> shown;  ///< models in view
  bool is_truth = false;
};

bool has_true_state(const Frame& frame) { return frame.truth && frame.truth->state.size() > 0; }

std::vector<bool> shown_models(const Scene& scene, const std::vector<bool>& absent) {
  std::vector<bool> shown(scene.items().size(), true);
  for (std::size_t m = 0; m < absent.size(); ++m) shown[m] = !absent[m];
  return shown;
}

/// Goes through a source up to one frame; tracks on the way if the source knows no truth.
class Approach {
 public:
  Approach(const LandscapeRequest& request, PluginLoader& plugins)
      : request_(request), opened_(open_scene(request.scene, request.overrides, plugins)) {}

  Centre centre() {
    int last = -1;
    while (std::optional<Frame> frame = opened_.source->next()) {
      last = frame->index;
      const bool is_there = frame->index >= request_.frame;
      if (is_there && frame->index > request_.frame) break;
      if (is_there && frame->views.empty())
        throw DataError(fmt::format("frame {} cannot be used: {}; name another with --frame",
                                    frame->index, frame->problem));
      if (!frame->views.empty()) follow(*frame);
      if (is_there) return here(*std::move(frame));
    }
    throw DataError(
        fmt::format("the source has no frame {}; its last one before is {}. Name "
                    "another with --frame",
                    request_.frame, std::min(last, request_.frame - 1)));
  }

 private:
  void follow(const Frame& frame) {
    if (!knows_truth_) knows_truth_ = has_true_state(frame);
    if (*knows_truth_) return;
    if (!tracker_) {
      opened_.parts.status.recovery.run = RecoveryRun::frame;
      tracker_ = std::make_unique<SceneTracker>(*opened_.scene, std::move(opened_.parts),
                                                initial_state(opened_, frame), opened_.seed);
    }
    solution_ = tracker_->track(frame);
  }

  Centre here(Frame frame) const {
    Centre out;
    out.is_truth = *knows_truth_;
    if (out.is_truth && !has_true_state(frame))
      throw DataError(
          fmt::format("frame {} has no true state, though others have; name another with --frame",
                      frame.index));
    std::vector<bool> absent;
    if (out.is_truth) {
      out.state = frame.truth->state;
      absent = frame.truth->absent;
    } else {
      out.state = solution_.state;
      for (const Status status : solution_.models)
        absent.push_back(status == Status::lost || status == Status::absent ||
                         status == Status::missing);
    }
    out.shown = shown_models(*opened_.scene, absent);
    if (std::ranges::find(out.shown, true) == out.shown.end())
      throw DataError(
          fmt::format("no model is in frame {}, as far as {} knows; name another with --frame",
                      frame.index, out.is_truth ? "the truth" : "the tracker"));
    out.frame = std::move(frame);
    return out;
  }

  const LandscapeRequest& request_;
  OpenedScene opened_;
  std::optional<bool> knows_truth_;
  std::unique_ptr<SceneTracker> tracker_;
  Solution solution_;
};

/// The terms of a scene, each with a cost of its own.
class Terms {
 public:
  Terms(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
        const EvaluateSettings& settings) {
    for (const ObjectiveTerm& term : terms) {
      if (term.weight == 0) continue;
      const auto same = std::ranges::count_if(terms, [&](const ObjectiveTerm& other) {
        return &other < &term && other.name == term.name;
      });
      names_.push_back(same == 0 ? term.name : fmt::format("{}_{}", term.name, same + 1));
      costs_.push_back(make_cost(scene, {term}, settings));
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  void prepare(const Observation& observation) {
    for (const auto& cost : costs_) cost->prepare(observation);
  }
  Eigen::MatrixXd evaluate(const Eigen::MatrixXd& states) const {
    Eigen::MatrixXd out(states.cols(), std::ssize(costs_));
    for (std::size_t i = 0; i < costs_.size(); ++i)
      costs_[i]->evaluate(states, out.col(static_cast<Eigen::Index>(i)));
    return out;
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<Cost>> costs_;
};

}  // namespace

FrameLandscape landscape_of_frame(const LandscapeRequest& request, PluginLoader& plugins,
                                  const StopTest& stop) {
  const StopScope scope(stop);
  Approach approach(request, plugins);
  const Centre centre = approach.centre();
  OpenedScene opened = open_scene(request.scene, request.overrides, plugins);
  const Scene& scene = *opened.scene;
  Terms terms(scene, opened.parts.objective, opened.parts.evaluate);
  FrameSearch search(scene, opened.parts);
  search.show(centre.shown);
  search.look(centre.frame, centre.state, false);
  Observation observation = search.prepared(centre.frame);
  observation.scene = &scene;
  terms.prepare(observation);
  LandscapeSettings settings = request.settings;
  settings.models = centre.shown;
  const TermCosts costs = [&](Eigen::MatrixXd states) {
    for (auto state : states.colwise()) state = search.drawn(state);
    return terms.evaluate(states);
  };
  return {measure_landscape(scene, centre.state, terms.names(), costs, settings), centre.is_truth};
}

}  // namespace hypotrack::internal
