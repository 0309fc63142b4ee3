#include "output/evaluate/true_landmarks.hpp"

#include <algorithm>
#include <limits>

namespace hypotrack::internal {

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
  if (absent_models.empty()) return absent;
  for (const std::size_t owner : landmark_owners(scene)) absent.push_back(absent_models[owner]);
  return absent;
}

std::vector<std::size_t> landmark_owners(const Scene& scene) {
  std::vector<std::size_t> owners;
  for (std::size_t m = 0; m < scene.items().size(); ++m)
    owners.insert(owners.end(), scene.items()[m].model->data().landmarks.size(), m);
  return owners;
}

std::vector<bool> absent_models(const LandmarkRow& row, std::span<const std::size_t> owners,
                                std::size_t models) {
  if (row.absent.empty()) return {};
  std::vector<bool> absent(models), known(models);
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (row.absent[i]) absent[owners[i]] = true;
    if (row.landmarks.col(static_cast<Eigen::Index>(i)).allFinite()) known[owners[i]] = true;
  }
  for (std::size_t m = 0; m < models; ++m) absent[m] = absent[m] && !known[m];
  if (std::find(absent.begin(), absent.end(), true) == absent.end()) absent.clear();
  return absent;
}

}  // namespace hypotrack::internal
