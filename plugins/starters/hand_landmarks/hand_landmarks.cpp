#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hand_detector.hpp"
#include "hand_model.hpp"
#include "hand_pairs.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/landmark_fit.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "side_check.hpp"

namespace hypotrack::hands {
namespace {

/// Returns the landmarks in the world of a hand that is `size` times as large as an average one.
HandPoints3D in_world(const Camera& camera, const HandDetection& hand, double size) {
  const HandPoints3D rays = back_project(camera, hand.landmarks);
  const auto spread = [](const HandPoints& points) {
    return std::sqrt((points.colwise() - points.rowwise().mean()).squaredNorm());
  };
  const double depth = size * spread(hand.relative.topRows<2>()) / spread(rays.topRows<2>());
  HandPoints3D out;
  for (Eigen::Index i = 0; i < out.cols(); ++i)
    out.col(i) = rays.col(i) * (depth + size * hand.relative(2, i));
  return camera.camera_from_world.inverse() * out;
}

HandPoints projected(const Camera& camera, const HandPoints3D& landmarks) {
  HandPoints out;
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = project(camera, landmarks.col(i));
  return out;
}

/// Looks for the hands of one view in the other, where a hand of average size would be. Adds what
/// it finds beside the hands that are known there.
void look_in_other_view(const HandDetector& detector, const std::array<Camera, 2>& cameras,
                        const std::vector<HandDetection>& seen, std::size_t view,
                        const cv::Mat& other_picture, std::vector<HandDetection>& known) {
  const std::vector<HandDetection> there = known;
  for (const HandDetection& hand : seen) {
    const auto pairs_with = [&](const std::vector<HandDetection>& others) {
      const std::vector<HandDetection> one{hand};
      return !(view == 0 ? pair_hands(cameras, one, others) : pair_hands(cameras, others, one))
                  .empty();
    };
    if (pairs_with(there)) continue;
    for (const double size : {1.0, 0.85, 1.18}) {
      const std::optional<HandDetection> other = detector.refine(
          other_picture, projected(cameras[1 - view], in_world(cameras[view], hand, size)));
      if (!other || !pairs_with({*other})) continue;
      known.push_back(*other);
      break;
    }
  }
}

/// Distances in the palm, between landmarks by the detector's order: the wrist to each knuckle, and
/// the index to the little knuckle.
constexpr std::array<std::pair<Eigen::Index, Eigen::Index>, 5> kDistances = {
    {{0, 5}, {0, 9}, {0, 13}, {0, 17}, {5, 17}}};

/// Returns a detected hand's size as a factor on a model's, from the distances within its palm.
/// Returns nothing if these disagree.
std::optional<double> relative_size(const Model& model, const HandModel& hand,
                                    const HandPair& pair) {
  constexpr double kMostApart = 0.05;  // standard deviation of the logarithms
  std::vector<double> rest;
  for (const Parameter& p : model.data().parameters) rest.push_back(p.rest);
  const HandPoints3D own = hand.in_detector_order(posed_landmarks(model, rest));
  Eigen::Array<double, 5, 1> logs;
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    const auto [from, to] = kDistances[i];
    const auto distance = [&, from = from, to = to](const HandPoints3D& points) {
      return (points.col(from) - points.col(to)).norm();
    };
    logs[static_cast<Eigen::Index>(i)] = std::log(distance(pair.landmarks) / distance(own));
  }
  const double mean = logs.mean();
  if (!std::isfinite(mean) || std::sqrt((logs - mean).square().mean()) > kMostApart)
    return std::nullopt;
  return std::exp(mean);
}

class HandLandmarks final : public Starter {
 public:
  struct Params {
    std::filesystem::path folder;
    bool lite = false;
    double smallest_hand = 50;
    void visit(ParamVisitor& v) {
      v("folder", folder,
        {.help = "folder of the detector; default: where `hypotrack get detector` puts it"});
      v("lite", lite, {.help = "smaller networks: quicker, less accurate"});
      v("smallest_hand_px", smallest_hand,
        {.help = "length of the smallest hands to search for in small pieces of the pictures, if "
                 "there are no larger ones; 0: no such search",
         .min = 0,
         .max = 10000,
         .unit = "px"});
    }
  };
  /// Reads the networks if a model of the scene is a hand.
  HandLandmarks(const Params& params, PluginContext& context)
      : sides_(context.scene().items().size(), SideCheck(kEnough)), log_(context.log()) {
    for (const Scene::Item& item : context.scene().items()) {
      models_.push_back(hand_model(*item.model));
      if (models_.back() && !detector_)
        detector_.emplace(HandDetector::Options{
            .folder = params.folder, .lite = params.lite, .smallest_hand = params.smallest_hand});
    }
  }

 private:
  bool do_looks() const override { return true; }

  bool do_detects(std::size_t model) const override { return models_.at(model).has_value(); }

  void do_find(const StarterContext& context, std::size_t model, const TakePose& take) override {
    const Scene::Item& item = context.scene.items().at(model);
    const std::optional<HandModel>& hand = models_.at(model);
    if (!hand || !context.frame || context.cameras.size() < 2) return;
    look_at(*context.frame, context.cameras, context.search != nullptr);
    check_side(*context.frame, item.name, model);
    // The likeliest hand of the model's side first; a hand of the other side may be this one, too.
    std::vector<HandPair> pairs = pairs_;
    const auto other_side = [&](const HandPair& pair) { return (pair.right > 0.5) != hand->right; };
    std::ranges::stable_sort(pairs, {}, other_side);
    for (const HandPair& pair : pairs) {
      if (likely(pair, *hand) < (context.sure_only ? kSurely : kLeastLikely)) return;
      if (!take(fitted(*item.model, *hand, pair))) return;
    }
  }

  std::optional<double> do_size(const StarterContext& context, std::size_t model) override {
    const std::optional<HandModel>& hand = models_.at(model);
    if (!hand || !context.frame || context.cameras.size() < 2) return std::nullopt;
    look_at(*context.frame, context.cameras, false);
    const auto pair = std::ranges::find_if(
        pairs_, [&](const HandPair& one) { return likely(one, *hand) >= kSurely; });
    if (pair == pairs_.end()) return std::nullopt;
    return relative_size(*context.scene.items().at(model).model, *hand, *pair);
  }

  /// What was looked at last.
  struct Seen {
    int frame = -1;
    std::array<const unsigned char*, 2> pictures = {};
    bool thorough = false;
    bool operator==(const Seen&) const = default;
  };
  static constexpr double kLeastLikely = 0.1, kSurely = 0.7;  // probabilities of the model's side
  static constexpr int kEnough = 4;  // frames of the other side: there is a second between most

  /// Returns the probability that a hand is of the model's side.
  static double likely(const HandPair& pair, const HandModel& model) {
    return model.right ? pair.right : 1 - pair.right;
  }

  /// Detects the hands of a frame, once; small ones everywhere only if `thorough`.
  void look_at(const Frame& frame, const std::vector<Camera>& cameras, bool thorough) {
    if (frame.views.size() < 2 || frame.views[0].color.empty() || frame.views[1].color.empty())
      return pairs_.clear();
    const std::array<const unsigned char*, 2> pictures{frame.views[0].color.data,
                                                       frame.views[1].color.data};
    const Seen now{frame.index, pictures, thorough};
    if (seen_ == now || seen_ == Seen{frame.index, pictures, true}) return;
    seen_ = now;
    const std::array<Camera, 2> pair{cameras[0], cameras[1]};
    const auto& views = frame.views;
    const auto detect = [&](std::size_t view) {
      const cv::Mat& picture = views[view].color;
      return thorough ? detector_->detect(picture) : detector_->glance(picture, frame.index);
    };
    std::vector<HandDetection> first, second;
    tbb::parallel_invoke([&] { first = detect(0); }, [&] { second = detect(1); });
    look_in_other_view(*detector_, pair, first, 0, views[1].color, second);
    look_in_other_view(*detector_, pair, second, 1, views[0].color, first);
    pairs_ = pair_hands(pair, first, second);
  }

  /// Warns if all hands that were ever seen are of the other side, of which the scene has none.
  void check_side(const Frame& frame, const std::string& name, std::size_t model) {
    const HandModel& own = *models_[model];
    const auto is_of_other = [&](const std::optional<HandModel>& hand) {
      return hand && hand->right != own.right;
    };
    if (pairs_.empty() || std::ranges::any_of(models_, is_of_other)) return;
    double most = 0;
    for (const HandPair& pair : pairs_) most = std::max(most, likely(pair, own));
    if (most >= kSurely) sides_[model].settle();
    if (sides_[model].add(frame.index, most < kLeastLikely))
      log_.warning(wrong_side_text(name, own.right, false));
  }

  /// Fits a hand to triangulated landmarks.
  static Eigen::VectorXd fitted(const Model& model, const HandModel& hand, const HandPair& pair) {
    std::vector<double> rest;
    for (const Parameter& p : model.data().parameters) rest.push_back(p.rest);
    const Eigen::Matrix3Xd landmarks =
        hand.in_model_order(pair.landmarks, std::ssize(model.data().landmarks));
    const Eigen::VectorXd aligned = align_to_landmarks(model, landmarks, rest);
    return fit_landmarks(model, landmarks,
                         {aligned.data(), static_cast<std::size_t>(aligned.size())})
        .parameters;
  }

  std::vector<std::optional<HandModel>> models_;  ///< by model; nothing: it is no hand
  std::optional<HandDetector> detector_;          ///< nothing: the scene has no hand
  std::vector<SideCheck> sides_;                  ///< by model
  PluginLog log_;
  Seen seen_;
  std::vector<HandPair> pairs_;  ///< in the frame seen last
};

}  // namespace

}  // namespace hypotrack::hands

HYPOTRACK_PLUGIN(hypotrack::hands::HandLandmarks,
                 "hands that a learned detector sees in both views", "")
