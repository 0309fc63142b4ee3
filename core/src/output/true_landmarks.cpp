#include "output/true_landmarks.hpp"

#include <algorithm>
#include <limits>

namespace hypotrack {

std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene, const Frame& frame) {
  if (!frame.truth) return std::nullopt;
  const GroundTruth& truth = *frame.truth;
  Eigen::Matrix3Xd landmarks = truth.landmarks;
  if (landmarks.cols() == 0 && truth.state.size() > 0) landmarks = scene.landmarks(truth.state);
  if (landmarks.cols() == 0) return std::nullopt;
  const std::vector<bool> absent = absent_landmarks(scene, truth.absent);
  for (std::size_t i = 0; i < absent.size(); ++i)
    if (absent[i])
      landmarks.col(static_cast<Eigen::Index>(i))
          .setConstant(std::numeric_limits<double>::quiet_NaN());
  return landmarks;
}

std::vector<bool> absent_landmarks(const Scene& scene, const std::vector<bool>& absent_models) {
  std::vector<bool> absent;
  for (std::size_t m = 0; m < absent_models.size(); ++m)
    absent.insert(absent.end(), scene.items()[m].model->data().landmarks.size(), absent_models[m]);
  return absent;
}

std::vector<bool> absent_models(const Scene& scene, const LandmarkRow& row) {
  if (row.absent.empty()) return {};
  std::vector<bool> absent;
  std::size_t i = 0;
  for (const Scene::Item& item : scene.items()) {
    bool said = false, known = false;
    for (const std::size_t end = i + item.model->data().landmarks.size(); i < end; ++i) {
      said = said || row.absent[i];
      known = known || row.landmarks.col(static_cast<Eigen::Index>(i)).allFinite();
    }
    absent.push_back(said && !known);
  }
  if (std::find(absent.begin(), absent.end(), true) == absent.end()) absent.clear();
  return absent;
}

}  // namespace hypotrack
