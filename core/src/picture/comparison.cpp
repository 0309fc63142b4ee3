#include "picture/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hypotrack::internal {
namespace {

// Nearly everybody can tell orange and blue apart (BGR).
const cv::Scalar kSolutionColor(30, 140, 255);
const cv::Scalar kTruthColor(255, 190, 70);
const cv::Scalar kTextColor(235, 235, 235);
const cv::Scalar kStripColor(32, 32, 32);
constexpr double kTint = 0.35;
constexpr int kLongSide = 640;  // of the enlarged crop
constexpr int kSmallest = 120;  // side of the crop, so that the legend fits
constexpr int kStripHeight = 56;
constexpr int kSubpixelBits = 4;

using Pixels = std::vector<cv::Point2d>;  // NaN for invisible landmarks

Pixels pixels_of(const Eigen::Matrix3Xd& landmarks, const Camera& camera) {
  Pixels pixels;
  for (Eigen::Index i = 0; i < landmarks.cols(); ++i) {
    const Eigen::Vector2d p = project(camera, landmarks.col(i));
    pixels.emplace_back(p.x(), p.y());
  }
  return pixels;
}

bool is_inside(const cv::Point2d& p, const cv::Size& size) {
  return p.x >= 0 && p.y >= 0 && p.x < size.width && p.y < size.height;  // false for NaN
}

/// Widens a range to at least `least`, and by 15 % on both sides, within 0 .. size.
void widen(int& begin, int& length, int least, int size) {
  const int wanted = std::min(size, std::max(least, static_cast<int>(std::lround(1.3 * length))));
  begin = std::clamp(begin - (wanted - length) / 2, 0, size - wanted);
  length = wanted;
}

/// Returns the part of the image that shows either pose, or all of it if neither is visible.
cv::Rect piece_around(const std::vector<cv::Mat>& labels, const std::vector<Pixels>& landmarks,
                      const cv::Size& size) {
  cv::Rect piece;
  for (const cv::Mat& label : labels)
    if (!label.empty()) piece |= cv::boundingRect(label);
  for (const Pixels& pixels : landmarks)
    for (const cv::Point2d& p : pixels)
      if (is_inside(p, size)) piece |= cv::Rect(static_cast<int>(p.x), static_cast<int>(p.y), 1, 1);
  if (piece.empty()) return {{0, 0}, size};
  widen(piece.x, piece.width, kSmallest, size.width);
  widen(piece.y, piece.height, kSmallest, size.height);
  return piece;
}

/// Draws on an enlarged crop of an image, in the coordinates of the whole image.
class Sheet {
 public:
  Sheet(const cv::Mat& image, const cv::Rect& piece)
      : piece_(piece),
        scale_(static_cast<double>(kLongSide) / std::max(piece.width, piece.height)) {
    cv::resize(image(piece), picture_, {}, scale_, scale_, cv::INTER_CUBIC);
  }

  void tint(const cv::Mat& label, const cv::Scalar& color) {
    cv::Mat inside;
    cv::resize(label(piece_), inside, picture_.size(), 0, 0, cv::INTER_NEAREST);
    cv::Mat tinted = (1 - kTint) * picture_ + kTint * color;
    tinted.copyTo(picture_, inside);
  }

  /// Outlines every model of a label image.
  void outline(const cv::Mat& label, const cv::Scalar& color) {
    double models = 0;
    cv::minMaxLoc(label, nullptr, &models);
    for (int model = 1; model <= static_cast<int>(models); ++model) {
      std::vector<std::vector<cv::Point>> contours;
      cv::findContours(label(piece_) == model, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE,
                       piece_.tl());
      for (auto& contour : contours)
        for (cv::Point& p : contour) p = place(p);
      cv::polylines(picture_, contours, true, kStripColor, 4, cv::LINE_AA, kSubpixelBits);
      cv::polylines(picture_, contours, true, color, 2, cv::LINE_AA, kSubpixelBits);
    }
  }

  void line(const cv::Point2d& from, const cv::Point2d& to) {
    cv::line(picture_, place(from), place(to), kTextColor, 1, cv::LINE_AA, kSubpixelBits);
  }

  void dot(const cv::Point2d& at, const cv::Scalar& color) {
    cv::circle(picture_, place(at), 4 << kSubpixelBits, kStripColor, cv::FILLED, cv::LINE_AA,
               kSubpixelBits);
    cv::circle(picture_, place(at), 3 << kSubpixelBits, color, cv::FILLED, cv::LINE_AA,
               kSubpixelBits);
  }

  /// Returns the picture with the legend below it.
  cv::Mat with_legend(const std::string& caption) const {
    cv::Mat result;
    cv::copyMakeBorder(picture_, result, 0, kStripHeight, 0, 0, cv::BORDER_CONSTANT, kStripColor);
    const auto write = [&](const std::string& text, cv::Point at, const cv::Scalar& color) {
      cv::putText(result, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.55, color, 1, cv::LINE_AA);
    };
    write(caption, {10, picture_.rows + 22}, kTextColor);
    write("solution", {10, picture_.rows + 46}, kSolutionColor);
    write("truth", {100, picture_.rows + 46}, kTruthColor);
    return result;
  }

 private:
  /// Converts an image position to 1/16 pixels of the sheet; pixel centres are at integers in both.
  cv::Point place(const cv::Point2d& p) const {
    const cv::Point2d at =
        (p - cv::Point2d(piece_.tl()) + cv::Point2d(0.5, 0.5)) * scale_ - cv::Point2d(0.5, 0.5);
    return at * (1 << kSubpixelBits);
  }

  cv::Rect piece_;
  double scale_;
  cv::Mat picture_;
};

void draw_landmarks(Sheet& sheet, const Pixels& solution, const Pixels& truth,
                    const cv::Size& size) {
  for (std::size_t i = 0; i < std::min(solution.size(), truth.size()); ++i)
    if (is_inside(solution[i], size) && is_inside(truth[i], size))
      sheet.line(solution[i], truth[i]);
  for (const cv::Point2d& p : truth)
    if (is_inside(p, size)) sheet.dot(p, kTruthColor);
  for (const cv::Point2d& p : solution)
    if (is_inside(p, size)) sheet.dot(p, kSolutionColor);
}

}  // namespace

cv::Mat draw_comparison(Renderer& renderer, const cv::Mat& image, const Camera& camera,
                        const ScenePose& solution, const ScenePose& truth,
                        const std::string& caption) {
  const auto label_of = [&](const ScenePose& pose) {
    return pose.state.size() == 0 ? cv::Mat()
                                  : renderer.render(pose.state, camera, {.textured = false}).label;
  };
  const cv::Mat solution_label = label_of(solution), truth_label = label_of(truth);
  const Pixels solution_pixels = pixels_of(solution.landmarks, camera);
  const Pixels truth_pixels = pixels_of(truth.landmarks, camera);
  Sheet sheet(image, piece_around({solution_label, truth_label}, {solution_pixels, truth_pixels},
                                  image.size()));
  if (!solution_label.empty()) sheet.tint(solution_label, kSolutionColor);
  if (!truth_label.empty()) sheet.outline(truth_label, kTruthColor);
  if (!solution_label.empty()) sheet.outline(solution_label, kSolutionColor);
  draw_landmarks(sheet, solution_pixels, truth_pixels, image.size());
  return sheet.with_legend(caption);
}

}  // namespace hypotrack::internal
