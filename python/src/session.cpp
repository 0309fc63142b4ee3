#include "hypotrack/api/session.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>

#include "arrays.hpp"
#include "common.hpp"
#include "frame_cost.hpp"
#include "plugins.hpp"
#include "source.hpp"
#include "tracker.hpp"

namespace hypotrack::python {
namespace {

using Path = std::filesystem::path;

/// Returns a mesh of (vertices, triangles) or (vertices, triangles, colors).
MeshArrays mesh_of(const std::string& name, const py::handle& object) {
  const auto fail = [&](const std::string& problem) {
    throw DataError(fmt::format("meshes: {}: {}", name, problem));
  };
  if (!py::isinstance<py::tuple>(object) && !py::isinstance<py::list>(object))
    fail("expected (vertices, triangles) or (vertices, triangles, colors)");
  const auto parts = py::cast<py::sequence>(object);
  if (parts.size() != 2 && parts.size() != 3)
    fail(
        fmt::format("found {} parts, expected (vertices, triangles) or (vertices, triangles, "
                    "colors)",
                    parts.size()));
  MeshArrays mesh;
  mesh.vertices =
      matrix_of_points(numbers_of(parts[0]), (name + ": vertices").c_str()).cast<float>();
  const Eigen::Matrix3Xd indices =
      matrix_of_points(numbers_of(parts[1]), (name + ": triangles").c_str());
  const auto corners = py::cast<py::array>(parts[1]);
  if (corners.dtype().kind() != 'i' && corners.dtype().kind() != 'u')
    fail("triangles: expected an array of integers");
  if ((indices.array().abs() > 1e9).any()) fail("triangles: an index is out of range");
  mesh.triangles = indices.cast<int>();
  if (parts.size() == 2 || parts[2].is_none()) return mesh;
  const Eigen::Matrix3Xd rgb = matrix_of_points(numbers_of(parts[2]), (name + ": colors").c_str());
  const auto colors = py::cast<py::array>(parts[2]);
  if (colors.dtype().kind() != 'u' || colors.itemsize() != 1)
    fail("colors: expected an array of uint8, RGB from 0 to 255");
  mesh.colors = rgb.cast<std::uint8_t>();
  return mesh;
}

/// Follows a run for a Python function, which may end it.
class Callbacks final : public RunWatcher {
 public:
  Callbacks(const py::object& on_frame, const py::object& say, std::shared_ptr<Scene> scene)
      : on_frame_(on_frame), say_(say), scene_(std::move(scene)) {}

  bool stop() override { return stopped_; }
  void say(const std::string& text) override {
    if (say_.get().is_none()) return;
    call([&] { say_.get()(text); });
  }
  void frame(const Frame& frame, const Solution& solution, double error) override {
    if (on_frame_.get().is_none()) return;
    call([&] {
      const py::object answer =
          on_frame_.get()(std::make_shared<Frame>(frame), NamedSolution{solution, scene_}, error);
      py::detail::make_caster<bool> is;  // numpy has a False of its own
      if (is.load(answer, false) && !static_cast<bool>(is)) stopped_ = true;
    });
  }
  bool stopped() const { return stopped_; }
  /// Throws what a function threw, if it did. The caller has the GIL.
  void rethrow() const {
    if (error_) throw py::error_already_set(*error_);
  }

 private:
  template <class Function>
  void call(const Function& function) {
    if (stopped_) return;
    const WithGil acquire;
    try {
      function();
    } catch (py::error_already_set& error) {
      error_ = error;
      stopped_ = true;
    }
  }

  Held on_frame_, say_;
  std::shared_ptr<Scene> scene_;
  std::atomic<bool> stopped_ = false;
  std::optional<py::error_already_set> error_;
};

/// A session that Python owns.
class PythonSession {
 public:
  PythonSession(const py::object& scene, const py::object& set, std::vector<Path> plugin_path,
                const py::dict& meshes, const std::string& name, const Path& directory) {
    SessionOptions options{.set = overrides_of(set), .plugin_path = std::move(plugin_path)};
    options.plugins = registered_plugins();
    for (const auto& [key, value] : meshes) {
      const std::string of = text_of(key, "meshes");
      options.meshes.emplace(of, mesh_of(of, value));
    }
    if (py::isinstance<py::dict>(scene)) {
      const ConfigNode document = value_of(scene, name).document(name, directory);
      session_ = without_gil([&] { return std::make_unique<Session>(document, options); });
    } else {
      if (!py::isinstance<py::str>(scene) && !py::hasattr(scene, "__fspath__"))
        throw ConfigError("scene: expected the path of a file, or a dict; found " +
                          py::cast<std::string>(py::type::of(scene).attr("__name__")));
      const auto file = py::cast<Path>(scene);
      session_ = without_gil([&] { return std::make_unique<Session>(file, options); });
    }
    scene_ = std::make_shared<Scene>(session_->scene());
  }
  ~PythonSession() { end_without_gil(session_); }
  PythonSession(const PythonSession&) = delete;
  PythonSession& operator=(const PythonSession&) = delete;

  std::unique_ptr<PythonTracker> tracker(const std::vector<Camera>& cameras) {
    const Busy busy(busy_, "session");
    return std::make_unique<PythonTracker>(without_gil([&] { return session_->tracker(cameras); }));
  }

  std::unique_ptr<PythonFrameCost> frame_cost(const std::vector<Camera>& cameras) {
    const Busy busy(busy_, "session");
    return std::make_unique<PythonFrameCost>(
        without_gil([&] { return session_->frame_cost(cameras); }));
  }

  std::unique_ptr<PythonSceneSource> source() {
    const Busy busy(busy_, "session");
    return std::make_unique<PythonSceneSource>(without_gil([&] { return session_->source(); }));
  }

  bool run(const std::optional<Path>& out, std::optional<int> frames, const py::object& on_frame,
           const py::object& say) {
    const Busy busy(busy_, "session");
    if (frames && *frames < 1)
      throw ConfigError(fmt::format("frames: expected 1 or more, found {}", *frames));
    Callbacks callbacks(on_frame, say, scene_);
    Interrupts interrupts;
    bool complete = false;
    try {
      complete = without_gil([&] {
        return session_->run({.out = out.value_or(Path()),
                              .frames = frames,
                              .stop_now = [&] { return interrupts(); }},
                             callbacks);
      });
    } catch (...) {
      callbacks.rethrow();  // it came first
      interrupts.rethrow();
      throw;
    }
    callbacks.rethrow();
    interrupts.rethrow();
    if (!complete && !callbacks.stopped()) throw Stopped();  // Ctrl-C within a plugin
    return complete;
  }

  const std::shared_ptr<Scene>& scene() const { return scene_; }

 private:
  static std::vector<std::string> overrides_of(const py::object& set) {
    std::vector<std::string> overrides;
    if (py::isinstance<py::str>(set) || !py::isinstance<py::iterable>(set))
      throw ConfigError(
          fmt::format("set: expected a list of texts `key.path=value`, or a dict of key path to "
                      "value; found {}",
                      py::cast<std::string>(py::type::of(set).attr("__name__"))));
    if (!py::isinstance<py::dict>(set)) {
      for (const py::handle item : set) overrides.push_back(text_of(item, "set"));
      return overrides;
    }
    for (const auto& [key, value] : py::cast<py::dict>(set)) {
      const std::string path = text_of(key, "set");
      const ConfigNode node = value_of(value, "set: " + path).document(path);
      overrides.push_back(fmt::format("{}={}", path, line_of(node)));
    }
    return overrides;
  }
  static std::string text_of(const py::handle& object, const char* what) {
    if (py::isinstance<py::str>(object)) return value_of(object, what).document(what).scalar();
    throw ConfigError(
        fmt::format("{}: expected text, found {}", what, py::cast<std::string>(py::repr(object))));
  }

  std::unique_ptr<Session> session_;
  std::shared_ptr<Scene> scene_;
  std::atomic<bool> busy_ = false;
};

}  // namespace

void add_session(py::module_& module) {
  py::class_<PythonSession>(module, "Session",
                            "A scene, opened: its models, objective and optimizer are made and "
                            "checked.")
      .def(py::init<const py::object&, const py::object&, std::vector<Path>, const py::dict&,
                    const std::string&, const Path&>(),
           py::arg("scene"), py::kw_only(), py::arg("set") = py::list(),
           py::arg("plugin_path") = std::vector<Path>(), py::arg("meshes") = py::dict(),
           py::arg("name") = "scene", py::arg("directory") = Path(),
           "Opens a scene: the path of a file, or a dict with what a file would say. `name` stands "
           "before the key path in messages on a dict, whose relative paths refer to "
           "`directory`.\n\n"
           "set: overrides, a list of `key.path=value` or a dict of key path to value.\n"
           "plugin_path: folders to search before the usual ones.\n"
           "meshes: {name: (vertices, triangles[, colors])} for `mesh: attached:NAME`: float (V, "
           "3), "
           "int (T, 3) counter-clockwise from outside, uint8 RGB (V, 3).\n\n"
           "Raises ConfigError, PluginError, DataError or DeviceError.")
      .def_property_readonly("scene", &PythonSession::scene, "The models that the scene names.")
      .def("tracker", &PythonSession::tracker, py::arg("cameras"),
           "Makes a Tracker for frames from a list of Cameras, the first is the left one. It is "
           "independent of the session.")
      .def("frame_cost", &PythonSession::frame_cost, py::arg("cameras"),
           "Makes a FrameCost for frames from a list of Cameras, which need sizes.")
      .def("source", &PythonSession::source,
           "Opens the scene's own source, for its frames alone. It is independent of the session.")
      .def("run", &PythonSession::run, py::arg("out") = py::none(), py::kw_only(),
           py::arg("frames") = py::none(), py::arg("on_frame") = py::none(),
           py::arg("say") = py::none(),
           "Tracks the frames of the scene's own source. Returns False if a callback ended it.\n\n"
           "out: folder for tables, video and summary; None: no files.\n"
           "frames: stops after this many.\n"
           "on_frame(frame, solution, error): is called for every frame; `error` is the mean "
           "distance of the landmarks from the truth in metres, or NaN. The run ends if it returns "
           "False; what it raises ends it, too, and comes out of run().\n"
           "say(text): receives lines for the user.");
}

}  // namespace hypotrack::python
