#include "live_pairs/take_pairs.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "hypotrack/api/error.hpp"
#include "live_pairs/status_line.hpp"
#include "messages.hpp"

namespace hypotrack::app {
namespace {

/// Tells whether the user pressed Enter, without waiting. A program in the background never reads.
class EnterKey {
 public:
  bool pressed();

 private:
  bool ended_ = false;  ///< standard input
};

bool EnterKey::pressed() {
  if (isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) != getpgrp()) return false;
  for (pollfd input{STDIN_FILENO, POLLIN, 0}; !ended_ && poll(&input, 1, 0) > 0;) {
    std::array<char, 256> text{};
    const ssize_t size = read(STDIN_FILENO, text.data(), text.size());
    ended_ = size <= 0;
    if (std::ranges::count(text, '\n') > 0) return true;
  }
  return false;
}

using calibrate::PairLook;

constexpr std::size_t kLeastPairs = 3;  // that can be calibrated
constexpr std::size_t kMostPairs = 30;  // more do not help

std::size_t percent(double share) { return static_cast<std::size_t>(std::lround(100 * share)); }

/// Takes pairs and talks to the user.
class Taking {
 public:
  Taking(const calibrate::BoardFinder& finder, cv::Size picture, PairFolder& folder)
      : collector_(finder, picture), folder_(folder), coverage_(collector_.coverage()) {
    status_.say(
        "Show the board to both cameras and hold it still; pairs are taken by themselves. Enter: "
        "calibrate with the pairs so far, Ctrl-C: end. Left and right are those of the pictures: "
        "facing the cameras, your right and left.");
  }

  std::vector<calibrate::BoardPair> named_pairs() const {
    std::vector<calibrate::BoardPair> out = pairs();
    for (std::size_t i = 0; i < out.size(); ++i) out[i].name = names_[i];
    return out;
  }
  const std::vector<calibrate::BoardPair>& pairs() const { return collector_.pairs(); }
  /// Returns what was seen last.
  const std::string& seen() const { return seen_; }
  bool enough() const { return coverage_.wanted.empty() || pairs().size() >= kMostPairs; }

  void show_problem(const std::string& problem) {
    seen_ = problem;
    status_.show(problem);
  }

  void look(const Frame& frame) {
    const cv::Mat &left = frame.views[0].color, &right = frame.views[1].color;
    const PairLook look = collector_.look(frame.time, left, right);
    if (look.board == PairLook::Board::taken) return keep(frame, left, right);
    seen_ = words(look);
    status_.show(fmt::format("{} taken; {}; next: {}", pairs().size(), seen_, wanted(frame)));
  }

  void too_few() {
    status_.say(
        fmt::format("{} pairs; a calibration needs {} at least", pairs().size(), kLeastPairs));
  }

 private:
  void keep(const Frame& frame, const cv::Mat& left, const cv::Mat& right) {
    names_.push_back(folder_.write(left, right));
    coverage_ = collector_.coverage();
    taken_at_ = frame.time;
    seen_ = "the board is seen in both pictures";
    status_.say(
        fmt::format(
            "pair {} taken ({}): {} % of the left and {} % of the right picture are covered, "
            "{} of {} tilts",
            pairs().size(), names_.back(), percent(coverage_.pictures[0].share),
            percent(coverage_.pictures[1].share), coverage_.tilts, calibrate::PoseCoverage::kTilts),
        true);
  }

  static std::string words(const PairLook& look) {
    if (look.board == PairLook::Board::moving) return "hold still";
    if (look.board == PairLook::Board::known) return "taken before: move on";
    const auto& [left, right] = look.problems;
    if (left == right) return "both pictures: " + left;
    const auto of = [](const char* view, const std::string& problem) {
      return fmt::format("{}: {}", view, problem.empty() ? "the board is seen" : problem);
    };
    return of("left", left) + ", " + of("right", right);
  }

  /// Returns one wish after the other, so that one that cannot be met does not stay.
  const std::string& wanted(const Frame& frame) const {
    constexpr double kSeconds = 8;
    const auto turn = static_cast<std::size_t>((frame.time - taken_at_) / kSeconds);
    return coverage_.wanted[turn % coverage_.wanted.size()];
  }

  calibrate::PairCollector collector_;
  PairFolder& folder_;
  StatusLine status_;
  calibrate::PoseCoverage coverage_;
  std::vector<std::string> names_;  ///< of the left pictures
  double taken_at_ = 0;
  std::string seen_ = "nothing yet";
};

/// Takes pairs until one of the ends. Returns whether it was Ctrl-C.
bool take_all(Taking& taking, Source& source, const std::optional<double>& seconds,
              const InterruptGuard& interrupt) {
  EnterKey enter;
  while (!taking.enough()) {
    const std::optional<Frame> frame = source.next();
    if (!frame || interrupt.interrupted()) return interrupt.interrupted();
    if (frame->problem.empty())
      taking.look(*frame);
    else
      taking.show_problem(frame->problem);
    if (seconds && frame->time >= *seconds) return false;
    if (!enter.pressed()) continue;
    if (taking.pairs().size() >= kLeastPairs) return false;
    taking.too_few();
  }
  return false;
}

}  // namespace

TakenPairs take_pairs(const calibrate::BoardFinder& finder, Source& source, PairFolder& folder,
                      const std::optional<double>& seconds, const InterruptGuard& interrupt) {
  const Camera& camera = source.cameras()[0];
  TakenPairs out;
  out.picture = {camera.width, camera.height};
  Taking taking(finder, out.picture, folder);
  const auto too_few = [&] { return taking.pairs().size() < kLeastPairs; };
  try {
    out.interrupted = take_all(taking, source, seconds, interrupt);
  } catch (const DataError&) {  // the cameras are gone
    if (too_few()) folder.discard();
    throw;
  }
  out.pairs = taking.named_pairs();
  if (!too_few()) return out;
  folder.discard();
  if (!out.interrupted)
    throw DataError(fmt::format(
        "{} pairs were taken; a calibration needs {} at least, 15 are usual. Seen last: {}",
        out.pairs.size(), kLeastPairs, taking.seen()));
  return out;
}

}  // namespace hypotrack::app
