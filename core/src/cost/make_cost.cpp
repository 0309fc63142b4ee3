#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "cost/backends.hpp"
#include "cost/linearize/host_linearizer.hpp"
#include "cost/split_cost.hpp"
#include "cost/term_residuals.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
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

/// Returns why `backend: auto` evaluates these terms on the CPU; empty if it uses the GPU.
std::string why_automatic_on_cpu(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                 const EvaluateSettings& settings,
                                 const Requirements& requirements) {
  if (requirements.least_squares && requirements.jacobian != Linearization::unused) {
    const bool needed = requirements.jacobian == Linearization::needed;
    const bool better =
        HostLinearizer::can_linearize(terms) && !HostLinearizer::draws_neighbours(terms);
    std::string why;
    if (needed) why = cuda::why_not_linearized(terms);
    if (why.empty() && !requirements.device && better) why = cuda::why_neighbours_are_drawn(terms);
    if (!why.empty()) return "the optimizer takes analytic Jacobians, and " + why;
  }
  return cuda::why_not_evaluated(scene, split_terms(terms, requirements.least_squares).gpu,
                                 settings, requirements.least_squares);
}

/// Evaluates with CUDA, and on the CPU what needs no rendering and has no part for a GPU.
std::unique_ptr<Cost> make_cuda_cost(const Scene& scene, const SplitTerms& terms,
                                     const EvaluateSettings& settings, bool residuals) {
  auto on_gpu = cuda::make_cost(scene, terms.gpu, settings, residuals);
  if (terms.cpu.empty()) return on_gpu;
  std::string backend = on_gpu->backend() + "; on the CPU: " + terms.cpu_names();
  return make_split_cost(scene, terms, std::move(on_gpu),
                         make_host_cost(scene, terms.cpu, settings), std::move(backend));
}

/// Returns what the terms and the backend offer; `on_gpu` says whether CUDA evaluates the terms.
CostOffer offer_of(const std::vector<ObjectiveTerm>& terms, const Requirements& requirements,
                   Backend backend, bool on_gpu) {
  constexpr const char* kInstead = ". Write `jacobian: auto` or `numerical` in the optimizer";
  CostOffer offer{.no_least_squares = TermResiduals::why_none(terms), .device = on_gpu};
  const SplitTerms split = split_terms(terms, requirements.least_squares);
  if (on_gpu && !split.cpu.empty()) {
    offer.device = false;
    offer.no_device =
        fmt::format("these terms are evaluated on the CPU: {}. Leave them out", split.cpu_names());
  }
  if (backend == Backend::cuda) {
    if (const std::string why = cuda::why_not_linearized(terms); !why.empty()) {
      offer.no_jacobian = fmt::format("{}{}, or `backend: cpu`", why, kInstead);
    }
  } else if (!HostLinearizer::can_linearize(terms)) {
    offer.no_jacobian = fmt::format(
        "no term that needs rendering has slopes or a Jacobian of its residuals{}", kInstead);
  }
  return offer;
}

/// Draws with OpenGL and scores on the GPU if OpenGL and CUDA share it, else reads back.
std::unique_ptr<Cost> make_egl_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                    const EvaluateSettings& settings,
                                    const Requirements& requirements) {
  std::string why_not = "the optimizer needs residuals, which the GPU has only of what CUDA draws";
  if (!requirements.least_squares) {
    if (auto shared = cuda::make_egl_cost(scene, terms, settings, why_not)) return shared;
  }
  return make_host_cost(scene, std::move(terms), settings, "scored on the CPU: " + why_not);
}

}  // namespace

std::span<const std::string_view> enum_names(Backend) {
  static constexpr std::array<std::string_view, 4> kNames{"auto", "cpu", "egl", "cuda"};
  return kNames;
}

std::span<const std::string_view> enum_names(OnDeviceLoss) {
  static constexpr std::array<std::string_view, 2> kNames{"stop", "cpu"};
  return kNames;
}

std::unique_ptr<Cost> make_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                const EvaluateSettings& settings,
                                const Requirements& requirements) {
  terms = checked(std::move(terms));
  const bool automatic = settings.backend == Backend::automatic;
  const std::string why_on_cpu =
      automatic ? why_automatic_on_cpu(scene, terms, settings, requirements) : std::string();
  const bool with_cuda = automatic ? why_on_cpu.empty() : settings.backend == Backend::cuda;
  check_requirements(requirements, offer_of(terms, requirements, settings.backend, with_cuda));
  const bool residuals = requirements.least_squares;
  if (with_cuda) return make_cuda_cost(scene, split_terms(terms, residuals), settings, residuals);
  if (settings.backend == Backend::egl) {
    return make_egl_cost(scene, std::move(terms), settings, requirements);
  }
  return make_host_cost(scene, std::move(terms), settings,
                        automatic ? "not on a GPU: " + why_on_cpu : std::string());
}

bool evaluates_with_cuda(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                         const EvaluateSettings& settings, const Requirements& requirements) {
  if (settings.backend == Backend::automatic) {
    return why_automatic_on_cpu(scene, terms, settings, requirements).empty();
  }
  const bool residuals = requirements.least_squares;
  return settings.backend == Backend::cuda &&
         cuda::why_not_evaluated(scene, split_terms(terms, residuals).gpu, settings, residuals)
             .empty();
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

void check_room(const Eigen::Ref<const Eigen::MatrixXf>& residuals, Eigen::Index rows,
                Eigen::Index columns) {
  if (residuals.rows() == rows && residuals.cols() == columns) return;
  throw Error(fmt::format("evaluate: found room for {} x {} residuals, expected {} x {}",
                          residuals.rows(), residuals.cols(), rows, columns));
}

}  // namespace hypotrack::internal
