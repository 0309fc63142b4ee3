#include "track/verify/pose_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "track/verify/symmetries.hpp"
#include "track/verify/weights.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kHidden = 0.7;     // share of a model's points that others hide: not verified
constexpr double kUsualRate = 0.1;  // of a frame in what is usual
constexpr double kOfTracked = 0.5;  // share of the likeness's weight for a tracked model

bool has_colors(const Frame& frame) {
  return frame.views.size() >= 2 && !frame.views[0].color.empty() && !frame.views[1].color.empty();
}

}  // namespace

ModelVerifier::ModelVerifier(const Scene& scene, std::size_t model,
                             const std::vector<Camera>& cameras)
    : item_(scene.items()[model]), sampler_(scene, model, cameras) {
  constexpr double kTexel = 0.003;  // metres, as pictures show a texture
  const Mesh& mesh = item_.model->data().mesh;
  if (!is_rigid(item_) || mesh.texture.empty()) return;  // no hand has the texture of a mesh
  texture_.expect(texture_colors(mesh, sampler_.points(), kTexel));
  symmetries_ = symmetries(mesh);
}

Evidence ModelVerifier::measure_evidence(const Frame& frame, const Eigen::VectorXd& state,
                                         const ColorMap& colors) {
  samples_ = sampler_.sample(frame, state, colors);
  Evidence evidence = measure(samples_, colors_);
  evidence.likeness = appearance_.likeness(samples_);
  return evidence;
}

Eigen::VectorXd ModelVerifier::turned_to_texture(const Frame& frame, const Eigen::VectorXd& state,
                                                 const ColorMap& colors) {
  constexpr double kBetter = 0.05;  // less is noise, as on surfaces of one colour
  if (symmetries_.empty()) return state;
  const auto likeness = [&](const Eigen::VectorXd& of) {
    const double out = texture_.likeness(sampler_.sample(frame, of, colors));
    return std::isnan(out) ? 0 : out;
  };
  const Eigen::Isometry3d pose = pose_of(item_, state);
  Eigen::VectorXd best = state;
  double most = likeness(state) + kBetter;
  for (const Eigen::Isometry3d& symmetry : symmetries_) {
    Eigen::VectorXd turned = state;
    set_pose(item_, pose * symmetry, turned);
    const double here = likeness(turned);
    if (here > most) most = here, best = std::move(turned);
  }
  return best;
}

Eigen::VectorXd ModelVerifier::features(const Evidence& evidence) const {
  constexpr Eigen::Index kCount = Evidence::kCount;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(2 * kCount);
  out.head(kCount) = Eigen::Map<const Eigen::VectorXd>(evidence.values.data(), kCount);
  if (usual_)
    out.tail(kCount) = out.head(kCount) - Eigen::Map<const Eigen::VectorXd>(usual_->data(), kCount);
  return out;
}

double ModelVerifier::log_odds(const Evidence& evidence) const {
  if (!evidence.known) return -std::numeric_limits<double>::infinity();
  const Eigen::VectorXd x = features(evidence);
  const verifier_weights::Network& network =
      usual_ ? verifier_weights::kExperienced : verifier_weights::kFresh;
  double sum = network.out_bias;
  for (std::size_t unit = 0; unit < verifier_weights::kHidden; ++unit) {
    const Eigen::Map<const Eigen::VectorXd> weights(network.hidden[unit].data(), x.size());
    sum += network.out[unit] * std::max(0.0, weights.dot(x) + network.hidden_bias[unit]);
  }
  if (usual_ && !std::isnan(evidence.likeness))
    sum += (tracked_ ? kOfTracked : 1.0) * verifier_weights::kLikeness * usual_likeness_ *
           (evidence.likeness - usual_likeness_);
  return sum;
}

void ModelVerifier::forget() {
  colors_ = {};
  appearance_ = {};
  usual_likeness_ = 0;
  tracked_ = false;
  usual_.reset();
}

void ModelVerifier::learn(const Evidence& evidence) {
  if (!evidence.known) return;
  const bool knew_colors = colors_.known();
  colors_.learn(samples_);
  appearance_.learn(samples_);
  if (!usual_ || !knew_colors) {
    usual_ = measure(samples_, colors_).values;
    return;
  }
  for (std::size_t i = 0; i < usual_->size(); ++i)
    (*usual_)[i] += kUsualRate * (evidence.values[i] - (*usual_)[i]);
  if (!std::isnan(evidence.likeness))
    usual_likeness_ += kUsualRate * (evidence.likeness - usual_likeness_);
}

PoseVerifier::PoseVerifier(const Scene& scene, const std::vector<Camera>& cameras) {
  if (cameras.size() < 2) return;
  for (std::size_t m = 0; m < scene.items().size(); ++m) models_.emplace_back(scene, m, cameras);
}

ModelProbabilities PoseVerifier::verify(const Frame& frame, const Eigen::VectorXd& state,
                                        const ColorMap& colors, const std::vector<bool>& models) {
  state_ = state;
  ModelProbabilities probabilities(models.size(), std::numeric_limits<double>::quiet_NaN());
  evidence_.assign(models_.size(), {});
  if (!has_colors(frame)) return probabilities;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (!models[m]) continue;
    evidence_[m] = models_[m].measure_evidence(frame, state, colors);
    if (evidence_[m].covered > kHidden) continue;
    probabilities[m] = 1 / (1 + std::exp(-models_[m].log_odds(evidence_[m])));
  }
  return probabilities;
}

bool PoseVerifier::experienced() const {
  return std::ranges::any_of(models_, &ModelVerifier::experienced);
}

void PoseVerifier::learn(const std::vector<bool>& right) {
  for (std::size_t m = 0; m < models_.size(); ++m)
    if (right[m] && evidence_[m].covered <= kHidden) models_[m].learn(evidence_[m]);
}

}  // namespace hypotrack::internal
