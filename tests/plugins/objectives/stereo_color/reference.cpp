#include "reference.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hypotrack::stereo_color::reference {
namespace {

// Inside a tile and valid?
bool usable(const TileView& view, int x, int y) {
  return x >= 0 && y >= 0 && x < view.color.cols && y < view.color.rows &&
         view.valid.at<uchar>(y, x) != 0;
}

double grey(const TileView& view, int x, int y) {
  const auto& p = view.color.at<cv::Vec3b>(y, x);
  return (0.299 * p[2] + 0.587 * p[1] + 0.114 * p[0]) / 255.0;
}

Eigen::Vector2d gradient(const TileView& view, int x, int y) {
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  if (x < 0 || y < 0 || x >= view.color.cols || y >= view.color.rows) return g;
  if (usable(view, x - 1, y) && usable(view, x + 1, y)) {
    g.x() = (grey(view, x + 1, y) - grey(view, x - 1, y)) / 2;
  }
  if (usable(view, x, y - 1) && usable(view, x, y + 1)) {
    g.y() = (grey(view, x, y + 1) - grey(view, x, y - 1)) / 2;
  }
  return g;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.size() % 2 ? v[v.size() / 2] : (v[v.size() / 2 - 1] + v[v.size() / 2]) / 2;
}

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

Eigen::Vector4d sample(const TileView& view, const std::vector<double>& c, const Params& params,
                       int x, int y) {
  const auto& p = view.color.at<cv::Vec3b>(y, x);
  Eigen::Vector4d out(p[2] / 255.0, p[1] / 255.0, p[0] / 255.0, 0);
  const double shared = (1 - params.gray_weight) * (out.head<3>().mean() - 0.5);
  out.head<3>() = (out.head<3>().array() - shared).cwiseMax(0).cwiseMin(1);
  if (params.color_space == ColorSpace::gray) out << grey(view, x, y), 0, 0, 0;
  out[3] = c[static_cast<std::size_t>(y) * view.color.cols + x];
  return out;
}

Eigen::Vector4d interpolate(const TileView& view, const std::vector<double>& c,
                            const Params& params, double u, double v) {
  const int w = view.color.cols, h = view.color.rows;
  const int x = std::clamp(static_cast<int>(std::floor(u)), 0, w - 2);
  const int y = std::clamp(static_cast<int>(std::floor(v)), 0, h - 2);
  const double fx = std::clamp(u - x, 0.0, 1.0), fy = std::clamp(v - y, 0.0, 1.0);
  const auto at = [&](int i, int j) { return sample(view, c, params, x + i, y + j); };
  return (1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) +
         fy * ((1 - fx) * at(0, 1) + fx * at(1, 1));
}

double score(const Observation& observation, const RenderedHypothesis& hypothesis,
             const Params& params, std::size_t from, std::size_t to) {
  const TileView& a = observation.views[from];
  const TileView& b = observation.views[to];
  const std::vector<double> c_a = weights(a, params), c_b = weights(b, params);
  const DepthTile& tile_a = hypothesis.views[from];
  const DepthTile& tile_b = hypothesis.views[to];
  double sum = 0, seen = 0, rendered = 0;
  for (int y = 0; y < tile_a.height; ++y) {
    for (int x = 0; x < tile_a.width; ++x) {
      const double w = tile_a.inverse_depth[y * tile_a.stride + x];
      if (w <= 0) continue;
      ++rendered;
      const double z = 1 / w;
      const Eigen::Vector3d p_a((x - a.camera.cx) / a.camera.fx * z,
                                (y - a.camera.cy) / a.camera.fy * z, z);
      const Eigen::Vector3d p =
          b.camera.camera_from_world * (a.camera.camera_from_world.inverse() * p_a);
      if (p.z() <= 0) continue;
      const double u = b.camera.fx * p.x() / p.z() + b.camera.cx;
      const double v = b.camera.fy * p.y() / p.z() + b.camera.cy;
      const int i = static_cast<int>(std::lround(u)), j = static_cast<int>(std::lround(v));
      if (i < 0 || j < 0 || i >= tile_b.width || j >= tile_b.height) continue;
      const double w_b = tile_b.inverse_depth[j * tile_b.stride + i];
      if (w_b <= 0 || std::abs(1 / w_b - p.z()) > params.r) continue;
      ++seen;
      const Eigen::Vector4d l = sample(a, c_a, params, x, y);
      const Eigen::Vector4d r = params.lookup == Lookup::bilinear
                                    ? interpolate(b, c_b, params, u, v)
                                    : sample(b, c_b, params, i, j);
      const double scaled = params.beta * (l - r).head<3>().norm();
      const double alike =
          std::exp(params.falloff == Falloff::gaussian ? -scaled * scaled : -scaled);
      sum += std::min(l[3], r[3]) * (alike - params.coverage_penalty);
    }
  }
  if (params.aggregation == Aggregation::mean_seen) return seen > 0 ? sum / seen : 0;
  if (params.aggregation == Aggregation::mean_rendered) return rendered > 0 ? sum / rendered : 0;
  if (params.aggregation == Aggregation::sum_per_sqrt) {
    return rendered > 0 ? sum / std::sqrt(rendered) : 0;
  }
  return sum;
}

}  // namespace

std::vector<double> weights(const TileView& view, const Params& params) {
  const int width = view.color.cols, height = view.color.rows;
  std::vector<double> c(static_cast<std::size_t>(width) * height, 1.0);
  if (params.distinctiveness == Distinctiveness::principal_curvatures) {
    std::vector<double> d(c.size()), a(c.size()), valid_d, valid_a;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) {
            const Eigen::Vector2d g = gradient(view, x + i, y + j);
            m += g * g.transpose();
          }
        }
        const Eigen::Vector2d l = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(m).eigenvalues();
        const std::size_t k = static_cast<std::size_t>(y) * width + x;
        d[k] = std::log(l.norm() + 1e-12);
        a[k] = std::atan2(std::max(l[0], 0.0), l[1]);
        if (!usable(view, x, y)) continue;
        valid_d.push_back(d[k]);
        valid_a.push_back(a[k]);
      }
    }
    const double m_d = valid_d.empty() ? 0 : median(valid_d);
    const double m_a = valid_a.empty() ? 0 : median(valid_a);
    for (std::size_t k = 0; k < c.size(); ++k) {
      c[k] = sigmoid(d[k] - m_d) * sigmoid(a[k] - m_a);
      if (c[k] < params.w_t) c[k] = 0;
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool background =
          params.use_mask && !view.mask.empty() && view.mask.at<uchar>(y, x) == 0;
      if (!usable(view, x, y) || background) c[static_cast<std::size_t>(y) * width + x] = 0;
    }
  }
  return c;
}

double cost(const Observation& observation, const RenderedHypothesis& hypothesis,
            const Params& params) {
  const auto one_way = [&](std::size_t from, std::size_t to) {
    return score(observation, hypothesis, params, from, to);
  };
  if (params.direction == Direction::left_to_right) return -one_way(0, 1);
  if (params.direction == Direction::right_to_left) return -one_way(1, 0);
  return -(one_way(0, 1) + one_way(1, 0)) / 2;
}

}  // namespace hypotrack::stereo_color::reference
