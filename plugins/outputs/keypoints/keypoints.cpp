#include <fmt/format.h>

#include <optional>
#include <utility>

#include "hand_model.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "person.hpp"

namespace hypotrack {
namespace {

/// A hand of the scene.
struct HandItem {
  std::size_t item;    ///< index of its model
  Eigen::Index first;  ///< index of its first landmark among those of the scene
  HandModel model;
};

std::vector<HandItem> hands_of(const Scene& scene) {
  std::vector<HandItem> hands;
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Model& model = *scene.items()[m].model;
    if (const auto hand = hand_model(model)) hands.push_back({m, first, *hand});
    first += static_cast<Eigen::Index>(model.data().landmarks.size());
  }
  return hands;
}

class Keypoints final : public Output {
 public:
  struct Params {
    void visit(ParamVisitor&) {}
  };
  Keypoints(const Params&, const PluginContext& context) : hands_(hands_of(context.scene())) {
    if (hands_.empty())
      throw ConfigError(fmt::format(
          "{}: no model of the scene is a hand, with landmarks such as wrist, index_mcp and "
          "middle_tip; add a hand, or leave keypoints out",
          context.config().where()));
  }

 private:
  std::vector<std::string> do_file_names() const override { return {"keypoints.jsonl"}; }
  void do_begin(OutputContext& run) override {
    run_ = &run;
    file_.emplace(run.file("keypoints.jsonl"));
  }
  void do_frame(const Frame& frame, const Solution& solution) override;

  std::vector<HandItem> hands_;
  OutputContext* run_ = nullptr;
  std::optional<TextFile> file_;
};

void Keypoints::do_frame(const Frame& frame, const Solution& solution) {
  using Json = nlohmann::ordered_json;
  constexpr double kOpenPoseVersion = 1.3;  // of its JSON files
  const Scene& scene = run_->scene();
  const Eigen::Matrix3Xd landmarks = scene.landmarks(solution.state);
  Json people = Json::array();
  for (const auto& [item, first, model] : hands_) {
    const Scene::Item& of_scene = scene.items()[item];
    const Status status = solution.models[item];
    if (!pose_known(status)) continue;
    const auto count = static_cast<Eigen::Index>(of_scene.model->data().landmarks.size());
    people.push_back(
        keypoints::person({of_scene.name, status, model.right,
                           keypoints::confidence_of(status, solution.probabilities[item]),
                           model.in_detector_order(landmarks.middleCols(first, count))},
                          run_->cameras()));
  }
  const Json json = {{"version", kOpenPoseVersion},
                     {"frame", solution.frame},
                     {"time", solution.time},
                     {"people", std::move(people)}};
  std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  // A number of JSON's library does not keep every digit.
  if (frame.stamp) line.insert(line.find(",\"people\""), ",\"stamp\":" + stamp_text(*frame.stamp));
  file_->write(line + "\n");
}

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Keypoints,
                 "hand keypoints in 2D and 3D in OpenPose's layout: keypoints.jsonl", "")
