#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/profile.hpp"
#include "base/stop_scope.hpp"
#include "cost/backends.hpp"
#include "cost/batched_terms.hpp"
#include "cost/draw/hypothesis_renderer.hpp"
#include "cost/linearize/difference_blocks.hpp"
#include "cost/linearize/linearizer_pool.hpp"
#include "cost/term_residuals.hpp"

namespace hypotrack::internal {
namespace {

bool any_draws(const std::vector<ObjectiveTerm>& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering();
  });
}

std::unique_ptr<HypothesisRenderer> make_renderer(const Scene& scene,
                                                  const EvaluateSettings& settings, bool draws) {
  if (draws && settings.backend == Backend::egl) return make_egl_renderer(scene, settings.threads);
  return make_cpu_renderer(scene, draws, settings.threads);
}

/// Draws with a HypothesisRenderer, scores on the CPU.
class HostCost final : public Cost, public StateResiduals {
 public:
  HostCost(const Scene& scene, std::vector<ObjectiveTerm> all, const EvaluateSettings& settings,
           std::string why_here)
      : Cost(scene, std::move(all)),
        why_here_(std::move(why_here)),
        renderer_(make_renderer(scene, settings, any_draws(terms()))),
        arena_(settings.threads > 0 ? settings.threads : tbb::info::default_concurrency()),
        batched_(terms()) {
    if (TermResiduals::why_none(terms()).empty()) residuals_.emplace(terms());
    if (residuals_ && HostLinearizer::can_linearize(terms())) {
      const auto make = [this, &scene](int bands) {
        return std::make_unique<HostLinearizer>(scene, terms(), arena_.max_concurrency(), bands);
      };
      linearizers_.emplace([make] { return make(HostLinearizer::kBands); });
      narrow_linearizers_.emplace([make] { return make(1); });
    }
  }

  StateResiduals* least_squares() override { return residuals_ ? this : nullptr; }
  std::string backend() const override {
    return renderer_->description() + (why_here_.empty() ? "" : "; " + why_here_);
  }

  // StateResiduals
  Eigen::Index count() const override {
    check_prepared();
    return residuals_->count();
  }
  std::vector<ResidualRows> pose_only() const override { return residuals_->pose_only(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd& batch = normalized(states, costs.size());
    check_room(residuals, count(), batch.cols());
    const auto rows = static_cast<std::size_t>(residuals.rows());
    render(batch, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      costs[index] = write_residuals(index, hypothesis, {residuals.col(index).data(), rows});
    });
  }
  std::unique_ptr<ResidualDifferences> differences() override {
    return std::make_unique<Differences>(*this, difference_memory_);
  }
  bool can_linearize() const override { return linearizers_.has_value(); }
  bool draws_neighbours() const override { return HostLinearizer::draws_neighbours(terms()); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override {
    const Neighbourhood at{states, steps, blur};
    return linearize_each({&at, 1}).front();
  }
  std::vector<NormalEquations> linearize_each(std::span<const Neighbourhood> points) override {
    std::vector<Eigen::MatrixXd> states;
    for (const Neighbourhood& at : points) {
      states.push_back(normalized(at.points, at.steps.size() + 1));
    }
    constexpr std::size_t kMany = 8;  // points keep the threads busy without bands
    LinearizerPool& pool = points.size() < kMany ? *linearizers_ : *narrow_linearizers_;
    std::vector<NormalEquations> out(points.size());
    const StopCheck check;
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        check();
        pool.use([&](HostLinearizer& linearizer) {
          out[i] = linearizer.linearize(states[i], points[i].steps, points[i].blur);
        });
      });
    });
    return out;
  }

 protected:
  void prepare_images(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    arena_.execute([&] { Cost::prepare_images(tiles, frame, plan); });
  }
  void prepare_observation(const Observation& observation) override {
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, terms().size(), [&](std::size_t i) {
        const ProfiledPart part(terms()[i].name);
        terms()[i].objective->prepare(observation);
      });
    });
    prepare_only_drawing(observation);
  }
  void prepare_only_drawing(const Observation& observation) override {
    if (residuals_) residuals_->prepare();
    renderer_->prepare(observation);
    if (!linearizers_) return;
    linearizers_->prepare(observation);
    narrow_linearizers_->prepare(observation);
  }
  void evaluate_normalized(const Eigen::MatrixXd& states,
                           Eigen::Ref<Eigen::VectorXd> costs) override {
    if (!batched_.any()) return score(states, costs);
    for (Eigen::Index first = 0; first < states.cols(); first += batched_.most()) {
      const Eigen::Index count = std::min(batched_.most(), states.cols() - first);
      batched_.begin(count);
      score(states.middleCols(first, count), costs.segment(first, count));
      batched_.add(costs.segment(first, count));
    }
  }

 private:
  /// Computes the costs of states without the batched terms, for which it keeps the drawings.
  void score(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) {
    render(states, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      if (batched_.any()) batched_.keep(index, hypothesis);
      costs[index] = sum_up(index, hypothesis, [&](std::size_t t, const RenderedHypothesis& drawn) {
        return batched_.has(t) ? 0 : terms()[t].objective->cost(drawn);
      });
    });
  }

  /// Memory of Differences, kept from search to search.
  struct DifferenceMemory {
    Eigen::MatrixXf batch;  // residuals of the last batch of evaluate()
    Eigen::VectorXf here;   // residuals of the point of linearisation
    DifferenceBlocks blocks;
  };

  /// Computes normal equations without storing the residuals of all neighbouring points at once.
  class Differences final : public ResidualDifferences {
   public:
    Differences(HostCost& cost, DifferenceMemory& memory) : cost_(cost), memory_(memory) {}

    void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                  Eigen::Ref<Eigen::VectorXd> costs) override {
      const Eigen::Index rows = cost_.count(), columns = states.cols();
      if (memory_.batch.rows() != rows || memory_.batch.cols() < columns) {
        memory_.batch.resize(rows, columns);
      }
      cost_.evaluate(states, memory_.batch.leftCols(columns), costs);
      neighbours_.resize(0, 0);
    }
    void move_to(Eigen::Index i) override {
      if (neighbours_.cols() > 0) {  // rare: evaluated again, because residuals were not kept
        Eigen::VectorXd cost(1);
        evaluate(Eigen::MatrixXd(neighbours_.col(i)), cost);
        i = 0;
      }
      memory_.here = memory_.batch.col(i);
    }
    NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                     const Eigen::Ref<const Eigen::VectorXd>& scale,
                                     Eigen::Ref<Eigen::VectorXd> costs) override {
      neighbours_ = states;
      cost_.fill(memory_.blocks, memory_.here, states, costs);
      NormalEquations sums;
      cost_.arena_.execute(
          [&] { sums = memory_.blocks.normal_equations(scale_of_finite(scale, costs)); });
      return sums;
    }

   private:
    HostCost& cost_;
    DifferenceMemory& memory_;
    Eigen::MatrixXd neighbours_;  // states of the last batch, if it was of normal_equations()
  };

  /// Draws states and visits them until the search has to end. The terms of a hypothesis are scored
  /// at the same time if its batch leaves threads without work.
  template <class Visit>
  void render(const Eigen::MatrixXd& states, const Visit& visit) {
    terms_at_once_ = 2 * states.cols() <= arena_.max_concurrency();
    const StopCheck check;
    renderer_->render(states, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      check();
      visit(index, hypothesis);
    });
  }

  /// Stores how the residuals of states (DxN) differ from those of one point; computes the costs.
  void fill(DifferenceBlocks& blocks, const Eigen::VectorXf& here,
            const Eigen::Ref<const Eigen::MatrixXd>& states, Eigen::Ref<Eigen::VectorXd> costs) {
    const Eigen::MatrixXd& batch = normalized(states, costs.size());
    const auto rows = static_cast<std::size_t>(here.size());
    blocks.begin({here.data(), rows}, batch.cols());
    render(batch, [&](Eigen::Index index, const RenderedHypothesis& hypothesis) {
      std::vector<float>& residuals = residual_memory_.local();
      residuals.resize(rows);
      costs[index] = write_residuals(index, hypothesis, residuals);
      blocks.set(index, residuals);
    });
  }

  /// Writes all residuals of a hypothesis and returns its cost.
  double write_residuals(Eigen::Index index, const RenderedHypothesis& hypothesis,
                         std::span<float> residuals) const {
    return sum_up(index, hypothesis, [&](std::size_t t, const RenderedHypothesis& drawn) {
      return residuals_->write(t, drawn, residuals);
    });
  }

  /// Returns the weighted sum of `cost_of(term index, hypothesis)` over the terms. Terms that need
  /// no rendering get no views.
  template <class CostOf>
  double sum_up(Eigen::Index index, const RenderedHypothesis& hypothesis,
                const CostOf& cost_of) const {
    std::vector<double> costs(terms().size());
    const auto find_cost = [&](std::size_t t) {
      const ObjectiveTerm& term = terms()[t];
      if (term.weight == 0) return;  // also avoids 0 * infinity
      const bool draws = term.objective->needs_rendering();
      costs[t] = cost_of(t, draws ? hypothesis : RenderedHypothesis{hypothesis.state, {}});
    };
    if (terms_at_once_) {
      // A thread that waits here must not begin another hypothesis: it would write to the same
      // residual_memory_.
      tbb::this_task_arena::isolate(
          [&] { tbb::parallel_for(std::size_t{0}, costs.size(), find_cost); });
    } else {
      for (std::size_t t = 0; t < costs.size(); ++t) find_cost(t);
    }
    double sum = 0;
    for (std::size_t t = 0; t < costs.size(); ++t) {
      const ObjectiveTerm& term = terms()[t];
      if (term.weight == 0) continue;
      sum += term.weight * costs[t];
      if (std::isnan(sum)) refuse_cost(term, index, "adds an infinity to its opposite");
    }
    return sum;
  }

  std::string why_here_;
  std::optional<TermResiduals> residuals_;  // set if the terms are a sum of squares
  std::unique_ptr<HypothesisRenderer> renderer_;
  tbb::task_arena arena_;  // for work that is not on hypotheses
  bool terms_at_once_ = false;
  BatchedTerms batched_;
  // Set if the terms can be linearised: for a few points at a time, and for many.
  std::optional<LinearizerPool> linearizers_, narrow_linearizers_;
  tbb::enumerable_thread_specific<std::vector<float>> residual_memory_;  // of one hypothesis
  DifferenceMemory difference_memory_;
};

}  // namespace

HypothesisRenderer::~HypothesisRenderer() = default;

std::unique_ptr<Cost> make_host_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                     const EvaluateSettings& settings, std::string why_here) {
  return std::make_unique<HostCost>(scene, std::move(terms), settings, std::move(why_here));
}

}  // namespace hypotrack::internal
