#include "calibrate/board/chessboard.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace hypotrack::calibrate {
namespace {

constexpr int kSmallWidth = 640;  // pixels
// An adaptive threshold helps in uneven light, and takes many times longer without a board.
constexpr int kFast = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
constexpr int kSlow = kFast | cv::CALIB_CB_ADAPTIVE_THRESH;

cv::Mat resized(const cv::Mat& gray, double scale) {
  if (scale >= 1) return gray;
  cv::Mat out;
  cv::resize(gray, out, {}, scale, scale, cv::INTER_AREA);
  return out;
}

/// Moves corners to a picture that is `factor` times as large. Pixel centres are at integers.
void enlarge(std::vector<cv::Point2f>& at, double factor) {
  const auto f = static_cast<float>(factor), half = 0.5F;
  for (cv::Point2f& p : at) p = {(p.x + half) * f - half, (p.y + half) * f - half};
}

std::vector<cv::Point2f> corners_of_size(const cv::Mat& gray, cv::Size size, int flags) {
  std::vector<cv::Point2f> out;
  if (!cv::findChessboardCorners(gray, size, out, flags)) out.clear();
  return out;
}

/// Corners as rows and columns.
struct Grid {
  cv::Size size;
  std::vector<cv::Point2f> at;

  const cv::Point2f& operator()(int row, int column) const {
    return at[static_cast<std::size_t>(row * size.width + column)];
  }
};

/// Returns the corners as seen from the front: columns turn clockwise into rows.
Grid unmirrored(Grid grid) {
  const cv::Point2f x = grid(0, 1) - grid(0, 0), y = grid(1, 0) - grid(0, 0);
  if (x.x * y.y - x.y * y.x >= 0) return grid;
  for (auto row = grid.at.begin(); row != grid.at.end(); row += grid.size.width)
    std::reverse(row, row + grid.size.width);
  return grid;
}

/// Returns a grid with rows and columns exchanged, turned by 90 degrees.
Grid turned(const Grid& grid) {
  Grid out{{grid.size.height, grid.size.width}, {}};
  for (int row = 0; row < out.size.height; ++row)
    for (int column = 0; column < out.size.width; ++column)
      out.at.push_back(grid(column, grid.size.width - 1 - row));
  return out;
}

/// Returns whether the squares around the corners are inside a picture.
bool is_whole(const Grid& grid, cv::Size picture) {
  const int right = grid.size.width - 1, bottom = grid.size.height - 1;
  const auto inside = [&](int row, int column, int inner_row, int inner_column) {
    const cv::Point2f at = 2 * grid(row, column) - grid(inner_row, inner_column);
    return at.x > 0 && at.y > 0 && at.x < static_cast<float>(picture.width) &&
           at.y < static_cast<float>(picture.height);
  };
  return inside(0, 0, 1, 1) && inside(0, right, 1, right - 1) && inside(bottom, 0, bottom - 1, 1) &&
         inside(bottom, right, bottom - 1, right - 1);
}

/// Returns the corners if they are a board of a size, perhaps turned; none otherwise.
std::vector<cv::Point2f> as_size(const SeenChessboard& seen, cv::Size size) {
  if (seen.size == size) return seen.at;
  if (seen.size != cv::Size(size.height, size.width)) return {};
  return turned({seen.size, seen.at}).at;
}

/// Returns as_size(), but nothing of pictures that are too blurred for refine():
/// largest_chessboard() sees boards in them.
std::vector<cv::Point2f> sharp_of_size(const cv::Mat& gray, const SeenChessboard& seen,
                                       cv::Size size) {
  constexpr double kWidest = 8;  // pixels, of edges
  std::vector<cv::Point2f> at = as_size(seen, size);
  if (!at.empty() && cv::estimateChessboardSharpness(gray, size, at)[0] > kWidest) at.clear();
  return at;
}

/// Returns whether a board may be a part of one of the other size.
bool is_part(cv::Size part, cv::Size whole) {
  const auto [least, most] = std::minmax(part.width, part.height);
  const auto [narrow, wide] = std::minmax(whole.width, whole.height);
  return least <= narrow && most <= wide;
}

/// Refines corners of a copy of `scale`, in copies of twice the size each, to those of a picture.
void refine(const cv::Mat& gray, cv::Size size, double scale, std::vector<cv::Point2f>& at) {
  constexpr int kWindow = 5, kLeastWindow = 2, kIterations = 40;
  constexpr double kAccuracy = 0.001;  // pixels
  for (double next = scale;; next = std::min(1.0, 2 * next)) {
    enlarge(at, next / scale);
    scale = next;
    double step = kSmallWidth;
    for (std::size_t i = 1; i < at.size(); ++i)
      if (i % static_cast<std::size_t>(size.width) != 0)
        step = std::min(step, cv::norm(at[i] - at[i - 1]));
    const int window = std::clamp(static_cast<int>(step / 2) - 1, kLeastWindow, kWindow);
    cv::cornerSubPix(resized(gray, scale), at, {window, window}, {-1, -1},
                     {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, kIterations, kAccuracy});
    if (scale >= 1) return;
  }
}

}  // namespace

SeenChessboard largest_chessboard(const cv::Mat& gray) {
  constexpr int kLeast = 3;
  SeenChessboard out;
  cv::Mat cells;
  if (!cv::findChessboardCornersSB(gray, {kLeast, kLeast}, out.at,
                                   cv::CALIB_CB_LARGER | cv::CALIB_CB_NORMALIZE_IMAGE, cells) ||
      cells.total() != out.at.size())
    return {};
  // With CALIB_CB_LARGER, corners come in a mirrored order.
  Grid grid = unmirrored({cells.size(), std::move(out.at)});
  return {grid.size, grid.at, is_whole(grid, gray.size())};
}

ChessboardCorners find_chessboard(const cv::Mat& gray, cv::Size size, bool quickly,
                                  std::atomic<int>& slow_searches) {
  double scale = std::min(1.0, static_cast<double>(kSmallWidth) / gray.cols);
  const cv::Mat small = resized(gray, scale);
  ChessboardCorners out;
  out.at = corners_of_size(small, size, kFast);
  SeenChessboard seen;
  if (out.at.empty() || !quickly) seen = largest_chessboard(small);
  if (out.at.empty()) out.at = sharp_of_size(small, seen, size);
  // A slow search for squares in place of corners finds nothing. A larger board may have a row too
  // many: edges around a board look like corners at times.
  const cv::Size squares = seen.size + cv::Size(1, 1);
  const bool counted = squares == size || squares == cv::Size(size.height, size.width);
  const bool other =
      seen.whole && (counted || (!is_part(seen.size, size) && !is_part(size, seen.size)));
  if (other && !quickly) out.at.clear();
  if (out.at.empty() && !quickly && !other && slow_searches > 0) {
    out.at = corners_of_size(small, size, kSlow);
    if (out.at.empty()) --slow_searches;
  }
  if (out.at.empty() && !quickly && !other && scale < 1) {
    scale = 1;
    seen = largest_chessboard(gray);
    out.at = sharp_of_size(gray, seen, size);
  }
  if (seen.whole) out.seen = seen.size;
  if (!out.at.empty()) refine(gray, size, scale, out.at);
  return out;
}

}  // namespace hypotrack::calibrate
