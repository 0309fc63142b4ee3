#include "evaluate/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluate/hypothesis_renderer.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

bool any_draws(const std::vector<ObjectiveTerm>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering();
  });
}

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
        renderer(make_hypothesis_renderer(scene, settings, any_draws(terms))) {}

  double cost(Eigen::Index index, const RenderedHypothesis& hypothesis) const {
    double sum = 0;
    for (const ObjectiveTerm& term : terms) {
      if (term.weight == 0) continue;  // also keeps 0 * infinity out
      const bool draws = term.objective->needs_rendering();
      const double cost =
          term.objective->cost(draws ? hypothesis : RenderedHypothesis{hypothesis.state, {}});
      sum += term.weight * cost;
      if (std::isnan(cost)) fail(term, index, "returned NaN");
      if (std::isnan(sum)) fail(term, index, "adds an infinity to its opposite");
    }
    return sum;
  }

  [[noreturn]] static void fail(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
    throw Error(
        fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                    "the objective: costs are numbers or +infinity",
                    term.name, what, index));
  }

  const Scene& scene;
  std::vector<ObjectiveTerm> terms;
  std::unique_ptr<HypothesisRenderer> renderer;
  Eigen::MatrixXd normalized;
  bool prepared = false;
};

Evaluator::Evaluator(const Scene& scene, std::vector<ObjectiveTerm> terms,
                     const EvaluateSettings& settings)
    : impl_(std::make_unique<Impl>(scene, std::move(terms), settings)) {}

Evaluator::~Evaluator() = default;

void Evaluator::prepare(const Observation& observation) {
  impl_->prepared = false;
  for (const ObjectiveTerm& term : impl_->terms) term.objective->prepare(observation);
  impl_->renderer->prepare(observation);
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
  impl_->renderer->render(impl_->normalized,
                          [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
                            costs[index] = impl_->cost(index, hypothesis);
                          });
}

std::string Evaluator::backend() const { return impl_->renderer->description(); }

}  // namespace hypotrack
