#include "rendered_pair.hpp"

#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "cost/cost.hpp"
#include "hypotrack/api/renderer.hpp"
#include "test_models.hpp"

namespace hypotrack::stereo_color {
namespace {

constexpr int kRenderedSize = 128;
constexpr double kRenderedFocal = 320, kRenderedBaseline = 0.12, kRenderedDistance = 0.5;

// Noise at two scales, as skin has it: blotches and grain. The grain is about two pixels wide as
// drawn; finer one would be averaged away where a finger is foreshortened.
cv::Mat3b noise(int size, cv::RNG& rng, const cv::Scalar& mean, double contrast) {
  cv::Mat3f sum(size, size, cv::Vec3f(0, 0, 0));
  for (const int cell : {4, 8}) {
    cv::Mat3f coarse(size / cell, size / cell), fine;
    rng.fill(coarse, cv::RNG::NORMAL, 0, contrast);
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_CUBIC);
    sum += fine;
  }
  cv::Mat3b out;
  cv::Mat(sum + mean).convertTo(out, CV_8U);
  return out;
}

// The test hand, its texture projected along the palm's normal.
ModelData textured_hand(cv::RNG& rng) {
  ModelData data = test::make_test_hand();
  Mesh& mesh = data.mesh;
  const Eigen::Array2f low = mesh.vertices.topRows<2>().rowwise().minCoeff();
  const Eigen::Array2f high = mesh.vertices.topRows<2>().rowwise().maxCoeff();
  mesh.uv =
      ((mesh.vertices.topRows<2>().array().colwise() - low).colwise() / (high - low)).matrix();
  mesh.uv_triangles = mesh.triangles;
  mesh.texture = noise(256, rng, {100, 120, 170}, 25);
  return data;
}

std::vector<Camera> rectified_cameras() {
  std::vector<Camera> cameras(2);
  for (Camera& camera : cameras) {
    camera.width = camera.height = kRenderedSize;
    camera.fx = camera.fy = kRenderedFocal;
    camera.cx = camera.cy = kRenderedSize / 2.0;
  }
  cameras[1].camera_from_world.translation().x() = -kRenderedBaseline;
  cameras[1].cx += kRenderedFocal * kRenderedBaseline / kRenderedDistance;
  return cameras;
}

}  // namespace

Eigen::VectorXd slightly_bent(const Scene& scene) {
  Eigen::VectorXd state = scene.rest_state();
  state.head<7>() << -0.005, 0.085, kRenderedDistance, 0, 1, 0, 0;  // half a turn about x
  for (Eigen::Index i = 7; i < state.size(); ++i) {
    const Parameter& p = scene.parameters()[static_cast<std::size_t>(i)];
    state[i] = p.rest + 0.3 * (p.upper - p.rest);
  }
  return state;
}

RenderedPair::RenderedPair(const Pose& pose) {
  cv::RNG rng(7);
  scene_ =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {"hand", std::make_shared<Model>(textured_hand(rng))}});
  Renderer renderer(*scene_);
  truth_ = pose(*scene_);
  observation_.scene = scene_.get();
  observation_.rectified = true;
  for (const Camera& c : rectified_cameras()) {
    const RenderedView drawn =
        renderer.render(truth_, c, {}, noise(kRenderedSize, rng, {110, 110, 110}, 30));
    TileView view;
    view.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.camera_from_world};
    view.color = drawn.color;
    view.valid = cv::Mat1b(kRenderedSize, kRenderedSize, uchar{255});
    view.mask = drawn.label > 0;
    observation_.views.push_back(view);
  }
}

Eigen::VectorXd RenderedPair::costs(const std::shared_ptr<Objective>& objective,
                                    const Eigen::MatrixXd& states) const {
  const auto cost = make_cost(*scene_, {{1.0, objective}}, {.backend = Backend::cpu, .threads = 1});
  cost->prepare(observation_);
  Eigen::VectorXd out(states.cols());
  cost->evaluate(states, out);
  return out;
}

}  // namespace hypotrack::stereo_color
