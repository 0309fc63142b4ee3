#include "cost/evaluation.hpp"

#include <fmt/format.h>

#include "cost/cuda/egl_cuda_evaluation.hpp"
#include "cost/linearizer.hpp"
#include "cost/term_residuals.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr const char* kAnalytic =
    "the optimizer takes analytic Jacobians, which are computed on the CPU";

/// Scored where it is drawn if OpenGL and CUDA share the GPU, otherwise read back.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings,
                                                const ResidualUse& use) {
  std::string why_not = "the optimizer needs residuals, which the GPU has only of what CUDA draws";
  if (!use.wanted) {
    if (auto shared = cuda::make_egl_evaluation(scene, terms, settings, why_not)) return shared;
  }
  return make_host_evaluation(scene, terms, settings, "scored on the CPU: " + why_not);
}

std::unique_ptr<Evaluation> make_cuda_evaluation(const Scene& scene,
                                                 const std::vector<ObjectiveTerm>& terms,
                                                 const EvaluateSettings& settings,
                                                 const ResidualUse& use) {
  if (use.wanted && use.linearization == Linearization::needed) {
    throw ConfigError(fmt::format(
        "evaluate.backend: cuda: {}. Write `jacobian: auto` or `numerical` in the optimizer, "
        "or `backend: cpu`",
        kAnalytic));
  }
  return cuda::make_evaluation(scene, terms, settings, use.wanted);
}

}  // namespace

void Evaluation::evaluate_residuals(const Eigen::MatrixXd&, Eigen::Ref<Eigen::MatrixXf>,
                                    Eigen::Ref<Eigen::VectorXd>) {
  throw Error("evaluate: this backend has no residuals");
}

NormalEquations Evaluation::linearize(const Eigen::MatrixXd&, const Eigen::VectorXd&, double) {
  throw Error("evaluate: this backend cannot linearise");
}

std::string why_automatic_on_cpu(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                 const EvaluateSettings& settings, const ResidualUse& use) {
  if (use.wanted &&
      (use.linearization == Linearization::needed ||
       (use.linearization == Linearization::welcome && Linearizer::can_linearize(terms)))) {
    return kAnalytic;
  }
  return cuda::why_not_evaluated(scene, terms, settings, use.wanted);
}

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings,
                                            const ResidualUse& use) {
  if (use.wanted) {
    const std::string why = TermResiduals::why_none(terms);
    if (!why.empty()) throw ConfigError("objective: the optimizer needs residuals: " + why);
  }
  switch (settings.backend) {
    case Backend::cpu:
      return make_host_evaluation(scene, terms, settings);
    case Backend::egl:
      return make_egl_evaluation(scene, terms, settings, use);
    case Backend::cuda:
      return make_cuda_evaluation(scene, terms, settings, use);
    case Backend::automatic:
      break;
  }
  const std::string why = why_automatic_on_cpu(scene, terms, settings, use);
  if (why.empty()) return cuda::make_evaluation(scene, terms, settings, use.wanted);
  return make_host_evaluation(scene, terms, settings, "not on a GPU: " + why);
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

}  // namespace hypotrack
