#include "cost/evaluator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "cost/evaluation.hpp"
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

/// Returns the images that any of the terms reads.
ImageUse joined_use(const std::vector<ObjectiveTerm>& terms) {
  ImageUse all{.mask = false, .depth = false};
  for (const ObjectiveTerm& term : terms) {
    const ImageUse use = term.objective->image_use();
    all.mask = all.mask || use.mask;
    all.depth = all.depth || use.depth;
  }
  return all;
}

/// Returns the frame without the images that no term reads.
Frame looked_at(const Frame& frame, const ImageUse& use) {
  Frame out{frame.index, frame.time, frame.views, {}, {}};
  for (View& view : out.views) {
    if (!use.mask) view.mask.release();
    if (!use.depth) view.depth.release();
  }
  return out;
}

}  // namespace

struct Evaluator::Impl final : ResidualDifferences {
  Impl(const Scene& s, std::vector<ObjectiveTerm> t, const EvaluateSettings& settings,
       const Requirements& requirements)
      : scene(s),
        terms(checked(std::move(t))),
        evaluation(make_evaluation(scene, terms, settings, requirements)) {}

  // ResidualDifferences: normalises and forwards to the evaluation's.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::VectorXd> costs) override {
    normalize(states, costs.size());
    evaluation->differences()->evaluate(normalized, costs);
  }
  void move_to(Eigen::Index i) override { evaluation->differences()->move_to(i); }
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                   const Eigen::Ref<const Eigen::VectorXd>& scale,
                                   Eigen::Ref<Eigen::VectorXd> costs) override {
    normalize(states, costs.size());
    return evaluation->differences()->normal_equations(normalized, scale, costs);
  }

  /// Stores the normalised states of a batch. Throws Error if their sizes do not fit.
  void normalize(const Eigen::Ref<const Eigen::MatrixXd>& states, Eigen::Index costs);

  const Scene& scene;
  std::vector<ObjectiveTerm> terms;
  std::unique_ptr<Evaluation> evaluation;
  Frame frame;    // the prepared frame, without unused images
  TilePlan plan;  // plan of that frame
  Eigen::MatrixXd normalized;
  bool prepared = false;
};

Evaluator::Evaluator(const Scene& scene, std::vector<ObjectiveTerm> terms,
                     const EvaluateSettings& settings, const Requirements& requirements)
    : impl_(std::make_unique<Impl>(scene, std::move(terms), settings, requirements)) {}

Evaluator::~Evaluator() = default;

void Evaluator::prepare(const Observation& observation) {
  impl_->prepared = false;
  impl_->evaluation->prepare(observation);
  impl_->prepared = true;
}

void Evaluator::prepare_drawing(const Observation& observation) {
  impl_->prepared = false;
  impl_->evaluation->prepare_drawing(observation);
  impl_->prepared = true;
}

void Evaluator::prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan) {
  impl_->prepared = false;
  impl_->plan = std::move(plan);
  impl_->frame = looked_at(frame, joined_use(impl_->terms));
  impl_->evaluation->prepare(tiles, impl_->frame, impl_->plan);
  impl_->prepared = true;
}

void Evaluator::Impl::normalize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                Eigen::Index costs) {
  if (!prepared) throw Error("evaluate: no frame has been prepared");
  if (states.rows() != scene.dimension() || costs != states.cols()) {
    throw Error(
        fmt::format("evaluate: found states {} x {} and room for {} costs, expected "
                    "states {} x N and room for N",
                    states.rows(), states.cols(), costs, scene.dimension()));
  }
  normalized = states;
  for (Eigen::Index i = 0; i < states.cols(); ++i) scene.normalize(normalized.col(i));
}

void Evaluator::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                         Eigen::Ref<Eigen::VectorXd> costs) {
  impl_->normalize(states, costs.size());
  impl_->evaluation->evaluate(impl_->normalized, costs);
}

bool Evaluator::has_residuals() const { return impl_->evaluation->has_residuals(); }

Eigen::Index Evaluator::residual_count() const {
  if (!impl_->prepared) throw Error("evaluate: no frame has been prepared");
  return impl_->evaluation->residual_count();
}

std::vector<ResidualRows> Evaluator::pose_only_residuals() const {
  return impl_->evaluation->pose_only_residuals();
}

void Evaluator::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                         Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) {
  impl_->normalize(states, costs.size());
  if (residuals.rows() != residual_count() || residuals.cols() != states.cols()) {
    throw Error(fmt::format("evaluate: found room for {} x {} residuals, expected {} x {}",
                            residuals.rows(), residuals.cols(), residual_count(), states.cols()));
  }
  impl_->evaluation->evaluate_residuals(impl_->normalized, residuals, costs);
}

ResidualDifferences* Evaluator::differences() {
  return impl_->evaluation->differences() ? impl_.get() : nullptr;
}

bool Evaluator::can_linearize() const { return impl_->evaluation->can_linearize(); }

NormalEquations Evaluator::linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                     const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) {
  impl_->normalize(states, steps.size() + 1);
  return impl_->evaluation->linearize(impl_->normalized, steps, blur);
}

bool Evaluator::on_device() const { return impl_->evaluation->on_device(); }

cuda::DeviceCost* Evaluator::device_cost(const Eigen::VectorXd& prior, bool rotation_vectors) {
  if (!impl_->prepared) throw Error("evaluate: no frame has been prepared");
  return impl_->evaluation->device_cost(prior, rotation_vectors);
}

std::string Evaluator::backend() const { return impl_->evaluation->description(); }

}  // namespace hypotrack
