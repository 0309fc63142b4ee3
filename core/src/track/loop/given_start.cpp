#include "track/loop/given_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "track/sighting.hpp"

namespace hypotrack::internal {

GivenStart::GivenStart(const Scene& scene, Eigen::VectorXd state, bool is_given)
    : scene_(scene),
      state_(std::move(state)),
      expected_(scene.items().size(), is_given),
      noted_(scene.items().size(), false),
      doubts_(scene.items().size()) {
  scene.normalize(state_);
}

bool GivenStart::expects_any() const {
  return std::ranges::find(expected_, true) != expected_.end();
}

bool GivenStart::is_early() const {
  constexpr int kEarly = 3;
  return searches_ < kEarly;
}

double GivenStart::distance(std::size_t model, const Eigen::VectorXd& state) const {
  const Scene::Item& item = scene_.items()[model];
  return landmark_distance(*item.model, scene_.part(item, state_), scene_.part(item, state));
}

bool GivenStart::is_left(std::size_t model, const Eigen::VectorXd& found) const {
  constexpr double kNear = 0.015;  // metres: searches from the right posture seldom move farther
  return distance(model, found) > kNear;
}

double GivenStart::doubted(double probability) {
  constexpr double kOdds = 30;  // by which they fall
  return probability / (probability + kOdds * (1 - probability));
}

void GivenStart::contradict(std::size_t model, const std::string& why) {
  expected_[model] = false;
  doubt(model, why);
}

void GivenStart::conclude(int frame, std::size_t model, const Eigen::VectorXd& state,
                          bool is_found) {
  const std::string why = std::exchange(doubts_[model], {});
  if (why.empty() || noted_[model]) return;
  std::string result = "it is looked for in the pictures";
  if (is_found) {
    const double away = distance(model, state);
    if (away < kElsewhere) return;  // as far off as starts that people set
    result = fmt::format("it was found {:.0f} mm away (mean over the landmarks)", 1000 * away);
  }
  noted_[model] = true;
  notes_.push_back(fmt::format(
      "frame {}: the start (init) {} where '{}' is: {}; {}. Is the start of another "
      "frame or recording?",
      frame, is_found ? "is not" : "may not be", scene_.items()[model].name, why, result));
}

std::vector<std::string> GivenStart::take_notes() { return std::exchange(notes_, {}); }

}  // namespace hypotrack::internal
