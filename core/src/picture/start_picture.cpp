#include "picture/start_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>

#include "camera/epipolar_line.hpp"
#include "hypotrack/api/clicks.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/overlay.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "picture/pen.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the border of a tile in the image of its camera, 2xN.
Eigen::Matrix2Xd outline_of(const TileCamera& tile, const Camera& camera) {
  constexpr int kPerSide = 48;
  const std::array<Eigen::Vector2d, 5> corners{
      Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(tile.width - 0.5, -0.5),
      Eigen::Vector2d(tile.width - 0.5, tile.height - 0.5),
      Eigen::Vector2d(-0.5, tile.height - 0.5), Eigen::Vector2d(-0.5, -0.5)};
  const Eigen::Isometry3d world_from_tile = tile.camera_from_world.inverse();
  Eigen::Matrix2Xd out(2, 4 * kPerSide + 1);
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    const auto side = static_cast<std::size_t>(std::min<Eigen::Index>(i / kPerSide, 3));
    const double share =
        static_cast<double>(i - static_cast<Eigen::Index>(side) * kPerSide) / kPerSide;
    const Eigen::Vector2d at = (1 - share) * corners[side] + share * corners[side + 1];
    out.col(i) = project_uniquely(
        camera, world_from_tile * Eigen::Vector3d((at.x() - tile.cx) / tile.fx,
                                                  (at.y() - tile.cy) / tile.fy, 1.0));
  }
  return out;
}

/// Returns the indices of up to `count` points (2xN, NaN: none) far from each other; `first` comes
/// first if it is a point.
std::vector<Eigen::Index> spread_out(const Eigen::Matrix2Xd& points, Eigen::Index first,
                                     std::size_t count) {
  std::vector<Eigen::Index> out;
  Eigen::VectorXd away(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) away[i] = points.col(i).allFinite() ? 1e9 : 0;
  Eigen::Index next = first;
  if (away[first] <= 0) away.maxCoeff(&next);
  while (out.size() < count && away[next] > 0) {
    out.push_back(next);
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      if (away[i] > 0) away[i] = std::min(away[i], (points.col(i) - points.col(next)).norm());
    away.maxCoeff(&next);
  }
  return out;
}

/// Points of a model to draw, in the first view.
struct DrawnPoints {
  std::vector<std::string> names;
  Eigen::Matrix3Xd in_world;
  Eigen::Matrix2Xd pixels;  ///< NaN: not seen
  Eigen::Index first = 0;   ///< the one to begin with
};

/// Returns the landmarks of a model, or the corners of a box.
DrawnPoints points_of(const Scene::Item& item, std::span<const double> parameters,
                      const Camera& camera) {
  const std::shared_ptr<const Model> model = clickable(item.model);
  const auto& landmarks = model->data().landmarks;
  const bool has_corners = model != item.model;
  const std::size_t left_out = has_corners ? item.model->data().landmarks.size() : 0;
  DrawnPoints out;
  for (std::size_t i = left_out; i < landmarks.size(); ++i) out.names.push_back(landmarks[i].name);
  out.in_world = posed_landmarks(*model, parameters).rightCols(std::ssize(out.names));
  out.pixels.resize(2, out.in_world.cols());
  for (Eigen::Index i = 0; i < out.in_world.cols(); ++i)
    out.pixels.col(i) = project_uniquely(camera, out.in_world.col(i));
  // Corners far from the middle are on the outline and not hidden.
  const Eigen::Vector2d middle = out.pixels.rowwise().mean();
  if (has_corners && middle.allFinite())
    (out.pixels.colwise() - middle).colwise().norm().maxCoeff(&out.first);
  return out;
}

/// Draws some points of one model and their epipolar lines.
void draw_landmarks(const Scene::Item& item, std::span<const double> parameters,
                    const std::vector<Camera>& cameras, std::vector<cv::Mat>& views) {
  constexpr std::size_t kLandmarks = 4;
  const std::array<cv::Scalar, kLandmarks> colors{
      cv::Scalar(80, 230, 255), cv::Scalar(255, 170, 120), cv::Scalar(150, 255, 130),
      cv::Scalar(235, 140, 255)};
  const DrawnPoints points = points_of(item, parameters, cameras[0]);
  if (points.names.empty()) return;
  Pen first(views[0]), second(views[1]);
  std::size_t color = 0;
  for (const Eigen::Index i : spread_out(points.pixels, points.first, kLandmarks)) {
    second.line(epipolar_line(cameras[0], points.pixels.col(i), cameras[1]), colors[color]);
    first.dot(points.pixels.col(i), colors[color], points.names[static_cast<std::size_t>(i)]);
    second.dot(project_uniquely(cameras[1], points.in_world.col(i)), colors[color], "");
    ++color;
  }
}

/// Returns which share of each drawn model all views show, in words.
std::string shares_in_view(const Scene& scene, TileMaker& tiles, const StartToDraw& start,
                           std::size_t views) {
  std::string out;
  const std::size_t models = scene.items().size();
  for (std::size_t m = 0; m < models; ++m) {
    if (!start.hidden.empty() && start.hidden[m]) continue;
    std::vector<bool> others(models, true);
    others[m] = false;
    tiles.leave_out(others);
    out += fmt::format("{}{} {:.0f} %", out.empty() ? "" : ", ", scene.items()[m].name,
                       100 * tiles.visible_share(start.state));
  }
  tiles.leave_out(start.hidden.empty() ? std::vector<bool>(models, false) : start.hidden);
  return fmt::format("in view{}: {}", views == 1 ? "" : views == 2 ? " of both" : " of all", out);
}

/// Draws models, tiles and epipolar lines over the views; adds to the caption.
void draw_models(const Scene& scene, const std::vector<Camera>& cameras,
                 const TileSettings& settings, const Frame& frame, const StartToDraw& start,
                 std::vector<cv::Mat>& views, std::vector<std::string>& caption) {
  TileMaker tiles(scene, cameras, settings);
  caption.push_back(shares_in_view(scene, tiles, start, views.size()));
  TilePlan plan;
  try {
    plan = tiles.plan(frame, start.state);
  } catch (const DataError& e) {
    caption.emplace_back(e.what());
    return;
  }
  Renderer renderer(scene);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i] =
        draw_overlay(renderer, scene, views[i], cameras[i], start.state, {.hidden = start.hidden});
    Pen(views[i]).line(outline_of(plan.header.views[i].camera, cameras[i]), {235, 235, 235});
  }
  if (views.size() < 2) return;
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    const Scene::Item& item = scene.items()[m];
    if (start.hidden.empty() || !start.hidden[m])
      draw_landmarks(item, scene.part(item, start.state), cameras, views);
  }
  caption.emplace_back(
      "white: the tile that is searched; coloured: epipolar lines of the left view's dots");
}

}  // namespace

cv::Mat draw_start(const Scene& scene, const std::vector<Camera>& cameras, const TileSettings& tile,
                   const Frame& frame, const StartToDraw& start) {
  std::vector<cv::Mat> views;
  for (const View& view : frame.views) views.push_back(picture_of(view).clone());
  std::vector<std::string> caption = start.caption;
  if (start.state.size() > 0) draw_models(scene, cameras, tile, frame, start, views, caption);
  return side_by_side(views, caption);
}

}  // namespace hypotrack::internal
