#include "evaluate/evaluator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "evaluate/evaluation.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

std::vector<ObjectiveTerm> checked(std::vector<ObjectiveTerm> terms) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (terms[i].name.empty()) terms[i].name = fmt::format("number {}", i + 1);
    if (!terms[i].objective) {
      throw Error(fmt::format("evaluate: there is no objective behind term {}", terms[i].name));
    }
    if (!std::isfinite(terms[i].weight)) {
      throw ConfigError(
          fmt::format("evaluate: the weight of objective {} is {}, expected a finite "
                      "number",
                      terms[i].name, terms[i].weight));
    }
  }
  return terms;
}

}  // namespace

struct Evaluator::Impl {
  Impl(const Scene& s, std::vector<ObjectiveTerm> t, const EvaluateSettings& settings)
      : scene(s),
        terms(checked(std::move(t))),
        evaluation(make_evaluation(scene, terms, settings)) {}

  const Scene& scene;
  std::vector<ObjectiveTerm> terms;
  std::unique_ptr<Evaluation> evaluation;
  TilePlan plan;  // of the frame that is prepared
  Eigen::MatrixXd normalized;
  bool prepared = false;
};

Evaluator::Evaluator(const Scene& scene, std::vector<ObjectiveTerm> terms,
                     const EvaluateSettings& settings)
    : impl_(std::make_unique<Impl>(scene, std::move(terms), settings)) {}

Evaluator::~Evaluator() = default;

void Evaluator::prepare(const Observation& observation) {
  impl_->prepared = false;
  impl_->evaluation->prepare(observation);
  impl_->prepared = true;
}

void Evaluator::prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan) {
  impl_->prepared = false;
  impl_->plan = std::move(plan);
  impl_->evaluation->prepare(tiles, frame, impl_->plan);
  impl_->prepared = true;
}

void Evaluator::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                         Eigen::Ref<Eigen::VectorXd> costs) {
  if (!impl_->prepared) throw Error("evaluate: no frame has been prepared");
  if (states.rows() != impl_->scene.dimension() || costs.size() != states.cols()) {
    throw Error(
        fmt::format("evaluate: found states {} x {} and room for {} costs, expected "
                    "states {} x N and room for N",
                    states.rows(), states.cols(), costs.size(), impl_->scene.dimension()));
  }
  impl_->normalized = states;
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    impl_->scene.normalize(impl_->normalized.col(i));
  }
  impl_->evaluation->evaluate(impl_->normalized, costs);
}

cuda::DeviceCost* Evaluator::device_cost(const Eigen::VectorXd& prior, bool rotation_vectors) {
  if (!impl_->prepared) throw Error("evaluate: no frame has been prepared");
  return impl_->evaluation->device_cost(prior, rotation_vectors);
}

std::string Evaluator::backend() const { return impl_->evaluation->description(); }

}  // namespace hypotrack
