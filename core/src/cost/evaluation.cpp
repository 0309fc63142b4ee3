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

/// Makes the OpenGL evaluation: scores on the GPU if OpenGL and CUDA share it, else reads back.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings,
                                                const Requirements& requirements) {
  std::string why_not = "the optimizer needs residuals, which the GPU has only of what CUDA draws";
  if (!requirements.least_squares) {
    if (auto shared = cuda::make_egl_evaluation(scene, terms, settings, why_not)) return shared;
  }
  return make_host_evaluation(scene, terms, settings, "scored on the CPU: " + why_not);
}

/// Returns what the terms and the backend offer; `on_gpu` says whether CUDA evaluates the terms.
CostOffer offer_of(const std::vector<ObjectiveTerm>& terms, Backend backend, bool on_gpu) {
  constexpr const char* kInstead = ". Write `jacobian: auto` or `numerical` in the optimizer";
  CostOffer offer{.no_least_squares = TermResiduals::why_none(terms), .device = on_gpu};
  if (backend == Backend::cuda) {
    offer.no_jacobian = fmt::format("evaluate.backend is cuda{}, or `backend: cpu`", kInstead);
  } else if (!Linearizer::can_linearize(terms)) {
    offer.no_jacobian = fmt::format("a term has no slopes of its residuals{}", kInstead);
  }
  return offer;
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
                                 const EvaluateSettings& settings,
                                 const Requirements& requirements) {
  if (requirements.least_squares &&
      (requirements.jacobian == Linearization::needed ||
       (requirements.jacobian == Linearization::welcome && Linearizer::can_linearize(terms)))) {
    return kAnalytic;
  }
  return cuda::why_not_evaluated(scene, terms, settings, requirements.least_squares);
}

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings,
                                            const Requirements& requirements) {
  const bool automatic = settings.backend == Backend::automatic;
  const std::string why_on_cpu =
      automatic ? why_automatic_on_cpu(scene, terms, settings, requirements) : std::string();
  const bool on_gpu = automatic ? why_on_cpu.empty() : settings.backend == Backend::cuda;
  check_requirements(requirements, offer_of(terms, settings.backend, on_gpu));
  if (on_gpu) return cuda::make_evaluation(scene, terms, settings, requirements.least_squares);
  if (settings.backend == Backend::egl) {
    return make_egl_evaluation(scene, terms, settings, requirements);
  }
  return make_host_evaluation(scene, terms, settings,
                              automatic ? "not on a GPU: " + why_on_cpu : std::string());
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

}  // namespace hypotrack
