#include "picture/flat_drawer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>

#include "cost/draw/hypothesis_drawer.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "picture/surface.hpp"
#include "scene/scene_plan.hpp"

namespace hypotrack::internal {
namespace {

/// Colours the pixels of one model.
class Paint {
 public:
  Paint(const RenderStyle& style, const TileCamera& camera, const Eigen::Vector3f& color)
      : camera_(camera),
        to_light_((camera.camera_from_world.linear() * -style.light_direction.normalized())
                      .cast<float>()),
        color_(255 * color),
        ambient_(static_cast<float>(style.ambient)),
        diffuse_(static_cast<float>(style.diffuse)),
        specular_(255 * static_cast<float>(style.specular)),
        shininess_(static_cast<float>(style.shininess)) {}

  /// Returns the colour (BGR) of a pixel of a surface.
  cv::Vec3b at(cv::Point pixel, const Surface& surface) const {
    const Eigen::Vector2f slopes = surface.slopes_at(pixel);
    const auto dx = static_cast<float>(pixel.x - camera_.cx);
    const auto dy = static_cast<float>(pixel.y - camera_.cy);
    const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
    const Eigen::Vector3f to_camera = -Eigen::Vector3f(dx / fx, dy / fy, 1).normalized();
    const Eigen::Vector3f normal =
        -Eigen::Vector3f(fx * slopes[0], fy * slopes[1],
                         surface.inverse_depth(pixel) - dx * slopes[0] - dy * slopes[1])
             .normalized();
    const float lambert = std::max(normal.dot(to_light_), 0.0F);
    float highlight = 0;
    if (specular_ > 0 && lambert > 0) {
      const float cosine = std::max(normal.dot((to_light_ + to_camera).normalized()), 0.0F);
      highlight = specular_ * std::pow(cosine, shininess_);
    }
    const Eigen::Vector3f rgb =
        (ambient_ + diffuse_ * lambert) * color_ + Eigen::Vector3f::Constant(highlight);
    return {cv::saturate_cast<unsigned char>(rgb.z()), cv::saturate_cast<unsigned char>(rgb.y()),
            cv::saturate_cast<unsigned char>(rgb.x())};
  }

 private:
  TileCamera camera_;
  Eigen::Vector3f to_light_;
  Eigen::Vector3f color_;
  float ambient_, diffuse_, specular_, shininess_;
};

}  // namespace

Eigen::Vector3f flat_color(int model_index) {
  static const std::array<Eigen::Vector3f, 6> kColors = {
      Eigen::Vector3f{0.00F, 0.68F, 0.74F}, Eigen::Vector3f{0.98F, 0.55F, 0.15F},
      Eigen::Vector3f{0.62F, 0.42F, 0.90F}, Eigen::Vector3f{0.45F, 0.75F, 0.25F},
      Eigen::Vector3f{0.92F, 0.33F, 0.45F}, Eigen::Vector3f{0.95F, 0.80F, 0.25F}};
  return kColors[static_cast<std::size_t>(model_index) % kColors.size()];
}

/// One model alone, so that its pixels are known.
struct FlatDrawer::Solo {
  explicit Solo(const Scene::Item& item)
      : scene({{item.name, item.model}}), plan(scene), drawer(plan) {}
  Scene scene;
  ScenePlan plan;
  HypothesisDrawer drawer;
};

FlatDrawer::FlatDrawer(const Scene& scene) : scene_(scene) {
  for (const Scene::Item& item : scene.items()) solos_.push_back(std::make_unique<Solo>(item));
}

FlatDrawer::~FlatDrawer() = default;

Surface FlatDrawer::draw_surface(const std::vector<std::size_t>& shown,
                                 const Eigen::VectorXd& state, const TileCamera& camera) {
  Observation observation;
  observation.views.resize(1);
  observation.views.front().camera = camera;
  const FrameProjection projection(observation);
  Surface out({camera.width, camera.height});
  double triangles = 0;
  for (const std::size_t m : shown) {
    HypothesisDrawer& drawer = solos_[m]->drawer;
    drawer.prepare(projection);
    const DepthTile tile = drawer.draw(scene_.part(scene_.items()[m], state)).front();
    for (int y = tile.y0; y < tile.y1; ++y) {
      const float* from = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
      for (int x = tile.x0; x < tile.x1; ++x) {
        if (!(from[x] > out.inverse_depth(y, x))) continue;
        out.inverse_depth(y, x) = from[x];
        out.label(y, x) = static_cast<unsigned char>(m + 1);
      }
    }
    for (const std::size_t count : drawer.visible(0).count) triangles += static_cast<double>(count);
  }
  out.find_slopes(std::sqrt(cv::countNonZero(out.label) / std::max(triangles, 1.0)));
  return out;
}

void FlatDrawer::draw(const Eigen::VectorXd& given, const LensRays& lens,
                      const Eigen::Isometry3d& camera_from_world, const RenderStyle& style,
                      RenderedView& rendered) {
  Eigen::VectorXd state = given;
  scene_.normalize(state);
  std::vector<std::size_t> shown;
  std::vector<Eigen::Matrix3Xf> posed;
  for (std::size_t m = 0; m < solos_.size(); ++m) {
    if (m < style.hidden.size() && style.hidden[m]) continue;
    const Scene::Item& item = scene_.items()[m];
    shown.push_back(m);
    posed.push_back(posed_vertices(*item.model, scene_.part(item, state)));
  }
  const LensView view = lens.view(extent_of(posed, camera_from_world), camera_from_world);
  if (view.roi.empty()) return;
  const Surface surface = draw_surface(shown, state, view.pinhole);
  std::vector<Paint> paints;
  for (std::size_t m = 0; m < solos_.size(); ++m)
    paints.emplace_back(style, view.pinhole, flat_color(static_cast<int>(m)));
  for (int y = 0; y < view.roi.height; ++y) {
    for (int x = 0; x < view.roi.width; ++x) {
      std::optional<cv::Point> from({x, y});
      if (!view.map.empty())
        from = nearest_pixel(view.map.at<cv::Point2f>(y, x), 1, surface.label.size());
      if (!from || surface.label(*from) == 0) continue;
      const cv::Point to = view.roi.tl() + cv::Point(x, y);
      const unsigned char label = surface.label(*from);
      rendered.label.at<unsigned char>(to) = label;
      rendered.depth.at<float>(to) = 1 / surface.inverse_depth(*from);
      rendered.color.at<cv::Vec3b>(to) = paints[label - 1U].at(*from, surface);
    }
  }
}

Eigen::AlignedBox2d extent_of(std::span<const Eigen::Matrix3Xf> vertices,
                              const Eigen::Isometry3d& camera_from_world) {
  const Eigen::Isometry3f pose = camera_from_world.cast<float>();
  Eigen::AlignedBox2d box;
  bool behind = false;
  for (const Eigen::Matrix3Xf& model : vertices) {
    const Eigen::Matrix3Xf p = pose * model;
    for (Eigen::Index i = 0; i < p.cols(); ++i) {
      if (p(2, i) < 2 * kNearest) {
        behind = true;
      } else {
        box.extend((p.col(i).head<2>() / p(2, i)).cast<double>());
      }
    }
  }
  if (behind && !box.isEmpty()) {  // a triangle through the camera plane may reach anywhere
    box.min().setConstant(-std::numeric_limits<double>::infinity());
    box.max().setConstant(std::numeric_limits<double>::infinity());
  }
  return box;
}

}  // namespace hypotrack::internal
