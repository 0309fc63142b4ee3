#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "calibrate/check/faults.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

double typical_distance(const std::vector<CommonCorners>& views,
                        const std::array<Lens, 2>& lenses) {
  return upper_median(common_pose(views, lenses).distances);
}

/// How pictures may be turned over: both is upside down.
struct Flip {
  bool sideways = false, upright = false;
};

/// Returns pairs with the right pictures flipped. Only whole boards stay.
std::vector<CommonCorners> flipped(const PairedViews& paired, Flip flip) {
  const cv::Size size = paired.board->board().size;
  std::vector<CommonCorners> out;
  for (const CommonCorners& view : paired.views) {
    if (view.at[1].size() != static_cast<std::size_t>(size.area())) continue;
    CommonCorners one = view;
    for (int i = 0; i < size.area(); ++i) {
      const int row = i / size.width, column = i % size.width;
      const int from = (flip.upright ? size.height - 1 - row : row) * size.width +
                       (flip.sideways ? size.width - 1 - column : column);
      cv::Point2f at = view.at[1][static_cast<std::size_t>(from)];
      if (flip.sideways) at.x = static_cast<float>(paired.pictures.width - 1) - at.x;
      if (flip.upright) at.y = static_cast<float>(paired.pictures.height - 1) - at.y;
      one.at[1][static_cast<std::size_t>(i)] = at;
    }
    out.push_back(std::move(one));
  }
  return out;
}

/// Returns the lens that takes flipped pictures.
Lens flipped(const Lens& lens, cv::Size pictures, Flip flip) {
  constexpr int kTangential = 2;  // index of the coefficient of y, before that of x
  Lens out{lens.matrix.clone(), lens.distortion.clone()};
  const std::array<bool, 2> flips = {flip.sideways, flip.upright};
  for (int axis = 0; axis < 2; ++axis) {
    if (!flips[static_cast<std::size_t>(axis)]) continue;
    double& centre = out.matrix.at<double>(axis, 2);
    centre = (axis == 0 ? pictures.width : pictures.height) - 1 - centre;
    if (out.distortion.total() > 3) out.distortion.at<double>(kTangential + 1 - axis) *= -1;
  }
  return out;
}

/// Returns how the pictures of one camera are flipped; empty if they are not.
std::string flip_of(const PairedViews& paired) {
  constexpr std::array<std::pair<Flip, const char*>, 3> kFlips = {
      {{{true, false}, "mirrored, left and right"},
       {{false, true}, "mirrored, top and bottom"},
       {{true, true}, "upside down"}}};
  if (!paired.board->whole_only()) return {};  // numbers of markers tell it, or none is found
  for (const auto& [flip, name] : kFlips) {
    const std::vector<CommonCorners> views = flipped(paired, flip);
    std::array<Lens, 2> lenses = paired.lenses;
    if (!paired.lenses_given) lenses[1] = flipped(lenses[1], paired.pictures, flip);
    if (2 * views.size() > paired.views.size() && typical_distance(views, lenses) < kMismatch)
      return name;
  }
  return {};
}

/// Finds which right picture belongs to which left one.
class Matching {
 public:
  explicit Matching(const PairedViews& paired) : paired_(paired) {
    constexpr std::size_t kMost = 24;  // pictures of a side: the time grows with the cube
    const std::vector<BoardPair>& pairs = *paired.pairs;
    count_ = std::min(kMost, pairs.size());
    for (std::size_t left = 0; left < count_; ++left)
      for (std::size_t right = 0; right < count_; ++right) {
        BoardPair pair{"", {pairs[left].corners[0], pairs[right].corners[1]}};
        if (paired.board->whole_only())
          number_alike(pair.corners[0], pair.corners[1], paired.board->board().size);
        views_.push_back(common_corners(*paired.board, {std::move(pair)}));
        if (!views_.back().empty())
          left_.push_back(pose_of(views_.back()[0], 0, paired.lenses[0]));
        else
          left_.emplace_back();
      }
  }

  /// Returns the right picture of each left one, by index; -1: none. Nothing if few have one.
  std::optional<std::vector<int>> found() const {
    constexpr std::size_t kReferences = 3;  // left pictures, one of which has its right one
    constexpr double kMost = 0.7;
    for (std::size_t left = 0; left < std::min(kReferences, count_); ++left)
      for (std::size_t right = 0; right < count_; ++right) {
        std::vector<int> matches = matches_of(left, right);
        const auto alone = std::ranges::count(matches, -1);
        if (static_cast<double>(alone) <= (1 - kMost) * static_cast<double>(count_) &&
            std::ssize(matches) - alone >= 3)
          return matches;
      }
    return std::nullopt;
  }

 private:
  std::vector<int> matches_of(std::size_t left, std::size_t right) const {
    std::vector<int> out(count_, -1);
    const std::size_t reference = left * count_ + right;
    if (views_[reference].empty()) return out;
    const cv::Affine3d right_from_left =
        pose_of(views_[reference][0], 1, paired_.lenses[1]) * left_[reference].inv();
    for (std::size_t i = 0; i < count_; ++i) {
      double best = kMismatch;
      for (std::size_t j = 0; j < count_; ++j) {
        const std::size_t at = i * count_ + j;
        if (views_[at].empty()) continue;
        const double distance =
            distance_of(views_[at][0], 1, paired_.lenses[1], right_from_left * left_[at]);
        if (distance >= best) continue;
        best = distance;
        out[i] = static_cast<int>(j);
      }
    }
    return out;
  }

  const PairedViews& paired_;
  std::size_t count_ = 0;
  std::vector<std::vector<CommonCorners>> views_;  ///< by left and right picture; one or none
  std::vector<cv::Affine3d> left_;                 ///< poses of `views_` before the left camera
};

/// Returns in which other order pictures belong together; empty if that is not known. Of cameras
/// that are not synchronous, some pictures of a slow board fit their neighbours better.
std::string other_order(const PairedViews& paired) {
  const std::optional<std::vector<int>> matches = Matching(paired).found();
  if (!matches) return {};
  int kept = 0, moved = 0;
  for (std::size_t i = 0; i < matches->size(); ++i)
    if ((*matches)[i] >= 0) ++((*matches)[i] == static_cast<int>(i) ? kept : moved);
  for (std::size_t i = 0; i < matches->size() && moved >= kept; ++i) {
    const int match = (*matches)[i];
    if (match >= 0 && match != static_cast<int>(i))
      return fmt::format(
          "the left picture of the pair {} fits the right picture of the pair {}: are pictures "
          "missing, or sorted in another order by their names?",
          (*paired.pairs)[i].name, (*paired.pairs)[static_cast<std::size_t>(match)].name);
  }
  return {};
}

}  // namespace

void expect_cameras(const std::array<Camera, 2>& cameras) {
  for (std::size_t i = 0; i < 2; ++i) {
    try {
      validate(cameras[i], "");
    } catch (const DataError&) {
      throw DataError(fmt::format(
          "these pairs do not tell the cameras: to the {} one, a lens fits best that cannot be. "
          "Is --board as printed, are both pictures of a pair taken at the same moment, and is the "
          "board tilted by 20 to 45 degrees in several directions?",
          i == 0 ? "left" : "right"));
    }
  }
}

void expect_pairs(const PairedViews& paired) {
  constexpr double kHopeless = 0.04;  // of a picture's width
  const double distance = typical_distance(paired.views, paired.lenses);
  if (!(distance < kMismatch)) {
    expect_cameras({camera_of(paired.lenses[0], paired.pictures),
                    camera_of(paired.lenses[1], paired.pictures)});
    if (const std::string how = flip_of(paired); !how.empty())
      throw DataError(
          fmt::format("the pictures of one camera are {}, those of the other are not: turn them, "
                      "or what turns them, and calibrate again",
                      how));
    if (const std::string order = other_order(paired); !order.empty()) throw DataError(order);
  }
  if (distance < kHopeless * paired.pictures.width) return;
  throw DataError(
      fmt::format("the pairs contradict each other: corners are {:.0f} px from where most pairs "
                  "expect them. Are both pictures of a pair taken at the same moment, in the same "
                  "order, and are the cameras fixed to each other?",
                  distance));
}

bool fits_exchanged(CommonCorners view, const std::array<Lens, 2>& lenses,
                    const cv::Affine3d& right_from_left) {
  std::swap(view.at[0], view.at[1]);
  return distance_of(view, 1, lenses[1], right_from_left * pose_of(view, 0, lenses[0])) < kMismatch;
}

}  // namespace hypotrack::calibrate
