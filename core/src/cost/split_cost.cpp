#include "cost/split_cost.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cost/backends.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::internal {
namespace {

bool draws(const ObjectiveTerm& term) {
  return term.weight != 0 && term.objective->needs_rendering();
}

bool is_for_gpu(const ObjectiveTerm& term, bool residuals) {
  if (term.objective->needs_rendering()) return true;
  const auto on_device = term.objective->on_device();
  return on_device && (!residuals || term.weight == 0 || on_device->has_residuals());
}

std::vector<ObjectiveTerm> joined(std::vector<ObjectiveTerm> first,
                                  const std::vector<ObjectiveTerm>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

bool reads_images(const std::vector<ObjectiveTerm>& terms) {
  const ImageUse use = joined_use(terms);
  return use.color || use.mask || use.depth || use.background;
}

/// Adds the costs of terms on the CPU to those of the others.
void add(const Eigen::VectorXd& posed, const std::vector<ObjectiveTerm>& terms,
         Eigen::Ref<Eigen::VectorXd> costs) {
  costs += posed;
  for (Eigen::Index i = 0; i < costs.size(); ++i)
    if (std::isnan(costs[i])) refuse_cost(terms.front(), i, "adds an infinity to its opposite");
}

/// Adds normal equations. Columns of J are 0 where one of both costs is infinite.
NormalEquations sum_of(const NormalEquations& a, const NormalEquations& b,
                       const Eigen::Ref<const Eigen::VectorXd>& costs) {
  NormalEquations sum{a.a + b.a, a.g + b.g};
  for (Eigen::Index i = 0; i < costs.size(); ++i) {
    if (std::isfinite(costs[i])) continue;
    sum.a.row(i).setZero();
    sum.a.col(i).setZero();
    sum.g[i] = 0;
  }
  return sum;
}

class SplitDifferences final : public ResidualDifferences {
 public:
  /// The terms on the CPU must outlive it.
  SplitDifferences(std::unique_ptr<ResidualDifferences> drawn,
                   std::unique_ptr<ResidualDifferences> posed,
                   const std::vector<ObjectiveTerm>& terms)
      : drawn_(std::move(drawn)), posed_(std::move(posed)), terms_(terms) {}

  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    Eigen::VectorXd more(costs.size());
    drawn_->evaluate(states, costs);
    posed_->evaluate(states, more);
    add(more, terms_, costs);
  }
  void move_to(Eigen::Index i) override {
    drawn_->move_to(i);
    posed_->move_to(i);
  }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    Eigen::VectorXd more(costs.size());
    const NormalEquations drawn = drawn_->normal_equations(states, scale, costs);
    const NormalEquations posed = posed_->normal_equations(states, scale, more);
    add(more, terms_, costs);
    return sum_of(drawn, posed, costs);
  }

 private:
  std::unique_ptr<ResidualDifferences> drawn_, posed_;
  const std::vector<ObjectiveTerm>& terms_;
};

class SplitCost final : public Cost, public StateResiduals {
 public:
  SplitCost(const Scene& scene, const SplitTerms& terms, std::unique_ptr<Cost> drawn,
            std::unique_ptr<Cost> posed, std::string backend)
      : Cost(scene, joined(terms.gpu, terms.cpu)),
        drawn_(std::move(drawn)),
        posed_(std::move(posed)),
        terms_(terms.cpu),
        backend_(std::move(backend)) {}

  StateResiduals* least_squares() override {
    return drawn_->least_squares() && posed_->least_squares() ? this : nullptr;
  }
  bool is_on_gpu() const override { return drawn_->is_on_gpu(); }
  std::string backend() const override { return backend_; }

  // StateResiduals
  Eigen::Index count() const override { return drawn_residuals().count() + posed_count(); }
  std::vector<ResidualRows> pose_only() const override {
    std::vector<ResidualRows> rows = drawn_residuals().pose_only();
    if (posed_count() > 0) rows.push_back({drawn_residuals().count(), posed_count()});
    return rows;
  }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override {
    check_room(residuals, count(), states.cols());
    Eigen::VectorXd more(costs.size());
    drawn_residuals().evaluate(states, residuals.topRows(drawn_residuals().count()), costs);
    posed_residuals().evaluate(states, residuals.bottomRows(posed_count()), more);
    add(more, terms_, costs);
  }
  std::unique_ptr<ResidualDifferences> differences() override {
    return std::make_unique<SplitDifferences>(drawn_residuals().differences(),
                                              posed_residuals().differences(), terms_);
  }
  bool can_linearize() const override { return drawn_residuals().can_linearize(); }
  bool draws_neighbours() const override { return drawn_residuals().draws_neighbours(); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override {
    const Neighbourhood at{states, steps, blur};
    return linearize_each({&at, 1}).front();
  }
  std::vector<NormalEquations> linearize_each(std::span<const Neighbourhood> points) override {
    std::vector<NormalEquations> sums = drawn_residuals().linearize_each(points);
    const std::vector<NormalEquations> more = posed_residuals().linearize_each(points);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i].a += more[i].a;
      sums[i].g += more[i].g;
    }
    return sums;
  }

 protected:
  void prepare_observation(const Observation& observation) override {
    drawn_->prepare(observation);
    posed_->prepare(observation);
  }
  void prepare_only_drawing(const Observation& observation) override {
    drawn_->prepare_drawing(observation);
    posed_->prepare_drawing(observation);
  }
  void prepare_images(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    drawn_->prepare(tiles, frame, plan);
    if (reads_images(terms_)) {
      posed_->prepare(tiles, frame, plan);
    } else {
      posed_->prepare(plan.header);
    }
  }
  void evaluate_normalized(const Eigen::MatrixXd& states,
                           Eigen::Ref<Eigen::VectorXd> costs) override {
    Eigen::VectorXd more(costs.size());
    drawn_->evaluate(states, costs);
    posed_->evaluate(states, more);
    add(more, terms_, costs);
  }

 private:
  StateResiduals& drawn_residuals() const { return *drawn_->least_squares(); }
  StateResiduals& posed_residuals() const { return *posed_->least_squares(); }
  Eigen::Index posed_count() const { return posed_residuals().count(); }

  std::unique_ptr<Cost> drawn_, posed_;
  std::vector<ObjectiveTerm> terms_;  // on the CPU
  std::string backend_;
};

}  // namespace

std::string SplitTerms::cpu_names() const {
  std::string out;
  for (const ObjectiveTerm& term : cpu) out += (out.empty() ? "" : ", ") + term.name;
  return out;
}

SplitTerms split_terms(const std::vector<ObjectiveTerm>& terms, bool residuals) {
  SplitTerms out;
  for (const ObjectiveTerm& term : terms)
    (is_for_gpu(term, residuals) ? out.gpu : out.cpu).push_back(term);
  return std::ranges::any_of(out.gpu, draws) ? out : SplitTerms{terms, {}};
}

std::unique_ptr<Cost> make_split_cost(const Scene& scene, const SplitTerms& terms,
                                      std::unique_ptr<Cost> drawn, std::unique_ptr<Cost> posed,
                                      std::string backend) {
  return std::make_unique<SplitCost>(scene, terms, std::move(drawn), std::move(posed),
                                     std::move(backend));
}

}  // namespace hypotrack::internal
