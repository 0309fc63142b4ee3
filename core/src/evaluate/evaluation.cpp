#include "evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cuda/egl_cuda_evaluation.hpp"
#include "evaluate/term_residuals.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

/// An evaluation on the CPU, with the reason why it is not on the GPU.
class FallenBack final : public Evaluation {
 public:
  FallenBack(std::unique_ptr<Evaluation> host, std::string why)
      : host_(std::move(host)), why_(std::move(why)) {}

  void prepare(const Observation& observation) override { host_->prepare(observation); }
  void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    host_->prepare(tiles, frame, plan);
  }
  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    host_->evaluate(states, costs);
  }
  bool has_residuals() const override { return host_->has_residuals(); }
  Eigen::Index residual_count() const override { return host_->residual_count(); }
  void evaluate_residuals(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) override {
    host_->evaluate_residuals(states, residuals, costs);
  }
  bool can_linearize() const override { return host_->can_linearize(); }
  NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                            double blur) override {
    return host_->linearize(states, steps, blur);
  }
  std::string description() const override {
    return fmt::format("{}; {}", host_->description(), why_);
  }

 private:
  std::unique_ptr<Evaluation> host_;
  std::string why_;
};

constexpr const char* kNeedsResiduals =
    "the optimizer needs residuals, which are computed on the CPU";

std::unique_ptr<Evaluation> fall_back(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                      const EvaluateSettings& settings, std::string why) {
  return std::make_unique<FallenBack>(make_host_evaluation(scene, terms, settings), std::move(why));
}

/// Scored where it is drawn if OpenGL and CUDA share the GPU, otherwise read back.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings, bool residuals) {
  std::string why_not = residuals ? kNeedsResiduals : "";
  if (!residuals) {
    if (auto shared = cuda::make_egl_evaluation(scene, terms, settings, why_not)) return shared;
  }
  return fall_back(scene, terms, settings, "scored on the CPU: " + why_not);
}

std::unique_ptr<Evaluation> make_cuda_evaluation(const Scene& scene,
                                                 const std::vector<ObjectiveTerm>& terms,
                                                 const EvaluateSettings& settings, bool residuals) {
  if (residuals) {
    throw ConfigError(fmt::format(
        "evaluate.backend: cuda: {}. Write `backend: cpu`, or `automatic` to take what there is",
        kNeedsResiduals));
  }
  return cuda::make_evaluation(scene, terms, settings);
}

}  // namespace

void Evaluation::evaluate_residuals(const Eigen::MatrixXd&, Eigen::Ref<Eigen::MatrixXf>,
                                    Eigen::Ref<Eigen::VectorXd>) {
  throw Error("evaluate: this backend has no residuals");
}

NormalEquations Evaluation::linearize(const Eigen::MatrixXd&, const Eigen::VectorXd&, double) {
  throw Error("evaluate: this backend cannot linearise");
}

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings, bool residuals) {
  if (residuals) {
    const std::string why = TermResiduals::why_none(terms);
    if (!why.empty()) throw ConfigError("objective: the optimizer needs residuals: " + why);
  }
  switch (settings.backend) {
    case Backend::cpu:
      return make_host_evaluation(scene, terms, settings);
    case Backend::egl:
      return make_egl_evaluation(scene, terms, settings, residuals);
    case Backend::cuda:
      return make_cuda_evaluation(scene, terms, settings, residuals);
    case Backend::automatic:
      break;
  }
  std::string why = residuals ? kNeedsResiduals : cuda::why_not_evaluated(scene, terms, settings);
  if (why.empty()) return cuda::make_evaluation(scene, terms, settings);
  return fall_back(scene, terms, settings, "not on a GPU: " + why);
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

}  // namespace hypotrack
