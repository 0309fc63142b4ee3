#include "track/given_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "track/sighting.hpp"

namespace hypotrack::internal {

GivenStart::GivenStart(const Scene& scene, Eigen::VectorXd state, bool is_given)
    : scene_(scene),
      state_(std::move(state)),
      expected_(scene.items().size(), is_given),
      noted_(scene.items().size(), false) {
  scene.normalize(state_);
}

bool GivenStart::expects_any() const {
  return std::ranges::find(expected_, true) != expected_.end();
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

void GivenStart::contradict(int frame, std::size_t model, const std::string& why) {
  expected_[model] = false;
  note(frame, model, why + "; it is looked for in the pictures");
}

void GivenStart::note(int frame, std::size_t model, const std::string& what) {
  if (noted_[model]) return;
  noted_[model] = true;
  notes_.push_back(fmt::format(
      "frame {}: the start (init) is not where '{}' is: {}. Is the start of another frame or "
      "recording?",
      frame, scene_.items()[model].name, what));
}

std::vector<std::string> GivenStart::take_notes() { return std::exchange(notes_, {}); }

}  // namespace hypotrack::internal
