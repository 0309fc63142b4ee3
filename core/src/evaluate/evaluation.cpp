#include "evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cuda/egl_cuda_evaluation.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

/// An evaluation on the CPU, with the reason why it is not on the GPU.
class FallenBack final : public Evaluation {
 public:
  FallenBack(std::unique_ptr<Evaluation> host, std::string why)
      : host_(std::move(host)), why_(std::move(why)) {}

  using Evaluation::prepare;
  void prepare(const Observation& observation) override { host_->prepare(observation); }
  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    host_->evaluate(states, costs);
  }
  std::string description() const override {
    return fmt::format("{}; {}", host_->description(), why_);
  }

 private:
  std::unique_ptr<Evaluation> host_;
  std::string why_;
};

/// Scored where it is drawn if OpenGL and CUDA share the GPU, otherwise read back.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings) {
  std::string why_not;
  if (auto shared = cuda::make_egl_evaluation(scene, terms, settings, why_not)) return shared;
  return std::make_unique<FallenBack>(make_host_evaluation(scene, terms, settings),
                                      "scored on the CPU: " + why_not);
}

}  // namespace

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings) {
  switch (settings.backend) {
    case Backend::cpu:
      return make_host_evaluation(scene, terms, settings);
    case Backend::egl:
      return make_egl_evaluation(scene, terms, settings);
    case Backend::cuda:
      return cuda::make_evaluation(scene, terms, settings);
    case Backend::automatic:
      break;
  }
  std::string why = cuda::why_not_evaluated(scene, terms, settings);
  if (why.empty()) return cuda::make_evaluation(scene, terms, settings);
  return std::make_unique<FallenBack>(make_host_evaluation(scene, terms, settings),
                                      "not on a GPU: " + why);
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

}  // namespace hypotrack
