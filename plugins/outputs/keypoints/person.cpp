#include "person.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace hypotrack::keypoints {
namespace {

using Json = nlohmann::ordered_json;

/// Returns coordinates and confidence, point after point.
Json numbers(const Eigen::Ref<const Eigen::MatrixXd>& points, double confidence) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const bool known = points.col(i).allFinite();
    for (const double coordinate : points.col(i)) out.push_back(known ? coordinate : 0.0);
    out.push_back(known ? confidence : 0.0);
  }
  return out;
}

HandPoints projected(const HandPoints3D& landmarks, const Camera& camera) {
  HandPoints out;
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = project(camera, landmarks.col(i));
  return out;
}

}  // namespace

double confidence_of(Status status, double probability) {
  constexpr double kUncertain = 0.5;
  if (!std::isnan(probability)) return probability;
  return status == Status::tracked ? 1 : kUncertain;
}

Json person(const Hand& hand, const std::vector<Camera>& cameras) {
  const std::string side = hand.right ? "hand_right_keypoints" : "hand_left_keypoints";
  const std::string other = hand.right ? "hand_left_keypoints" : "hand_right_keypoints";
  Json views = Json::array();
  for (const Camera& camera : cameras)
    views.push_back(numbers(projected(hand.landmarks, camera), hand.confidence));
  Json out;
  out["name"] = hand.name;
  out["status"] = to_string(hand.status);
  out[side + "_2d"] = views.front();
  out[other + "_2d"] = Json::array();
  out[side + "_3d"] = numbers(hand.landmarks, hand.confidence);
  out[other + "_3d"] = Json::array();
  out[side + "_3d_camera"] =
      numbers(cameras.front().camera_from_world * hand.landmarks, hand.confidence);
  out[side + "_2d_views"] = std::move(views);
  return out;
}

}  // namespace hypotrack::keypoints
