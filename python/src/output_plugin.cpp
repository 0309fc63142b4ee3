#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "hypotrack/plugin/output.hpp"
#include "plugins.hpp"
#include "tracker.hpp"

namespace hypotrack::python {
namespace {

/// An output in Python.
class PythonOutput final : public Output {
 public:
  explicit PythonOutput(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "frame")) throw PluginError("has no method frame(self, frame, solution)");
      names_ = py::getattr(o, "file_names", py::list()).cast<std::vector<std::string>>();
    });
  }

 private:
  std::vector<std::string> do_file_names() const override { return names_; }

  void do_begin(OutputContext& run) override {
    scene_ = std::make_shared<Scene>(run.scene());
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    for (const std::string& name : names_)
      if (name.find('#') == std::string::npos) files.emplace_back(name, run.file(name));
    in_python([&] {
      if (!py::hasattr(object_->get(), "begin")) return;
      py::dict paths;
      for (const auto& [name, file] : files) paths[py::str(name)] = file;
      object_->get().attr("begin")(paths);
    });
  }

  void do_frame(const Frame& frame, const Solution& solution) override {
    in_python([&] {
      object_->get().attr("frame")(std::make_shared<Frame>(frame), NamedSolution{solution, scene_});
    });
  }

  void do_finish(bool complete) override {
    in_python([&] {
      if (py::hasattr(object_->get(), "finish")) object_->get().attr("finish")(complete);
    });
  }

  std::shared_ptr<Held> object_;
  std::shared_ptr<Scene> scene_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<Output> python_output(std::shared_ptr<Held> object) {
  return std::make_unique<PythonOutput>(std::move(object));
}

}  // namespace hypotrack::python
