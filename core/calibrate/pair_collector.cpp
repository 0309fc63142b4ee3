#include "calibrate/pair_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibrate/board/wrong_board.hpp"

namespace hypotrack::calibrate {
namespace {

/// Returns the side of a picture that a board nearly touches; empty if none.
std::string near_side(const BoardCorners& corners, cv::Size picture) {
  constexpr float kGap = 0.12f;  // of the picture
  const cv::Rect box = cv::boundingRect(corners.at);
  const auto width = static_cast<float>(picture.width);
  const auto height = static_cast<float>(picture.height);
  const std::array<std::pair<const char*, float>, 4> gaps = {
      {{"left", static_cast<float>(box.x) / width},
       {"right", (width - static_cast<float>(box.br().x)) / width},
       {"top", static_cast<float>(box.y) / height},
       {"bottom", (height - static_cast<float>(box.br().y)) / height}}};
  const auto nearest = std::ranges::min_element(gaps, {}, &decltype(gaps)::value_type::second);
  return nearest->second < kGap ? nearest->first : "";
}

constexpr int kLeastCommon = 6;  // corners, as a calibration needs of a pair

/// Returns how far corners moved at most; infinite if too few of them are the same ones.
double largest_move(const BoardCorners& from, const BoardCorners& to) {
  double out = 0;
  int same = 0;
  for (std::size_t i = 0; i < to.ids.size(); ++i) {
    const auto at = std::ranges::find(from.ids, to.ids[i]) - from.ids.begin();
    if (at == std::ssize(from.ids)) continue;
    out = std::max(out, cv::norm(to.at[i] - from.at[static_cast<std::size_t>(at)]));
    ++same;
  }
  return same < kLeastCommon ? std::numeric_limits<double>::infinity() : out;
}

}  // namespace

PairCollector::PairCollector(const BoardFinder& finder, cv::Size picture)
    : finder_(&finder), picture_(picture) {}

std::string PairCollector::why_missing(std::size_t view, double time,
                                       const cv::Mat& picture) const {
  constexpr double kRecent = 1.5;  // seconds
  std::string why = why_no_board(*finder_, picture);
  if (!why.ends_with("seen") || !last_[view] || time - last_[view]->time > kRecent) return why;
  const std::string side = near_side(last_[view]->corners, picture_);
  return side.empty() ? why : fmt::format("the board is cut at the {} edge", side);
}

void PairCollector::find(std::size_t view, double time, const cv::Mat& picture, BoardPair& pair,
                         std::string& problem) {
  const double blurred = 0.01 * picture.cols;  // pixels
  BoardCorners& found = pair.corners[view];
  found = finder_->find_quickly(picture);
  if (found.ids.empty() || !rough_pose(*finder_, found, picture_)) {
    problem = other_size(finder_->board(), found.seen);
    if (problem.empty()) problem = why_missing(view, time, picture);
    return;
  }
  if (finder_->edge_width(picture, found) > blurred) problem = "the board is blurred";
  last_[view] = {found, time};
}

bool PairCollector::holds_still(double time, BoardPair pair) {
  constexpr double kSeconds = 0.4;
  constexpr int kLooks = 4;
  const double most = 0.003 * picture_.width;  // pixels
  for (std::size_t view = 0; view < 2 && still_ && finder_->whole_only(); ++view)
    number_alike(still_->corners[view], pair.corners[view], finder_->board().size);
  const bool moved = !still_ || std::max(largest_move(still_->corners[0], pair.corners[0]),
                                         largest_move(still_->corners[1], pair.corners[1])) > most;
  if (moved) {
    still_ = std::move(pair);
    still_since_ = time;
    still_looks_ = 0;
  }
  return ++still_looks_ >= kLooks && time - still_since_ >= kSeconds;
}

PairLook PairCollector::look(double time, const cv::Mat& left, const cv::Mat& right) {
  PairLook out;
  BoardPair pair;
  auto second =
      std::async(std::launch::async, [&] { find(1, time, right, pair, out.problems[1]); });
  find(0, time, left, pair, out.problems[0]);
  second.get();
  if (out.problems[0].empty() && out.problems[1].empty() &&
      std::isinf(largest_move(pair.corners[0], pair.corners[1])))
    out.problems.fill("the other picture shows another part of the board");
  if (!out.problems[0].empty() || !out.problems[1].empty()) {
    still_.reset();
    return out;
  }
  if (finder_->whole_only()) number_alike(pair.corners[0], pair.corners[1], finder_->board().size);
  out.board = PairLook::Board::moving;
  if (!holds_still(time, pair)) return out;
  const RoughPose pose = *rough_pose(*finder_, pair.corners[0], picture_);
  const auto same = [&](const RoughPose& taken) { return difference(pose, taken) < 1; };
  out.board = PairLook::Board::known;
  if (std::ranges::any_of(poses_, same)) return out;
  out.board = PairLook::Board::taken;
  pair.corners[0].seen = finder_->find(left).seen;
  pairs_.push_back(std::move(pair));
  poses_.push_back(pose);
  return out;
}

}  // namespace hypotrack::calibrate
