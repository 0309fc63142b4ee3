#include "track/recover/pose_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kPosePadding = 0.5;  // of a hypothesis, around it
constexpr int kFiner = 2;             // pixels of the fine tile per pixel of the coarse one
constexpr int kFineIterations = 6;
constexpr std::size_t kImproved = 16;     // most poses that are improved limb by limb
constexpr std::size_t kFineImproved = 4;  // most that are improved limb by limb there
constexpr double kApart = 0.006;          // metres between those, mean over the landmarks

/// Steps of least squares that poses take before only a share of them goes on, but no fewer than
/// are kept.
struct Round {
  int iterations;
  double share;
};
constexpr std::array kRounds{Round{1, 1.0 / 2}, Round{1, 1.0 / 2}, Round{2, 1.0 / 3}, Round{2, 1}};

void sort_by_cost(std::vector<Refined>& poses) {
  std::ranges::stable_sort(poses, {}, &Refined::cost);
}

/// Returns the `count` cheapest of states (DxN), without infeasible ones.
std::vector<Refined> cheapest(Cost& cost, const Eigen::MatrixXd& states, std::size_t count) {
  Eigen::VectorXd costs(states.cols());
  cost.evaluate(states, costs);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(states.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return costs[i]; });
  order.resize(std::min(order.size(), count));
  std::vector<Refined> out;
  for (const Eigen::Index i : order)
    if (std::isfinite(costs[i])) out.push_back({states.col(i), costs[i]});
  return out;
}

/// Sets the costs of poses in the prepared frame.
void evaluate(Cost& cost, std::vector<Refined>& poses) {
  Eigen::MatrixXd states(poses.front().state.size(), std::ssize(poses));
  for (std::size_t i = 0; i < poses.size(); ++i)
    states.col(static_cast<Eigen::Index>(i)) = poses[i].state;
  Eigen::VectorXd costs(states.cols());
  cost.evaluate(states, costs);
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].cost = costs[static_cast<Eigen::Index>(i)];
}

/// Returns a uniformly distributed rotation (Shoemake, "Uniform random rotations", 1992).
Eigen::Quaterniond any_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
  return Eigen::Quaterniond(q.normalized());
}

Eigen::Quaterniond turned(const Eigen::Quaterniond& rotation, double sigma,
                          std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, sigma);
  return rotation * rotation_exp({normal(random), normal(random), normal(random)});
}

}  // namespace

void leave_distinct(const Scene& scene, double near, std::size_t count,
                    std::vector<Refined>& poses) {
  sort_by_cost(poses);
  std::vector<Refined> out;
  std::vector<Eigen::Matrix3Xd> landmarks;
  for (Refined& one : poses) {
    if (out.size() >= count) break;
    const Eigen::Matrix3Xd here = scene.landmarks(one.state);
    const bool known = std::ranges::any_of(landmarks, [&](const Eigen::Matrix3Xd& other) {
      return (here - other).colwise().norm().mean() < near;
    });
    if (known) continue;
    landmarks.push_back(here);
    out.push_back(std::move(one));
  }
  poses = std::move(out);
}

PoseSearch::PoseSearch(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras,
                       const RecoverySettings& settings)
    : scene_(scene),
      item_(scene.items()[model]),
      model_(model),
      single_(std::vector{std::pair{item_.name, item_.model}}),
      coarse_(single_, cameras, {settings.tile, kPosePadding}),
      fine_(single_, cameras, {kFiner * settings.tile, kPosePadding}),
      postures_(item_.model->data()),
      behind_(cameras[0].camera_from_world.inverse() * Eigen::Vector3d(0, 0, -10)) {
  const Eigen::Matrix3Xd vertices = item_.model->data().mesh.vertices.cast<double>();
  const Eigen::Vector3d mean = vertices.rowwise().mean();
  radius_ = std::sqrt((vertices.colwise() - mean).colwise().squaredNorm().mean());
}

Eigen::Vector3d PoseSearch::center(const Eigen::VectorXd& state) const {
  const std::span<const double> own = scene_.part(item_, state);
  return posed_landmarks(*item_.model, own).rowwise().mean();
}

Eigen::VectorXd PoseSearch::without(const Eigen::VectorXd& base,
                                    const std::vector<bool>& hidden) const {
  Eigen::VectorXd out = base;
  for (std::size_t m = 0; m < hidden.size(); ++m)
    if (hidden[m] || m == model_) out.segment<3>(scene_.items()[m].offset) = behind_;
  return out;
}

Eigen::MatrixXd PoseSearch::hypotheses(const PoseGuess& guess, int count,
                                       std::mt19937_64& random) const {
  const Eigen::Index dimension = item_.model->dimension();
  Eigen::MatrixXd out(dimension, count);
  const Eigen::VectorXd& last = guess.pose;
  const Eigen::Quaterniond last_rotation(last[3], last[4], last[5], last[6]);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> scatter(0, guess.scatter);
  const auto& postures = postures_.all();
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    const bool near = uniform(random) < guess.near_share;
    const Eigen::Quaterniond q =
        near ? turned(last_rotation, guess.rotation, random) : any_rotation(random);
    Eigen::VectorXd one(dimension);
    one.head<kPoseSize>() << 0, 0, 0, q.w(), q.x(), q.y(), q.z();
    const bool keeps = uniform(random) < (near ? 0.6 : 0.2);
    const auto k = static_cast<std::size_t>(uniform(random) * static_cast<double>(postures.size()));
    one.tail(dimension - kPoseSize) = keeps ? Eigen::VectorXd(last.tail(dimension - kPoseSize))
                                            : postures[std::min(k, postures.size() - 1)];
    const Eigen::Vector3d at =
        posed_landmarks(*item_.model, {one.data(), static_cast<std::size_t>(dimension)})
            .rowwise()
            .mean();
    one.head<3>() =
        guess.center - at + Eigen::Vector3d(scatter(random), scatter(random), 2 * scatter(random));
    out.col(i) = one;
  }
  return out;
}

void PoseSearch::take_in(FrameSearch& search, const TileMaker& tiles, const Frame& frame,
                         const Eigen::VectorXd& base, const Eigen::VectorXd& hypothesis) const {
  TilePlan plan = tiles.plan(frame, hypothesis);
  plan.header.scene = &scene_;
  plan.header.start = base;
  // Expect every moving model here, so that the tile's depths are those of the place.
  for (const Scene::Item& item : scene_.items())
    plan.header.start.segment<3>(item.offset) = hypothesis.head<3>();
  plan.header.start.segment(item_.offset, hypothesis.size()) = hypothesis;
  plan.header.context.no_motion_prior = true;
  search.take_in(tiles, frame, std::move(plan));
}

FoundPoses PoseSearch::find(FrameSearch& search, const Frame& frame, const Eigen::VectorXd& base,
                            const std::vector<bool>& hidden, const std::vector<HeldModel>& held,
                            const PoseGuess& guess, const HypothesisCounts& counts,
                            std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Eigen::MatrixXd own = hypotheses(guess, counts.hypotheses, random);
  Eigen::VectorXd first = own.col(0);
  if (guess.centred)
    first.head<3>() +=
        guess.center -
        posed_landmarks(*item_.model, {first.data(), static_cast<std::size_t>(first.size())})
            .rowwise()
            .mean();
  if (coarse_.visible_share(first) == 0) return {};
  take_in(search, coarse_, frame, base, first);
  Cost& cost = search.cost();
  const Eigen::VectorXd others = without(base, hidden);
  Eigen::MatrixXd states(base.size(), own.cols());
  for (Eigen::Index i = 0; i < own.cols(); ++i) {
    Eigen::VectorXd state = others;
    state.segment(item_.offset, own.rows()) = own.col(i);
    const Eigen::Isometry3d pose = pose_of(item_, state);
    for (const HeldModel& one : held) set_pose(scene_.items()[one.model], pose * one.pose, state);
    states.col(i) = state;
  }
  FoundPoses out{cheapest(cost, states, static_cast<std::size_t>(counts.refined)), states.cols()};
  std::vector<bool> free(hidden.size(), false);
  free[model_] = true;
  for (const HeldModel& one : held) free[one.model] = true;
  const auto kept = static_cast<std::size_t>(counts.kept);
  std::optional<LeastSquares> least_squares;
  if (cost.least_squares())
    refine_coarsely(least_squares.emplace(scene_, cost, free), cost, kept, out.poses);
  leave_distinct(scene_, kApart / static_cast<double>(scene_.items().size()), kept, out.poses);
  if (out.poses.empty()) return out;

  first = out.poses.front().state.segment(item_.offset, own.rows());
  if (fine_.visible_share(first) == 0) return out;
  take_in(search, fine_, frame, base, first);
  evaluate(cost, out.poses);
  out.evaluations += std::ssize(out.poses);
  if (least_squares) {
    least_squares->refine(out.poses, kFineIterations);
    sort_by_cost(out.poses);
    const std::size_t improved = std::min(out.poses.size(), kFineImproved);
    improve_limbs(*least_squares, cost, {out.poses.data(), improved});
    out.evaluations += least_squares->evaluations();
  }
  sort_by_cost(out.poses);
  return out;
}

void PoseSearch::refine_coarsely(LeastSquares& least_squares, Cost& cost, std::size_t kept,
                                 std::vector<Refined>& poses) const {
  for (const Round& round : kRounds) {
    least_squares.refine(poses, round.iterations);
    sort_by_cost(poses);
    const auto left =
        static_cast<std::size_t>(std::ceil(round.share * static_cast<double>(poses.size())));
    poses.resize(std::min(poses.size(), std::max(left, std::max(kept, kImproved))));
  }
  const std::size_t improved = std::min(poses.size(), kImproved);
  improve_limbs(least_squares, cost, {poses.data(), improved});
}

std::optional<Eigen::VectorXd> PoseSearch::with_better_limbs(Cost& cost,
                                                             const Eigen::VectorXd& state,
                                                             const std::vector<bool>& moving,
                                                             std::int64_t& evaluations) const {
  constexpr double kGain = 0.01;  // least share of the cost's change that counts
  if (!cost.least_squares() || postures_.limbs().empty()) return std::nullopt;
  LeastSquares least_squares(scene_, cost, moving);
  std::vector<Refined> one{{state, 0}};
  evaluate(cost, one);
  const double before = one.front().cost;
  improve_limbs(least_squares, cost, one);
  evaluations += least_squares.evaluations();
  if (!(one.front().cost < before - kGain * std::abs(before))) return std::nullopt;
  return one.front().state;
}

void PoseSearch::improve_limbs(LeastSquares& least_squares, Cost& cost,
                               std::span<Refined> poses) const {
  constexpr int kLimbIterations = 3;
  for (const Postures::Limb& limb : postures_.limbs()) {
    const auto variants = std::ssize(limb.variants), count = std::ssize(poses);
    Eigen::MatrixXd states(scene_.dimension(), variants * count);
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      states.col(i) = poses[static_cast<std::size_t>(i / variants)].state;
      const Eigen::VectorXd& values = limb.variants[static_cast<std::size_t>(i % variants)];
      for (std::size_t k = 0; k < limb.parameters.size(); ++k)
        states(item_.offset + limb.parameters[k], i) = values[static_cast<Eigen::Index>(k)];
    }
    Eigen::VectorXd costs(states.cols());
    cost.evaluate(states, costs);
    std::vector<Refined> others;
    for (Eigen::Index i = 0; i < count; ++i) {
      Eigen::Index best = 0;
      const double least = costs.segment(i * variants, variants).minCoeff(&best);
      others.push_back({states.col(i * variants + best), least});
    }
    least_squares.refine(others, kLimbIterations);
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (others[i].cost < poses[i].cost) poses[i] = std::move(others[i]);
  }
}

}  // namespace hypotrack::internal
