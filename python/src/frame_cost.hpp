#pragma once

#include <atomic>
#include <memory>

#include "arrays.hpp"
#include "hypotrack/api/frame_cost.hpp"

namespace hypotrack::python {

/// The cost of states in a frame, owned by Python.
class PythonFrameCost {
 public:
  explicit PythonFrameCost(FrameCost cost)
      : cost_(std::make_unique<FrameCost>(std::move(cost))),
        scene_(std::make_shared<Scene>(cost_->scene())) {}
  ~PythonFrameCost() { end_without_gil(cost_); }
  PythonFrameCost(const PythonFrameCost&) = delete;
  PythonFrameCost& operator=(const PythonFrameCost&) = delete;

  /// Calls a function of the cost without the GIL, unless another call goes on.
  template <class Function>
  auto call(const Function& function) {
    const Busy busy(busy_, "cost");
    return without_gil([&] { return function(*cost_); });
  }
  const FrameCost& cost() const { return *cost_; }
  const std::shared_ptr<Scene>& scene() const { return scene_; }
  Eigen::Index dimension() const { return scene_->dimension(); }

 private:
  std::unique_ptr<FrameCost> cost_;
  std::shared_ptr<Scene> scene_;
  std::atomic<bool> busy_ = false;
};

}  // namespace hypotrack::python
