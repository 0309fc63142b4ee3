#include "reference.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace hypotrack::stereo_patch::reference {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Grey of a pixel, NaN where there is none.
double grey(const TileView& view, int x, int y) {
  if (x < 0 || y < 0 || x >= view.color.cols || y >= view.color.rows) return kNone;
  if (view.valid.at<uchar>(y, x) == 0) return kNone;
  const auto& p = view.color.at<cv::Vec3b>(y, x);
  return (0.299 * p[2] + 0.587 * p[1] + 0.114 * p[0]) / 255.0;
}

double grey_between(const TileView& view, double u, double v) {
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  const double fx = u - x, fy = v - y;
  // In a rectified pair the row is hit exactly, and the next one does not matter.
  const auto row = [&](int j) { return (1 - fx) * grey(view, x, j) + fx * grey(view, x + 1, j); };
  return fy < 1e-9 ? row(y) : (1 - fy) * row(y) + fy * row(y + 1);
}

/// What the first camera's pixel (x, y) at depth z looks like to the second.
Eigen::Vector3d seen_from_second(const Observation& o, double x, double y, double z) {
  const TileCamera &a = o.views[0].camera, &b = o.views[1].camera;
  const Eigen::Vector3d p((x - a.cx) / a.fx * z, (y - a.cy) / a.fy * z, z);
  const Eigen::Vector3d q = b.camera_from_world * a.camera_from_world.inverse() * p;
  return {b.fx * q.x() / q.z() + b.cx, o.rectified ? y : b.fy * q.y() / q.z() + b.cy, q.z()};
}

double zncc(const Observation& o, int x, int y, double z, const Settings& settings) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0, n = 0;
  for (int j = -settings.radius; j <= settings.radius; ++j) {
    for (int i = -settings.radius; i <= settings.radius; ++i) {
      const Eigen::Vector3d p = seen_from_second(o, x + i, y + j, z);
      const double left = grey(o.views[0], x + i, y + j);
      const double right = grey_between(o.views[1], p.x(), p.y());
      a += left, b += right, aa += left * left, bb += right * right, ab += left * right, ++n;
    }
  }
  const double va = aa / n - a * a / n / n, vb = bb / n - b * b / n / n;
  return (ab / n - a * b / n / n) /
         std::sqrt((va + settings.variance_floor) * (vb + settings.variance_floor));
}

double census(const Observation& o, int x, int y, double z, const Settings& settings) {
  const auto there = [&](int i, int j) {
    const Eigen::Vector3d p = seen_from_second(o, x + i, y + j, z);
    return grey_between(o.views[1], p.x(), p.y());
  };
  const double left = grey(o.views[0], x, y), right = there(0, 0);
  double different = 0, n = -1;
  for (int j = -settings.radius; j <= settings.radius; ++j) {
    for (int i = -settings.radius; i <= settings.radius; ++i) {
      const double a = grey(o.views[0], x + i, y + j), b = there(i, j);
      if (std::isnan(a) || std::isnan(b)) return kNone;
      different += (a < left) != (b < right);
      ++n;
    }
  }
  return 1 - 2 * different / n;
}

double similarity(const Observation& o, int x, int y, double w, const Settings& settings) {
  const TileView& view = o.views[0];
  if (settings.use_mask && !view.mask.empty() && !view.mask.at<uchar>(y, x)) return 0;
  const double z = settings.measure == Measure::zncc ? zncc(o, x, y, 1 / w, settings)
                                                     : census(o, x, y, 1 / w, settings);
  return std::isnan(z) ? 0 : std::exp(-settings.sharpness * (1 - z));
}

bool seen(const Observation& o, const DepthTile& there, int x, int y, double w,
          const Settings& settings) {
  const Eigen::Vector3d p = seen_from_second(o, x, y, 1 / w);
  const long u = std::lround(p.x()), v = std::lround(p.y());
  if (u < 0 || v < 0 || u >= there.width || v >= there.height) return false;
  const double depth = there.inverse_depth[v * there.stride + u];
  return depth > 0 && std::abs(1 / depth - p.z()) <= settings.r;
}

}  // namespace

double cost(const Observation& o, const RenderedHypothesis& hypothesis, const Settings& settings) {
  const Planes planes = planes_around(o, settings);
  const DepthTile& here = hypothesis.views[0];
  double sum = 0;
  for (int y = 0; y < here.height; ++y) {
    for (int x = 0; x < here.width; ++x) {
      const double w = here.inverse_depth[y * here.stride + x];
      if (!(w > 0) || !seen(o, hypothesis.views[1], x, y, w, settings)) continue;
      const double position = (w - planes.first) / planes.step;
      if (position < 0 || position > planes.count - 1) continue;
      const double before = std::min(std::floor(position), planes.count - 2.0);
      const auto at = [&](double plane) {
        return similarity(o, x, y, planes.first + plane * planes.step, settings);
      };
      sum += at(before) + (position - before) * (at(before + 1) - at(before));
    }
  }
  return -sum;
}

}  // namespace hypotrack::stereo_patch::reference
