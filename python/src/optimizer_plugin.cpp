#include "plugins.hpp"
#include "search.hpp"

namespace hypotrack::python {
namespace {

/// An optimizer in Python. Its answer is the best point that it evaluated.
class PythonOptimizer final : public Optimizer {
 public:
  explicit PythonOptimizer(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "minimize"))
        throw PluginError("has no method minimize(self, cost, region, budget, seed)");
      evaluations_ = py::getattr(o, "default_evaluations", py::int_(1000)).cast<std::int64_t>();
      if (evaluations_ < 1) throw PluginError("its default_evaluations are less than 1");
      if (py::getattr(o, "needs_residuals", py::bool_(false)).cast<bool>())
        requirements_.least_squares = true;
      if (py::getattr(o, "needs_jacobian", py::bool_(false)).cast<bool>())
        requirements_ = {.least_squares = true, .jacobian = Linearization::needed};
    });
  }

  Requirements requirements() const override { return requirements_; }
  std::int64_t default_evaluations() const override { return evaluations_; }

  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override {
    check_search(cost, region, budget);
    const auto call = std::make_shared<BudgetedCost>(cost, region, budget);
    call->evaluate(region.start);
    const auto over = [&] {
      call->end();
      if (call->failure()) std::rethrow_exception(call->failure());
    };
    try {
      in_python([&] {
        try {
          object_->get().attr("minimize")(call, region, budget, seed);
        } catch (py::error_already_set& error) {
          if (!error.matches(budget_spent())) throw;
        }
      });
    } catch (...) {
      over();
      throw;
    }
    over();
    return call->best();
  }

 private:
  static py::object budget_spent() {
    return py::module_::import("hypotrack._core").attr("BudgetSpent");
  }

  std::shared_ptr<Held> object_;
  std::int64_t evaluations_ = 1000;
  Requirements requirements_ = {};
};

}  // namespace

std::unique_ptr<Optimizer> python_optimizer(std::shared_ptr<Held> object) {
  return std::make_unique<PythonOptimizer>(std::move(object));
}

}  // namespace hypotrack::python
