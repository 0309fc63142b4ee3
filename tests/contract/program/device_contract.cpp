#include "device_contract.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "cost/cost.hpp"
#include "cost/cuda/device.hpp"
#include "drawn_tiles.hpp"
#include "test_models.hpp"

namespace hypotrack::contract {
namespace {

constexpr int kStates = 32;
constexpr double kCostTolerance = 1e-3;  // of the largest cost of an observation

void require_device(const Subject& subject) {
  if (const std::string why = cuda::why_no_device(); !why.empty()) throw Skipped(why);
  if (!subject.make<Objective>()->on_device()) {
    throw Skipped("it has no device capability, or was built without CUDA");
  }
}

std::unique_ptr<Cost> cost_on(const Subject& subject, Backend backend) {
  std::vector<ObjectiveTerm> terms(1);
  terms[0].objective = subject.make<Objective>();
  return make_cost(*subject.scene, std::move(terms), {.backend = backend});
}

bool takes(Cost& cost, const Observation& observation) {
  try {
    cost.prepare(observation);
    return true;
  } catch (const DataError&) {
    return false;
  }
}

/// Returns random states near where the observations look, one per column.
Eigen::MatrixXd make_states(const Scene& scene) {
  std::mt19937_64 random(5);
  Eigen::MatrixXd states(scene.dimension(), kStates);
  for (auto state : states.colwise()) {
    state = test::random_state(scene, random, {0, 0, 0.5}, 0.05);
    scene.normalize(state);
  }
  return states;
}

Eigen::VectorXd costs_of(Cost& cost, const Eigen::MatrixXd& states) {
  Eigen::VectorXd costs(states.cols());
  cost.evaluate(states, costs);
  return costs;
}

/// Returns the costs of states evaluated in batches of one.
Eigen::VectorXd costs_one_by_one(Cost& cost, const Eigen::MatrixXd& states) {
  Eigen::VectorXd costs(states.cols());
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    cost.evaluate(states.col(i), costs.segment(i, 1));
  }
  return costs;
}

void require_near(const Eigen::VectorXd& found, const Eigen::VectorXd& expected,
                  const std::string& where) {
  double largest = 0;
  for (const double cost : expected) {
    if (std::isfinite(cost)) largest = std::max(largest, std::abs(cost));
  }
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const bool near =
        found[i] == expected[i] || std::abs(found[i] - expected[i]) <= kCostTolerance * largest;
    require(near, where + ": state " + std::to_string(i) + " costs " + std::to_string(found[i]) +
                      " on the device, " + std::to_string(expected[i]) + " on the CPU");
  }
}

void check_refusals(const Subject& subject) {
  require_device(subject);
  const auto cpu = cost_on(subject, Backend::cpu);
  const auto device = cost_on(subject, Backend::cuda);
  for (const NamedObservation& named : make_observations(*subject.scene)) {
    const bool expected = takes(*cpu, named.observation);
    require(takes(*device, named.observation) == expected,
            named.name + ": " + (expected ? "refused" : "accepted") +
                " on the device, but not on the CPU");
  }
}

void check_agreement(const Subject& subject) {
  require_device(subject);
  const auto cpu = cost_on(subject, Backend::cpu);
  const auto device = cost_on(subject, Backend::cuda);
  const Eigen::MatrixXd states = make_states(*subject.scene);
  for (const NamedObservation& named : make_observations(*subject.scene)) {
    if (!takes(*cpu, named.observation)) continue;
    device->prepare(named.observation);
    const Eigen::VectorXd expected = costs_of(*cpu, states);
    require_near(costs_of(*device, states), expected, named.name);
    require_near(costs_one_by_one(*device, states), expected, named.name + ", one by one");
  }
}

void check_repetition(const Subject& subject) {
  require_device(subject);
  const auto first = cost_on(subject, Backend::cuda);
  const auto second = cost_on(subject, Backend::cuda);
  const Eigen::MatrixXd states = make_states(*subject.scene);
  for (const NamedObservation& named : make_observations(*subject.scene)) {
    if (!takes(*first, named.observation)) continue;
    second->prepare(named.observation);
    const Eigen::VectorXd costs = costs_of(*first, states);
    require(costs_of(*first, states) == costs, named.name + ": scoring twice gives two costs");
    require(costs_of(*second, states) == costs, named.name + ": two objects give two costs");
  }
}

void require_residuals(const Subject& subject) {
  require_device(subject);
  const auto objective = subject.make<Objective>();
  if (!objective->residual_term()) throw Skipped("it offers none, as it is set up");
  if (!objective->on_device()->has_residuals()) throw Skipped("it has them on the CPU only");
}

struct Residuals {
  Eigen::MatrixXf values;
  Eigen::VectorXd costs;
};

Residuals residuals_of(Cost& cost, const Eigen::MatrixXd& states) {
  Residuals all{Eigen::MatrixXf::Constant(cost.least_squares()->count(), states.cols(), NAN),
                Eigen::VectorXd(states.cols())};
  cost.least_squares()->evaluate(states, all.values, all.costs);
  return all;
}

void check_residual_agreement(const Subject& subject) {
  require_residuals(subject);
  const auto cpu = cost_on(subject, Backend::cpu);
  const auto device = cost_on(subject, Backend::cuda);
  const Eigen::MatrixXd states = make_states(*subject.scene);
  for (const NamedObservation& named : make_observations(*subject.scene)) {
    if (!takes(*cpu, named.observation)) continue;
    device->prepare(named.observation);
    require(device->least_squares()->count() == cpu->least_squares()->count(),
            named.name + ": " + std::to_string(device->least_squares()->count()) +
                " residuals on the device, " + std::to_string(cpu->least_squares()->count()) +
                " on the CPU");
    const Residuals expected = residuals_of(*cpu, states), found = residuals_of(*device, states);
    require_near(found.costs, expected.costs, named.name + ", with residuals");
    if (expected.values.size() == 0) continue;
    require(found.values.allFinite(), named.name + ": not all residuals are written on the device");
    const float largest = expected.values.cwiseAbs().maxCoeff();
    const Eigen::VectorXf apart = (found.values - expected.values).cwiseAbs().colwise().mean();
    Eigen::Index worst = 0;
    require(apart.maxCoeff(&worst) <= kCostTolerance * largest,
            named.name + ": state " + std::to_string(worst) + "'s residuals are " +
                std::to_string(apart[worst]) + " apart in the mean, the largest is " +
                std::to_string(largest));
    const Residuals again = residuals_of(*device, states);
    require(again.values == found.values && again.costs == found.costs,
            named.name + ": evaluating twice gives two sets of residuals");
  }
}

}  // namespace

void check_on_device(Report& report, const Subject& subject) {
  report.row("the device refuses what the CPU refuses", [&] { check_refusals(subject); });
  report.row("costs on the device are those on the CPU", [&] { check_agreement(subject); });
  report.row("costs on the device repeat to the bit", [&] { check_repetition(subject); });
  report.row("residuals on the device are those on the CPU",
             [&] { check_residual_agreement(subject); });
}

}  // namespace hypotrack::contract
