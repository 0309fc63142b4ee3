#include "stage/forearm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "stage/surfaces.hpp"

namespace hypotrack::synthetic {
namespace {

constexpr int kSegments = 40;

/// The ellipse around the proximal end of a hand's mesh, in the frame of the wrist's bone.
struct Wrist {
  double end = 0;  ///< y of the mesh's end
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d radii = Eigen::Vector2d::Zero();  ///< x radial and z palmar
  cv::Scalar color;                                 ///< mean of the skin there, BGR
};

/// A ring of the tube: y, and factors on the wrist's radii.
struct Ring {
  double y;
  double wide;
  double thick;
};

cv::Scalar mean_color(const Mesh& mesh, const std::vector<bool>& near) {
  if (mesh.texture.empty() || mesh.uv_triangles.cols() == 0) {
    const Eigen::Vector3f c = 255 * mesh.color;
    return {c.z(), c.y(), c.x()};
  }
  cv::Scalar sum;
  int count = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (!near[static_cast<std::size_t>(mesh.triangles(k, t))]) continue;
      const Eigen::Vector2f uv = mesh.uv.col(mesh.uv_triangles(k, t));
      const int x = std::clamp(static_cast<int>(uv.x() * static_cast<float>(mesh.texture.cols)), 0,
                               mesh.texture.cols - 1);
      const int y =
          std::clamp(static_cast<int>((1 - uv.y()) * static_cast<float>(mesh.texture.rows)), 0,
                     mesh.texture.rows - 1);
      sum += cv::Scalar(mesh.texture.at<cv::Vec3b>(y, x));
      ++count;
    }
  }
  return sum / std::max(1, count);
}

Wrist measure(const ModelData& hand, int wrist_bone) {
  constexpr float kSlab = 0.012F;
  const Eigen::Isometry3d bone_from_model =
      bind_transforms(hand)[static_cast<std::size_t>(wrist_bone)].inverse();
  const Eigen::Matrix3Xf vertices = bone_from_model.cast<float>() * hand.mesh.vertices;
  const float end = vertices.row(1).minCoeff();
  std::vector<bool> near(static_cast<std::size_t>(vertices.cols()));
  Eigen::AlignedBox2f box;
  for (Eigen::Index v = 0; v < vertices.cols(); ++v) {
    if (vertices(1, v) > end + kSlab) continue;
    near[static_cast<std::size_t>(v)] = true;
    box.extend(Eigen::Vector2f(vertices(0, v), vertices(2, v)));
  }
  return {end, box.center().cast<double>(), box.sizes().cast<double>() / 2,
          mean_color(hand.mesh, near)};
}

double smooth_step(double t) { return t * t * (3 - 2 * t); }

/// Returns the ring of an arm that widens from the wrist to below the elbow, `t` from 0 to 1.
Ring arm(double y, double t, double at_wrist, double wide, double thick) {
  const double s = smooth_step(std::min(1.0, t / 0.7));
  return {y, at_wrist + (wide - at_wrist) * s, at_wrist + (thick - at_wrist) * s};
}

/// Returns the rings of a bare arm, which starts a little inside the hand's end.
std::vector<Ring> bare_rings(double end, double length) {
  constexpr int kRings = 24;
  std::vector<Ring> rings = {{end + 0.008, 0.90, 0.90}, {end + 0.004, 0.98, 0.98}};
  for (int i = 0; i <= kRings; ++i) {
    const double t = static_cast<double>(i) / kRings;
    rings.push_back(arm(end - t * length, t, 1.02, 1.40, 1.75));
  }
  return rings;
}

/// Returns the rings of a sleeve: a cuff around the wrist, then cloth with folds.
std::vector<Ring> sleeve_rings(double end, double length) {
  constexpr int kRings = 60;
  constexpr double kCuff = 0.012;
  std::vector<Ring> rings = {{end + kCuff, 0.80, 0.80}, {end + kCuff, 1.16, 1.20}};
  for (int i = 0; i <= kRings; ++i) {
    const double t = static_cast<double>(i) / kRings;
    Ring ring = arm(end + kCuff - 0.003 - t * length, t, 1.22, 1.65, 2.05);
    const double fold = t * (0.03 * std::sin(37 * t) + 0.015 * std::sin(91 * t + 1));
    ring.wide += fold;
    ring.thick += fold;
    rings.push_back(ring);
  }
  return rings;
}

Mesh make_tube(const Wrist& wrist, const std::vector<Ring>& rings) {
  const auto count = static_cast<int>(rings.size());
  Mesh mesh;
  mesh.vertices.resize(3, count * kSegments + 1);
  mesh.uv.resize(2, count * (kSegments + 1) + 1);
  for (int r = 0; r < count; ++r) {
    const Ring& ring = rings[static_cast<std::size_t>(r)];
    for (int s = 0; s <= kSegments; ++s) {
      const double angle = 2 * std::numbers::pi * s / kSegments;
      if (s < kSegments) {
        mesh.vertices.col(r * kSegments + s) =
            Eigen::Vector3d(wrist.center.x() + ring.wide * wrist.radii.x() * std::cos(angle),
                            ring.y,
                            wrist.center.y() + ring.thick * wrist.radii.y() * std::sin(angle))
                .cast<float>();
      }
      mesh.uv.col(r * (kSegments + 1) + s) << static_cast<float>(s) / kSegments,
          static_cast<float>(r) / static_cast<float>(count);
    }
  }
  mesh.vertices.rightCols<1>() << static_cast<float>(wrist.center.x()),
      static_cast<float>(rings.back().y), static_cast<float>(wrist.center.y());
  mesh.uv.rightCols<1>() << 0.5F, 1.0F;
  const int sides = 2 * (count - 1) * kSegments;
  mesh.triangles.resize(3, sides + kSegments);
  mesh.uv_triangles.resize(3, sides + kSegments);
  int t = 0;
  for (int r = 0; r < count; ++r) {
    for (int s = 0; s < kSegments; ++s) {
      const int next = (s + 1) % kSegments;
      const int a = r * kSegments + s, b = r * kSegments + next;
      const int ua = r * (kSegments + 1) + s, ub = ua + 1;
      if (r + 1 == count) {  // close the end towards the elbow
        mesh.triangles.col(t) << a, b, count * kSegments;
        mesh.uv_triangles.col(t++) << ua, ub, count * (kSegments + 1);
        continue;
      }
      const int below = kSegments, uv_below = kSegments + 1;
      mesh.triangles.col(t) << a, b, b + below;
      mesh.uv_triangles.col(t++) << ua, ub, ub + uv_below;
      mesh.triangles.col(t) << a, b + below, a + below;
      mesh.uv_triangles.col(t++) << ua, ub + uv_below, ua + uv_below;
    }
  }
  return mesh;
}

/// Makes the texture of skin or cloth: nearly one colour.
cv::Mat make_cover(const cv::Scalar& color, double contrast) {
  cv::RNG random(20171);
  cv::Mat fine(512, 256, CV_32FC1), coarse(64, 32, CV_32FC1), grown;
  random.fill(fine, cv::RNG::NORMAL, 0.0, contrast);
  random.fill(coarse, cv::RNG::NORMAL, 0.0, contrast);
  cv::resize(coarse, grown, fine.size(), 0, 0, cv::INTER_CUBIC);
  cv::GaussianBlur(fine, fine, {}, 0.8);
  cv::Mat bgr, cover;
  cv::cvtColor(cv::Mat(fine + grown), bgr, cv::COLOR_GRAY2BGR);
  bgr += color;
  bgr.convertTo(cover, CV_8UC3);
  return cover;
}

}  // namespace

Eigen::Vector3d skin_color(const ModelData& hand, int wrist_bone) {
  const cv::Scalar bgr = measure(hand, wrist_bone).color;
  return {bgr[2], bgr[1], bgr[0]};
}

ModelData make_forearm(const ModelData& hand, int wrist_bone, const ForearmParams& params) {
  if (!params.color.empty() && params.color.size() != 3) {
    throw ConfigError(fmt::format("forearm.color has {} numbers, expected three: red, green, blue",
                                  params.color.size()));
  }
  const Wrist wrist = measure(hand, wrist_bone);
  const bool sleeve = params.kind == ForearmKind::sleeve;
  cv::Scalar color = sleeve ? cv::Scalar(24, 21, 20) : wrist.color;
  if (!params.color.empty()) {
    color = cv::Scalar(params.color[2], params.color[1], params.color[0]);
  }
  Mesh mesh = make_tube(wrist, sleeve ? sleeve_rings(wrist.end, params.length)
                                      : bare_rings(wrist.end, params.length));
  mesh.texture = make_cover(color, sleeve ? 1.5 : 4.0);
  return rigid_model(std::move(mesh));
}

}  // namespace hypotrack::synthetic
