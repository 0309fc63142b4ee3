#include "motion/motion.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::synthetic {
namespace {

/// Returns the slope at a key, from the lengths and secant slopes of the segments before and after
/// it: the weighted harmonic mean, or 0 if they differ in sign.
double monotone_slope(double length_0, double secant_0, double length_1, double secant_1) {
  if (secant_0 * secant_1 <= 0) return 0;
  const double w0 = 2 * length_1 + length_0, w1 = length_1 + 2 * length_0;
  return (w0 + w1) / (w0 / secant_0 + w1 / secant_1);
}

/// Returns the index of the key at or before a time, which must lie between the first and the last
/// key.
std::size_t segment_of(const std::vector<double>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end() - 1, time);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - times.begin() - 1));
}

Eigen::Quaterniond exp(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

Eigen::Vector3d log(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd rotation(q);
  return rotation.angle() * rotation.axis();
}

}  // namespace

void NumberTrack::add(double time, double value) {
  times_.push_back(time);
  values_.push_back(value);
}

double NumberTrack::at(double time) const {
  if (time <= times_.front()) return values_.front();
  if (time >= times_.back()) return values_.back();
  const std::size_t i = segment_of(times_, time);
  const auto length = [&](std::size_t k) { return times_[k + 1] - times_[k]; };
  const auto secant = [&](std::size_t k) { return (values_[k + 1] - values_[k]) / length(k); };
  const auto slope = [&](std::size_t key) {
    if (key == 0 || key + 1 == times_.size()) return 0.0;
    return monotone_slope(length(key - 1), secant(key - 1), length(key), secant(key));
  };
  const double h = length(i), s = (time - times_[i]) / h, r = 1 - s;
  return values_[i] * r * r * (1 + 2 * s) + values_[i + 1] * s * s * (1 + 2 * r) +
         h * s * r * (slope(i) * r - slope(i + 1) * s);
}

void RotationTrack::add(double time, Eigen::Quaterniond rotation) {
  if (!rotations_.empty() && rotations_.back().dot(rotation) < 0) rotation.coeffs() *= -1;
  times_.push_back(time);
  rotations_.push_back(rotation);
}

Eigen::Vector3d RotationTrack::velocity_at_key(std::size_t key) const {
  if (key == 0 || key + 1 == times_.size()) return Eigen::Vector3d::Zero();
  // The rotation vector from key to key is the same in both keys' body frames.
  const double before = times_[key] - times_[key - 1], after = times_[key + 1] - times_[key];
  const Eigen::Vector3d v0 = log(rotations_[key - 1].conjugate() * rotations_[key]) / before;
  const Eigen::Vector3d v1 = log(rotations_[key].conjugate() * rotations_[key + 1]) / after;
  Eigen::Vector3d velocity;
  for (int axis = 0; axis < 3; ++axis) {
    velocity[axis] = monotone_slope(before, v0[axis], after, v1[axis]);
  }
  return velocity;
}

Eigen::Quaterniond RotationTrack::at(double time) const {
  if (time <= times_.front()) return rotations_.front();
  if (time >= times_.back()) return rotations_.back();
  const std::size_t i = segment_of(times_, time);
  const double h = times_[i + 1] - times_[i], s = (time - times_[i]) / h;
  const Eigen::Quaterniond &first = rotations_[i], &second = rotations_[i + 1];
  const Eigen::Vector3d a = velocity_at_key(i) * h / 3, c = velocity_at_key(i + 1) * h / 3;
  const Eigen::Vector3d b = log(exp(-a) * first.conjugate() * second * exp(-c));
  const double r = 1 - s;  // for the cumulative cubic Bernstein polynomials below
  Eigen::Quaterniond q =
      first * exp((1 - r * r * r) * a) * exp((3 - 2 * s) * s * s * b) * exp(s * s * s * c);
  q.normalize();
  if (q.dot(first) < 0) q.coeffs() *= -1;
  return q;
}

Motion::Motion(const Scene& scene)
    : rest_(scene.rest_state()), numbers_(static_cast<std::size_t>(scene.dimension())) {
  for (const Scene::Item& item : scene.items()) ways_.push_back({item.offset, {Path{}}, {}});
}

NumberTrack& Motion::number(int parameter) {
  for (Way& way : ways_) {
    const int axis = parameter - way.offset;
    if (axis >= 0 && axis < 3) return way.paths.back().position[static_cast<std::size_t>(axis)];
  }
  return numbers_.at(static_cast<std::size_t>(parameter));
}

void Motion::add_number(int parameter, double time, double value) {
  number(parameter).add(time, value);
}

void Motion::add_rotation(std::size_t model, double time, const Eigen::Quaterniond& rotation) {
  ways_.at(model).paths.back().rotation.add(time, rotation);
}

void Motion::add_hold(std::size_t held, std::size_t holder, double from, double to) {
  Way& way = ways_.at(held);
  const Placement at_start = placement(way, from);
  const Placement by = placement(ways_.at(holder), from);
  way.holds.push_back({holder,
                       from,
                       to,
                       {by.rotation.conjugate() * (at_start.position - by.position),
                        by.rotation.conjugate() * at_start.rotation}});
  way.paths.emplace_back();
  if (!std::isfinite(to)) return;
  const Placement left = placement(way, std::nextafter(to, from));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way.paths.back().position[axis].add(to, left.position[static_cast<Eigen::Index>(axis)]);
  }
  way.paths.back().rotation.add(to, left.rotation);
}

bool Motion::has_number(int parameter) const {
  for (const Way& way : ways_) {
    const int axis = parameter - way.offset;
    if (axis >= 0 && axis < 3) {
      return !way.paths.front().position[static_cast<std::size_t>(axis)].empty();
    }
  }
  return !numbers_.at(static_cast<std::size_t>(parameter)).empty();
}

Placement Motion::on_path(const Way& way, std::size_t index, double time) const {
  const Path& path = way.paths[index];
  Placement out{rest_.segment<3>(way.offset),
                Eigen::Quaterniond(rest_[way.offset + 3], rest_[way.offset + 4],
                                   rest_[way.offset + 5], rest_[way.offset + 6])};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const NumberTrack& track = path.position[axis];
    if (!track.empty()) out.position[static_cast<Eigen::Index>(axis)] = track.at(time);
  }
  if (!path.rotation.empty()) out.rotation = path.rotation.at(time);
  return out;
}

Placement Motion::placement(const Way& way, double time) const {
  std::size_t begun = 0;
  while (begun < way.holds.size() && way.holds[begun].from <= time) ++begun;
  if (begun == 0 || time >= way.holds[begun - 1].to) return on_path(way, begun, time);
  const Hold& hold = way.holds[begun - 1];
  const Placement by = placement(ways_[hold.holder], time);
  return {by.position + by.rotation * hold.holder_from_held.position,
          by.rotation * hold.holder_from_held.rotation};
}

Eigen::VectorXd Motion::state(double time) const {
  Eigen::VectorXd state = rest_;
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const NumberTrack& track = numbers_[static_cast<std::size_t>(i)];
    if (!track.empty()) state[i] = track.at(time);
  }
  for (const Way& way : ways_) {
    const Placement now = placement(way, time);
    const Eigen::Quaterniond& q = now.rotation;
    state.segment<7>(way.offset) << now.position, q.w(), q.x(), q.y(), q.z();
  }
  return state;
}

}  // namespace hypotrack::synthetic
