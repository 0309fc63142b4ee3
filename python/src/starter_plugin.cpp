#include <pybind11/stl.h>

#include "arrays.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "plugins.hpp"

namespace hypotrack::python {
namespace {

/// A starter in Python: it looks for models if it has a method find().
class PythonStarter final : public Starter {
 public:
  explicit PythonStarter(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      looks_ = py::hasattr(o, "find");
      if (!looks_ && !py::hasattr(o, "state"))
        throw PluginError(
            "has no method find(self, frame, cameras, model) or state(self, frame, cameras)");
      detects_ = py::getattr(o, "detects", py::bool_(false)).cast<bool>();
    });
  }

 private:
  bool do_looks() const override { return looks_; }
  bool do_detects(std::size_t /*model*/) const override { return detects_; }

  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    return in_python([&]() -> std::optional<Eigen::VectorXd> {
      const py::object answer = object_->get().attr("state")(frame_of(context), context.cameras);
      if (!answer.is_none()) return vector_of(numbers_of(answer), "its state");
      if (context.frame) throw PluginError("its state() returned None although there is a frame");
      return std::nullopt;
    });
  }

  void do_find(const StarterContext& context, std::size_t model, const TakePose& take) override {
    in_python([&] {
      const py::object poses = object_->get().attr("find")(frame_of(context), context.cameras,
                                                           context.scene.items()[model].name);
      if (poses.is_none()) return;
      for (const py::handle pose : poses) {
        const Eigen::VectorXd parameters = vector_of(numbers_of(pose), "a pose of find()");
        if (!without_gil([&] { return take(parameters); })) return;  // it may search
      }
    });
  }

  static py::object frame_of(const StarterContext& context) {
    if (!context.frame) return py::none();
    return py::cast(std::make_shared<Frame>(*context.frame));
  }

  std::shared_ptr<Held> object_;
  bool looks_ = false, detects_ = false;
};

}  // namespace

std::unique_ptr<Starter> python_starter(std::shared_ptr<Held> object) {
  return std::make_unique<PythonStarter>(std::move(object));
}

}  // namespace hypotrack::python
