#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cost/evaluation.hpp"
#include "cost/hypothesis_renderer.hpp"
#include "cost/linearizer.hpp"
#include "cost/term_residuals.hpp"

namespace hypotrack {
namespace {

bool any_draws(const std::vector<ObjectiveTerm>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering();
  });
}

class HostEvaluation final : public Evaluation {
 public:
  HostEvaluation(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                 const EvaluateSettings& settings, std::string why_here)
      : terms_(terms),
        why_here_(std::move(why_here)),
        renderer_(make_hypothesis_renderer(scene, settings, any_draws(terms))),
        arena_(settings.threads > 0 ? settings.threads : tbb::info::default_concurrency()) {
    if (TermResiduals::why_none(terms).empty()) residuals_.emplace(terms);
    if (residuals_ && Linearizer::can_linearize(terms)) {
      linearizer_ = std::make_unique<Linearizer>(scene, terms, settings.threads);
    }
  }

  void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    arena_.execute([&] { Evaluation::prepare(tiles, frame, plan); });
  }
  void prepare(const Observation& observation) override {
    arena_.execute([&] {
      for (const ObjectiveTerm& term : terms_) term.objective->prepare(observation);
    });
    prepare_drawing(observation);
  }
  void prepare_drawing(const Observation& observation) override {
    if (residuals_) residuals_->prepare();
    renderer_->prepare(observation);
    if (linearizer_) linearizer_->prepare(observation);
  }

  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    renderer_->render(states, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      costs[index] = sum_up(index, hypothesis, [&](std::size_t t, const RenderedHypothesis& drawn) {
        return terms_[t].objective->cost(drawn);
      });
    });
  }

  bool has_residuals() const override { return residuals_.has_value(); }
  Eigen::Index residual_count() const override { return residuals_ ? residuals_->count() : 0; }
  std::vector<ResidualRows> pose_only_residuals() const override {
    return residuals_ ? residuals_->pose_only() : std::vector<ResidualRows>();
  }
  void evaluate_residuals(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) override {
    const auto count = static_cast<std::size_t>(residuals.rows());
    renderer_->render(states, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      std::span<float> rest(residuals.col(index).data(), count);
      costs[index] = sum_up(index, hypothesis, [&](std::size_t t, const RenderedHypothesis& drawn) {
        return residuals_->write(t, drawn, rest);
      });
    });
  }

  bool can_linearize() const override { return linearizer_ != nullptr; }
  NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                            double blur) override {
    return linearizer_->linearize(states, steps, blur);
  }

  std::string description() const override {
    return renderer_->description() + (why_here_.empty() ? "" : "; " + why_here_);
  }

 private:
  /// The weighted sum of what `cost_of(index of a term, hypothesis as it wants it)` returns.
  template <class CostOf>
  double sum_up(Eigen::Index index, const RenderedHypothesis& hypothesis,
                const CostOf& cost_of) const {
    double sum = 0;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      const ObjectiveTerm& term = terms_[t];
      if (term.weight == 0) continue;  // also keeps 0 * infinity out
      const bool draws = term.objective->needs_rendering();
      const double cost = cost_of(t, draws ? hypothesis : RenderedHypothesis{hypothesis.state, {}});
      sum += term.weight * cost;
      if (std::isnan(cost)) refuse_cost(term, index, "returned NaN");
      if (std::isnan(sum)) refuse_cost(term, index, "adds an infinity to its opposite");
    }
    return sum;
  }

  std::vector<ObjectiveTerm> terms_;
  std::string why_here_;
  std::optional<TermResiduals> residuals_;  // if the terms are a sum of squares
  std::unique_ptr<HypothesisRenderer> renderer_;
  std::unique_ptr<Linearizer> linearizer_;  // if the terms have what it needs
  tbb::task_arena arena_;                   // of what a frame takes before hypotheses
};

}  // namespace

std::unique_ptr<Evaluation> make_host_evaluation(const Scene& scene,
                                                 const std::vector<ObjectiveTerm>& terms,
                                                 const EvaluateSettings& settings,
                                                 std::string why_here) {
  return std::make_unique<HostEvaluation>(scene, terms, settings, std::move(why_here));
}

}  // namespace hypotrack
