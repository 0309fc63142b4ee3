#include "palm_detector.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "hand_picture.hpp"

namespace hypotrack::hands {
namespace {

constexpr int kPalmSide = 192;   // pixels of the network's picture
constexpr int kBoxNumbers = 18;  // box, then seven points
constexpr std::size_t kAnchors = 2016;

/// Returns the places, in shares of the picture, that the network's boxes are relative to.
std::vector<Eigen::Vector2d> make_anchors() {
  struct Grid {
    int cells;
    int boxes_per_cell;
  };
  std::vector<Eigen::Vector2d> out;
  for (const Grid& grid : {Grid{kPalmSide / 8, 2}, Grid{kPalmSide / 16, 6}}) {
    for (int y = 0; y < grid.cells; ++y) {
      for (int x = 0; x < grid.cells; ++x) {
        const Eigen::Vector2d middle(x + 0.5, y + 0.5);
        out.insert(out.end(), static_cast<std::size_t>(grid.boxes_per_cell), middle / grid.cells);
      }
    }
  }
  return out;
}

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

double overlap(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b) {
  const Eigen::AlignedBox2d both = a.intersection(b);
  if (both.isEmpty()) return 0;
  return both.volume() / (a.volume() + b.volume() - both.volume());
}

Palm weighted_mean(const std::vector<Palm>& palms) {
  Palm out = palms.front();
  double weight = 0;
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  out.points.setZero();
  for (const Palm& palm : palms) {
    weight += palm.score;
    low += palm.score * palm.box.min();
    high += palm.score * palm.box.max();
    out.points += palm.score * palm.points;
  }
  out.box = Eigen::AlignedBox2d(low / weight, high / weight);
  out.points /= weight;
  return out;
}

}  // namespace

PalmDetector::PalmDetector(const std::filesystem::path& file)
    : network_(file, kPalmSide, {{"boxes", kAnchors * kBoxNumbers}, {"scores", kAnchors}}),
      anchors_(make_anchors()) {}

std::vector<Palm> PalmDetector::find(const HandPicture& picture, const cv::Rect& part,
                                     double least_score) const {
  const auto outputs = network_.run(
      [&](std::span<float> input) { write_letterbox(picture, part, kPalmSide, input); });
  const std::vector<float>& boxes = outputs[0];
  const double side = std::max(part.width, part.height);
  // Where the black picture's corner lies in the picture; outer edges of pixels are at halves.
  const Eigen::Vector2d corner(part.x + (part.width - side) / 2 - 0.5,
                               part.y + (part.height - side) / 2 - 0.5);
  std::vector<Palm> palms;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    Palm palm;
    palm.score = sigmoid(double{outputs[1][i]});
    if (!(palm.score >= least_score)) continue;
    const auto pair = [&](std::size_t k) -> Eigen::Vector2d {
      const std::size_t at = i * kBoxNumbers + 2 * k;
      return Eigen::Vector2d(double{boxes[at]}, double{boxes[at + 1]}) / kPalmSide;
    };
    const Eigen::Vector2d middle = corner + side * (anchors_[i] + pair(0));
    const Eigen::Vector2d half = side / 2 * pair(1).cwiseAbs();
    palm.box = Eigen::AlignedBox2d(middle - half, middle + half);
    for (std::size_t k = 0; k < 7; ++k) {
      palm.points.col(static_cast<Eigen::Index>(k)) = corner + side * (anchors_[i] + pair(2 + k));
    }
    if (half.allFinite() && palm.points.allFinite() && half.minCoeff() > 0) palms.push_back(palm);
  }
  return without_overlaps(std::move(palms));
}

std::vector<Palm> without_overlaps(std::vector<Palm> palms) {
  constexpr double kSame = 0.3;  // intersection over union
  std::stable_sort(palms.begin(), palms.end(),
                   [](const Palm& a, const Palm& b) { return a.score > b.score; });
  std::vector<Palm> out;
  while (!palms.empty()) {
    const Eigen::AlignedBox2d best = palms.front().box;
    const auto rest = std::stable_partition(palms.begin(), palms.end(), [&](const Palm& palm) {
      return overlap(best, palm.box) > kSame;
    });
    out.push_back(weighted_mean({palms.begin(), rest}));
    palms.erase(palms.begin(), rest);
  }
  return out;
}

}  // namespace hypotrack::hands
