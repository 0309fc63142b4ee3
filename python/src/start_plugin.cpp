#include <pybind11/stl.h>

#include "arrays.hpp"
#include "hypotrack/plugin/start.hpp"
#include "plugins.hpp"

namespace hypotrack::python {
namespace {

/// A start in Python: it looks for models if it has a method find().
class PythonStart final : public Start {
 public:
  explicit PythonStart(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      looks_ = py::hasattr(o, "find");
      if (!looks_ && !py::hasattr(o, "state"))
        throw PluginError(
            "has no method find(self, frame, cameras, model) or state(self, frame, cameras)");
      recognizes_ = py::getattr(o, "recognizes", py::bool_(false)).cast<bool>();
    });
  }

 private:
  bool do_looks() const override { return looks_; }
  bool do_recognizes(std::size_t /*model*/) const override { return recognizes_; }

  std::optional<Eigen::VectorXd> do_state(const StartContext& context) override {
    return in_python([&]() -> std::optional<Eigen::VectorXd> {
      const py::object answer = object_->get().attr("state")(frame_of(context), context.cameras);
      if (!answer.is_none()) return vector_of(py::cast<Doubles>(answer), "its state");
      if (context.frame) throw PluginError("its state() returned None although there is a frame");
      return std::nullopt;
    });
  }

  void do_find(const StartContext& context, std::size_t model, const TakePose& take) override {
    in_python([&] {
      const py::object poses = object_->get().attr("find")(frame_of(context), context.cameras,
                                                           context.scene.items()[model].name);
      if (poses.is_none()) return;
      for (const py::handle pose : poses) {
        const Eigen::VectorXd parameters = vector_of(py::cast<Doubles>(pose), "a pose of find()");
        if (!without_gil([&] { return take(parameters); })) return;  // it may search
      }
    });
  }

  static py::object frame_of(const StartContext& context) {
    if (!context.frame) return py::none();
    return py::cast(std::make_shared<Frame>(*context.frame));
  }

  std::shared_ptr<Held> object_;
  bool looks_ = false, recognizes_ = false;
};

}  // namespace

std::unique_ptr<Start> python_start(std::shared_ptr<Held> object) {
  return std::make_unique<PythonStart>(std::move(object));
}

}  // namespace hypotrack::python
