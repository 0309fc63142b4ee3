#include "track/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/search.hpp"

namespace hypotrack {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Residuals of search points that stay where the evaluator has them.
class PointDifferences final : public ResidualDifferences {
 public:
  PointDifferences(const SearchSpace& space, const Eigen::VectorXd& prior,
                   ResidualDifferences& of_states)
      : space_(space), prior_(prior), of_states_(of_states) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    of_states_.evaluate(space_.states(points, prior_), costs);
  }
  void move_to(Eigen::Index i) override { of_states_.move_to(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    return of_states_.normal_equations(space_.states(points, prior_), scale, costs);
  }

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  ResidualDifferences& of_states_;
};

/// Costs of search points: points become states, states are evaluated.
class StateCost final : public CostFunction, public ResidualCost {
 public:
  StateCost(const SearchSpace& space, const Eigen::VectorXd& prior, Evaluator& evaluator)
      : space_(space), prior_(prior), evaluator_(evaluator) {}

  int dimension() const override { return space_.dimension(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    evaluator_.evaluate(space_.states(points, prior_), costs);
  }
  cuda::DeviceCost* device() override {
    return evaluator_.device_cost(prior_, space_.rotation_vectors());
  }
  ResidualCost* residuals() override { return evaluator_.has_residuals() ? this : nullptr; }

  // ResidualCost
  Eigen::Index count() const override { return evaluator_.residual_count(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override {
    evaluator_.evaluate(space_.states(points, prior_), residuals, costs);
  }
  std::unique_ptr<ResidualDifferences> differences() override {
    ResidualDifferences* of_states = evaluator_.differences();
    if (!of_states) return ResidualCost::differences();
    return std::make_unique<PointDifferences>(space_, prior_, *of_states);
  }
  bool can_linearize() const override { return evaluator_.can_linearize(); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override {
    return evaluator_.linearize(space_.states(points, prior_), steps, blur);
  }

 private:
  const SearchSpace& space_;
  const Eigen::VectorXd& prior_;
  Evaluator& evaluator_;
};

/// A seed of its own for every frame (splitmix64 of both numbers), so that a frame's search does
/// not depend on how many random numbers the frames before it used.
std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(frame) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Where no term looks at pictures, their colours are nobody's business.
PhotometricSettings of_pictures(PhotometricSettings settings,
                                const std::vector<ObjectiveTerm>& terms) {
  settings.match = settings.match && std::ranges::any_of(terms, [](const ObjectiveTerm& term) {
                     return term.weight != 0 && term.objective->needs_rendering();
                   });
  return settings;
}

/// Takes what hindsight may spend off the budget of a search. Throws ConfigError if that would
/// leave it less than half.
void reserve_for(const HindsightSettings& hindsight, Budget& budget) {
  if (budget.evaluations < 2 * hindsight.evaluations)
    throw ConfigError(
        fmt::format("hindsight takes {} evaluations of a frame's budget, which is {}; give "
                    "budget.evaluations {} "
                    "or more, hindsight.evaluations {} or less, or leave hindsight.enabled off",
                    hindsight.evaluations, budget.evaluations, 2 * hindsight.evaluations,
                    budget.evaluations / 2));
  budget.evaluations -= hindsight.evaluations;
}

/// Takes the evaluations that sigmas need off the budget of a search. Throws ConfigError if that
/// would leave it less than half.
void reserve_for(const PoseUncertainty& uncertainty, Budget& budget) {
  const std::int64_t needed = uncertainty.evaluations();
  if (budget.evaluations < 2 * needed)
    throw ConfigError(fmt::format(
        "tracker.uncertainty takes {} evaluations of a frame's budget, which is {}; give "
        "budget.evaluations {} or more, or leave tracker.uncertainty.enabled off",
        needed, budget.evaluations, 2 * needed));
  budget.evaluations -= needed;
}

}  // namespace

Tracker::Tracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed)
    : parts_(std::move(parts)),
      tiles_(scene, parts_.cameras, parts_.tile),
      photometric_(scene, of_pictures(parts_.photometric, parts_.objective)),
      space_(scene, parts_.search),
      evaluator_(scene, parts_.objective, parts_.evaluate, residual_use(parts_)),
      monitor_(parts_.status),
      landmarks_(landmark_layout(scene.landmark_names())),
      predictor_(scene, parts_.search.prediction),
      smoother_(scene, parts_.smoothing),
      state_(std::move(start)),
      seed_(seed) {
  if (const std::string why = parts_.optimizer->needs_device();
      !why.empty() && !evaluator_.on_device())
    throw DeviceError(why);
  scene.normalize(state_);
  output_ = state_;
  if (parts_.budget.evaluations == 0)
    parts_.budget.evaluations = parts_.optimizer->default_evaluations();
  if (parts_.hindsight.enabled) reserve_for(parts_.hindsight, parts_.budget);
  if (parts_.status.uncertainty.enabled)
    reserve_for(uncertainty_.emplace(scene, parts_.status.uncertainty), parts_.budget);
}

ResidualUse residual_use(const TrackerParts& parts) {
  const bool search = parts.optimizer->needs_residuals();
  const bool hindsight = parts.hindsight.enabled;
  return {search || hindsight || parts.status.uncertainty.enabled,
          std::max(search ? parts.optimizer->linearization() : Linearization::unused,
                   hindsight ? Linearization::welcome : Linearization::unused)};
}

Tracker::~Tracker() = default;

Solution Tracker::track(const Frame& frame) {
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = kUnknown;
  if (uncertainty_)
    solution.sigma.setConstant(static_cast<Eigen::Index>(landmarks_.names.size()), kUnknown);
  if (!frame.views.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    const Found found = search(frame);
    const double visible = tiles_.visible_share(found.state);
    solution.cost = found.cost;
    solution.evaluations = found.evaluations;
    if (uncertainty_) {
      solution.sigma = uncertainty_->of(evaluator_, found.state);
      solution.evaluations += uncertainty_->evaluations();
    }
    solution.status = monitor_.judge(found.cost, visible, largest_sigma(solution.sigma),
                                     tiles_.on_foreground(frame, found.state));
    // Where nothing was feasible, or the answer has left every image, the last state is the better
    // place to search the next frame from.
    if (std::isfinite(found.cost) && visible > 0) go_on_from(found.state, frame);
    if (solution.status == Status::lost) predictor_.forget_motion();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    solution.seconds = elapsed.count();
  }
  solution.state = smoothed(solution);
  return solution;
}

Observation Tracker::seen(const Frame& frame) const {
  TilePlan plan = plan_;
  for (CutPlan& cut : plan.cuts) cut.brightness = cv::Mat();
  return tiles_.cut(frame, plan);
}

Eigen::MatrixXd Tracker::possible_starts(double time) {
  const Eigen::MatrixXd states = predictor_.at(time);
  // Tiles can be cut around what is seen only.
  if (states.cols() == 0 || tiles_.visible_share(states.col(0)) == 0) return state_;
  return states.cols() < parts_.budget.evaluations ? states : states.leftCols(1);
}

Eigen::VectorXd Tracker::cheapest(const Eigen::MatrixXd& states) {
  if (states.cols() == 1) return states;
  Eigen::VectorXd costs(states.cols());
  evaluator_.evaluate(states, costs);
  Eigen::Index best = 0;
  costs.minCoeff(&best);
  return states.col(best);
}

void Tracker::go_on_from(const Eigen::VectorXd& found, const Frame& frame) {
  state_ = found;
  found_any_ = true;
  predictor_.add(state_, frame.time);
  photometric_.learn(tiles_, frame, plan_, state_);
}

Eigen::VectorXd Tracker::smoothed(const Solution& solution) {
  if (!parts_.smoothing.enabled) return state_;
  if (solution.status == Status::lost) smoother_.begin_anew();
  if (solution.status != Status::missing) output_ = smoother_.filter(state_, solution.time);
  return output_;
}

double Tracker::largest_sigma(const Eigen::VectorXd& sigma) const {
  if (sigma.size() == 0) return kUnknown;
  return std::ranges::max(model_means(landmarks_, sigma));
}

void Tracker::check(const Frame& frame) {
  evaluator_.prepare(tiles_, frame, tiles_.plan(frame, state_));
}

std::string Tracker::problem_of_start(const Frame& frame) const {
  constexpr const char* kQuestion =
      "is the start (init) where the models are, and do the cameras and their units (calibration) "
      "belong to the pictures?";
  const double visible = tiles_.visible_share(state_);
  if (visible < parts_.status.min_visible)
    return fmt::format(
        "{:.0f} % of what the models cover at the start is inside every image, and a frame with "
        "less than {:.0f} % counts as lost (tracker.min_visible); {}",
        100 * visible, 100 * parts_.status.min_visible, kQuestion);
  const OnForeground on_foreground = tiles_.on_foreground(frame, state_);
  if (on_foreground == OnForeground::nowhere)
    return fmt::format(
        "the models at the start cover no foreground pixel of any mask, and such a frame counts as "
        "lost; {}",
        kQuestion);
  if (on_foreground == OnForeground::in_parts)
    return fmt::format(
        "no point of the models at the start is on the foreground of all masks, and such a frame "
        "counts as uncertain; {}",
        kQuestion);
  return {};
}

void Tracker::look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess) {
  plan_ = tiles_.plan(frame, start);
  if (!photometric_.knows()) photometric_.begin(tiles_, frame, plan_, start);
  photometric_.apply(plan_);
  photometric_.apply_highlights(plan_, start);
  plan_.header.start_is_guess = is_guess;
  evaluator_.prepare(tiles_, frame, plan_);
}

Tracker::Found Tracker::search(const Frame& frame) {
  const Eigen::MatrixXd starts = possible_starts(frame.time);
  const std::uint64_t seed = frame_seed(seed_, frame.index);
  Budget budget = parts_.budget;
  budget.usual_cost = monitor_.usual_cost();
  look(frame, starts.col(0), !found_any_);
  const Eigen::VectorXd prior = cheapest(starts);
  const std::int64_t compared = starts.cols() > 1 ? starts.cols() : 0;
  budget.evaluations -= compared;
  Found found = plan_.header.start_is_guess ? search_twice(frame, prior, budget, seed)
                                            : search_from(prior, budget, seed);
  found.evaluations += compared;
  return found;
}

Tracker::Found Tracker::search_twice(const Frame& frame, const Eigen::VectorXd& prior,
                                     const Budget& budget, std::uint64_t seed) {
  const double kept = parts_.search.second_look;
  Budget first = budget, second = budget;
  first.evaluations -= static_cast<std::int64_t>(kept * static_cast<double>(budget.evaluations));
  first.seconds *= 1 - kept;
  Found found = search_from(prior, first, seed);
  second.evaluations -= found.evaluations;
  if (kept == 0 || second.evaluations < 1 || tiles_.visible_share(found.state) == 0) return found;
  second.seconds *= kept;
  photometric_.forget();
  look(frame, found.state, false);
  const std::int64_t before = found.evaluations;
  found = search_from(found.state, second, seed_of_part(seed, 1));
  found.evaluations += before;
  return found;
}

Tracker::Found Tracker::search_from(const Eigen::VectorXd& prior, const Budget& budget,
                                    std::uint64_t seed) {
  StateCost cost(space_, prior, evaluator_);
  const OptimizerResult result =
      parts_.optimizer->minimize(cost, space_.region(prior), budget, seed);
  if (!result.point.allFinite() || std::isnan(result.cost))
    throw PluginError(
        fmt::format("the optimizer's answer of cost {} has numbers that are none; this is a bug in "
                    "the optimizer",
                    result.cost));
  return {space_.states(result.point, prior), result.cost, result.evaluations};
}

}  // namespace hypotrack
