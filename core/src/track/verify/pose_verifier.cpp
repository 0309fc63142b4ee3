#include "track/verify/pose_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "track/verify/surface_points.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kHidden = 0.7;     // share of a model's points that others hide: not verified
constexpr double kUsualRate = 0.1;  // of a frame in what is usual

bool has_colors(const Frame& frame) {
  return frame.views.size() >= 2 && !frame.views[0].color.empty() && !frame.views[1].color.empty();
}

}  // namespace

ModelVerifier::ModelVerifier(const Scene& scene, std::size_t model,
                             const std::vector<Camera>& cameras)
    : item_(scene.items()[model]), model_(model), sampler_(scene, model, cameras) {
  constexpr double kTexel = 0.003;  // metres, as pictures show a texture
  const Mesh& mesh = item_.model->data().mesh;
  // An articulated model may have the texture of another individual.
  if (!is_rigid(item_) || mesh.texture.empty()) return;
  texture_.expect(texture_colors(mesh, sampler_.points(), kTexel));
  symmetries_ = symmetries(mesh);
}

Measures ModelVerifier::measured(const Frame& frame, const Eigen::VectorXd& state,
                                 const ColorMap& colors) {
  samples_ = sampler_.sample(frame, state, colors);
  Measures out = measure(samples_, colors_, appearance_);
  out.experienced = experienced();
  if (usual_) out.usual = *usual_;
  out.usual_likeness = usual_likeness_;
  out.tracked = tracked_;
  out.model = model_;
  return out;
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

void ModelVerifier::forget() {
  colors_ = {};
  appearance_ = {};
  usual_likeness_ = 0;
  tracked_ = false;
  usual_.reset();
}

bool ModelVerifier::learn_usual(const Measures& measures) {
  if (!measures.known) return false;
  if (!usual_ || !colors_.known()) {
    learn_looks();
    usual_ = measure(samples_, colors_, appearance_).values;
    return false;
  }
  for (std::size_t i = 0; i < usual_->size(); ++i)
    (*usual_)[i] += kUsualRate * (measures.values[i] - (*usual_)[i]);
  if (!std::isnan(measures.likeness))
    usual_likeness_ += kUsualRate * (measures.likeness - usual_likeness_);
  return true;
}

void ModelVerifier::learn_looks() {
  colors_.learn(samples_);
  appearance_.learn(samples_);
}

PoseVerifier::PoseVerifier(const Scene& scene, const std::vector<Camera>& cameras,
                           std::shared_ptr<const Judge> judge)
    : judge_(std::move(judge)) {
  if (cameras.size() < 2) return;
  for (std::size_t m = 0; m < scene.items().size(); ++m) models_.emplace_back(scene, m, cameras);
}

ModelProbabilities PoseVerifier::verify(const Frame& frame, const Eigen::VectorXd& state,
                                        const ColorMap& colors, const std::vector<bool>& models) {
  looks_.wait();
  state_ = state;
  ModelProbabilities probabilities(models.size(), std::numeric_limits<double>::quiet_NaN());
  measures_.assign(models_.size(), {});
  if (!has_colors(frame)) return probabilities;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (!models[m]) continue;
    measures_[m] = models_[m].measured(frame, state, colors);
    if (measures_[m].covered > kHidden) continue;
    probabilities[m] = probability_of(log_odds(measures_[m]));
  }
  return probabilities;
}

double PoseVerifier::log_odds(const Measures& measures) const {
  if (!measures.known) return -std::numeric_limits<double>::infinity();
  return judge_->log_odds(measures);
}

bool PoseVerifier::experienced() const {
  return std::ranges::any_of(models_, &ModelVerifier::experienced);
}

void PoseVerifier::learn(const std::vector<bool>& right) {
  looks_.wait();
  std::vector<ModelVerifier*> left;
  for (std::size_t m = 0; m < models_.size(); ++m)
    if (right[m] && measures_[m].covered <= kHidden && models_[m].learn_usual(measures_[m]))
      left.push_back(&models_[m]);
  if (left.empty()) return;
  looks_.begin([left] {
    for (ModelVerifier* model : left) model->learn_looks();
  });
}

}  // namespace hypotrack::internal
