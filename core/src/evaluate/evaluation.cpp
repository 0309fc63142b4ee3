#include "evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

/// `automatic` on the CPU, with the reason.
class FallenBack final : public Evaluation {
 public:
  FallenBack(std::unique_ptr<Evaluation> host, std::string why)
      : host_(std::move(host)), why_(std::move(why)) {}

  void prepare(const Observation& observation) override { host_->prepare(observation); }
  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    host_->evaluate(states, costs);
  }
  std::string description() const override {
    return fmt::format("{}; not on a GPU: {}", host_->description(), why_);
  }

 private:
  std::unique_ptr<Evaluation> host_;
  std::string why_;
};

}  // namespace

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings) {
  switch (settings.backend) {
    case Backend::cpu:
    case Backend::egl:
      return make_host_evaluation(scene, terms, settings);
    case Backend::cuda:
      return cuda::make_evaluation(scene, terms, settings);
    case Backend::automatic:
      break;
  }
  std::string why = cuda::why_not_evaluated(scene, terms, settings);
  if (why.empty()) return cuda::make_evaluation(scene, terms, settings);
  return std::make_unique<FallenBack>(make_host_evaluation(scene, terms, settings), std::move(why));
}

void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what) {
  throw Error(
      fmt::format("evaluate: objective {} {} for hypothesis {} of the batch; this is a bug in "
                  "the objective: costs are numbers or +infinity",
                  term.name, what, index));
}

}  // namespace hypotrack
