#include "trace_contour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace hypotrack::contour {
namespace {

constexpr int kReach = 5;          // pixels along the outline, each side, that give its direction
constexpr float kStraight = 0.9f;  // pixels off a line that quantisation explains

/// A straight piece of outline in pixels.
struct Piece {
  Eigen::Vector2f position;
  Eigen::Vector2f normal;  ///< unit, outwards
};

Eigen::Vector2f vector(const cv::Point& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y)};
}

/// Returns how many pixels from `from` along `step` are on the model, or are not; infinite up to
/// the edge of the picture.
float length(const cv::Mat1b& mask, Eigen::Vector2f from, const Eigen::Vector2f& step, bool on) {
  for (float out = 0;; ++out, from += step) {
    const int x = static_cast<int>(std::lround(from.x())),
              y = static_cast<int>(std::lround(from.y()));
    if (x < 0 || y < 0 || x >= mask.cols || y >= mask.rows)
      return on ? out : std::numeric_limits<float>::infinity();
    if ((mask(y, x) != 0) != on) return out;
  }
}

/// Returns the piece about pixel i of a closed chain of the mask's border pixels. Nothing at a
/// corner.
std::optional<Piece> piece(const cv::Mat1b& mask, const std::vector<cv::Point>& chain, int i) {
  const int size = static_cast<int>(chain.size());
  if (size <= 2 * kReach) return std::nullopt;  // a speck or a pinhole
  const auto at = [&](int k) { return vector(chain[static_cast<std::size_t>((k + size) % size)]); };
  const Eigen::Vector2f along = at(i + kReach) - at(i - kReach);
  if (!(along.norm() > kReach)) return std::nullopt;
  Piece out;
  out.normal = Eigen::Vector2f(along.y(), -along.x()).normalized();
  const Eigen::Vector2f here = at(i);
  float sum = 0, low = 0, high = 0;
  for (int k = i - kReach; k <= i + kReach; ++k) {
    const float off = out.normal.dot(at(k) - here);
    sum += off;
    low = std::min(low, off);
    high = std::max(high, off);
  }
  if (high - low > 2 * kStraight) return std::nullopt;
  const float mean = sum / (2 * kReach + 1);
  if (length(mask, here + 3 * out.normal, out.normal, true) > 0) {
    if (length(mask, here - 3 * out.normal, -out.normal, true) > 0) return std::nullopt;
    out.normal = -out.normal;
    out.position = here - mean * out.normal;
  } else {
    out.position = here + mean * out.normal;
  }
  // Centres of border pixels lie between 0 and one row or column inside the edge.
  out.position += 0.5f * out.normal.cwiseAbs().maxCoeff() * out.normal;
  return out;
}

}  // namespace

std::vector<TracedPoint> trace_contour(const cv::Mat1f& depth, int count) {
  const cv::Mat1b mask = depth > 0;
  std::vector<std::vector<cv::Point>> chains;
  cv::findContours(mask, chains, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::size_t all = 0;
  for (const auto& chain : chains) all += chain.size();
  const double step = static_cast<double>(all) / count;
  std::vector<TracedPoint> out;
  double next = 0;
  for (const auto& chain : chains) {
    const auto size = static_cast<double>(chain.size());
    for (; next < size; next += step) {
      const int i = static_cast<int>(next);
      const std::optional<Piece> found = piece(mask, chain, i);
      if (!found) continue;
      const Eigen::Vector2f n = found->normal;
      out.push_back({found->position, n, depth(chain[static_cast<std::size_t>(i)]),
                     length(mask, found->position - n, -n, true),
                     length(mask, found->position + n, n, false)});
    }
    next -= size;
  }
  return out;
}

}  // namespace hypotrack::contour
