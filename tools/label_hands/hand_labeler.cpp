#include "hand_labeler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "hand_pairs.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::hands {
namespace {

/// Largest reprojection error of a hand that is trusted, as HandPair has it. Above it one view
/// mostly shows other fingers than the other.
constexpr double kTrusted = 0.04;

const char* side(bool right) { return right ? "right" : "left"; }

}  // namespace

HandLabeler::HandLabeler(const Scene& scene, const std::vector<Camera>& cameras)
    : scene_(scene), cameras_(cameras), labelled_(scene.items().size(), 0) {
  std::array<std::string, 2> known;  // name of the left and the right hand
  for (const Scene::Item& item : scene.items()) {
    const auto& hand = hands_.emplace_back(hand_model(*item.model));
    if (!hand) continue;
    std::string& name = known.at(hand->right ? 1 : 0);
    if (!name.empty())
      throw ConfigError(fmt::format(
          "the models '{}' and '{}' are both {} hands, which labels cannot tell apart; expected "
          "one of each side",
          name, item.name, side(hand->right)));
    name = item.name;
  }
  if (known[0].empty() && known[1].empty())
    throw ConfigError(
        "no model of the scene is a hand; expected hand or mirrored_hand, or one "
        "with their landmarks");
  if (cameras.size() < 2)
    throw ConfigError("the scene's source has one view; labels need two, to triangulate from");
  detector_.emplace(HandDetector::Options{});
}

LandmarkRow HandLabeler::label(const Frame& frame) {
  const auto count = std::ssize(scene_.landmark_names());
  LandmarkRow row{frame.index, frame.time,
                  Eigen::Matrix3Xd::Constant(3, count, std::numeric_limits<double>::quiet_NaN())};
  if (frame.views.size() < 2 || frame.views[0].color.empty() || frame.views[1].color.empty())
    return row;
  const std::vector<HandPair> pairs =
      pair_hands({cameras_[0], cameras_[1]}, detector_->detect(frame.views[0].color),
                 detector_->detect(frame.views[1].color));
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < hands_.size(); ++m) {
    const auto own = std::ssize(scene_.items()[m].model->data().landmarks);
    if (const std::optional<HandModel>& hand = hands_[m]) {
      const auto best = std::ranges::find_if(pairs, [&](const HandPair& pair) {
        return (pair.right > 0.5) == hand->right && pair.error < kTrusted;
      });
      if (best != pairs.end()) {
        row.landmarks.middleCols(first, own) = hand->in_model_order(best->landmarks, own);
        ++labelled_[m];
      }
    }
    first += own;
  }
  return row;
}

}  // namespace hypotrack::hands
