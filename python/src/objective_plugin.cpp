#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "arrays.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "plugins.hpp"

namespace hypotrack::python {
namespace {

/// Hypotheses of one call, in arrays that Python owns.
struct Hypotheses {
  py::array_t<double> states;     ///< (N, D)
  std::vector<py::array> depths;  ///< of each view: 1/z, (N, H, W)
};

Hypotheses copy_of(std::span<const RenderedHypothesis> all) {
  Hypotheses out;
  const auto count = static_cast<py::ssize_t>(all.size());
  const auto size = static_cast<py::ssize_t>(all.front().state.size());
  out.states = py::array_t<double>({count, size});
  for (std::size_t i = 0; i < all.size(); ++i)
    std::memcpy(out.states.mutable_data(static_cast<py::ssize_t>(i)), all[i].state.data(),
                all[i].state.size_bytes());
  for (std::size_t v = 0; v < all.front().views.size(); ++v) {
    const DepthTile& first = all.front().views[v];
    py::array_t<float> depths({count, py::ssize_t{first.height}, py::ssize_t{first.width}});
    for (std::size_t i = 0; i < all.size(); ++i) {
      const DepthTile& tile = all[i].views[v];
      float* to = depths.mutable_data(static_cast<py::ssize_t>(i));
      for (int y = 0; y < tile.height; ++y)
        std::memcpy(to + static_cast<std::ptrdiff_t>(y) * tile.width,
                    tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride,
                    sizeof(float) * static_cast<std::size_t>(tile.width));
    }
    out.depths.push_back(depths);
  }
  return out;
}

/// Returns what an objective reads: a text, or several.
ImageUse uses_of(const py::object& reads) {
  constexpr std::array kNames = {
      std::pair("color", &ImageUse::color), std::pair("mask", &ImageUse::mask),
      std::pair("depth", &ImageUse::depth), std::pair("background", &ImageUse::background)};
  ImageUse use;
  for (const auto& entry : kNames) use.*entry.second = false;
  for (const py::handle item : py::isinstance<py::str>(reads) ? py::make_tuple(reads) : reads) {
    const auto name = py::cast<std::string>(py::str(item));
    const auto* found = std::ranges::find(
        kNames, name, [](const auto& entry) { return std::string_view(entry.first); });
    if (found == kNames.end())
      throw PluginError(
          fmt::format("its `reads` has '{}'; expected color, mask, depth or background", name));
    use.*found->second = true;
  }
  return use;
}

/// An objective in Python. It needs no rendering if its class says so.
class PythonObjective final : public Objective {
 public:
  explicit PythonObjective(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "costs")) throw PluginError("has no method costs(self, hypotheses)");
      draws_ = py::getattr(o, "needs_rendering", py::bool_(true)).cast<bool>();
      most_ = py::getattr(o, "most_at_once", py::int_(64)).cast<int>();
      if (most_ < 1) throw PluginError("its most_at_once is less than 1");
      if (py::hasattr(o, "reads")) use_ = uses_of(o.attr("reads"));
      prepares_ = py::hasattr(o, "prepare");
    });
  }

 private:
  bool do_needs_rendering() const override { return draws_; }
  ImageUse do_image_use() const override { return use_; }
  int do_most_at_once() const override { return most_; }

  void do_prepare(const Observation& observation) override {
    if (!prepares_) return;
    // A copy that Python may keep: pictures are shared and counted.
    const auto kept = std::make_shared<Observation>(observation);
    kept->scene = nullptr;
    in_python([&] { object_->get().attr("prepare")(kept); });
  }

  double do_cost(const RenderedHypothesis& hypothesis) const override {
    double cost = 0;
    do_costs({&hypothesis, 1}, {&cost, 1});
    return cost;
  }

  void do_costs(std::span<const RenderedHypothesis> hypotheses,
                std::span<double> costs) const override {
    if (hypotheses.empty()) return;
    in_python([&] {
      const py::object answer = object_->get().attr("costs")(copy_of(hypotheses));
      const Numbers numbers = numbers_of(answer);
      if (numbers.ndim() != 1 || numbers.shape(0) != std::ssize(costs))
        throw PluginError(
            numbers.problem("what its costs() returned", fmt::format("({},)", costs.size())));
      std::memcpy(costs.data(), numbers.data(), costs.size_bytes());
    });
  }

  std::shared_ptr<Held> object_;
  bool draws_ = true, prepares_ = false;
  int most_ = 64;
  ImageUse use_ = {};
};

py::array matrix_of_tile(const TileCamera& camera) {
  Eigen::Matrix3d k;
  k << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return rows_of<double>(Eigen::MatrixXd(k.transpose()));
}

}  // namespace

std::unique_ptr<Objective> python_objective(std::shared_ptr<Held> object) {
  return std::make_unique<PythonObjective>(std::move(object));
}

void add_objective(py::module_& module) {
  py::class_<Hypotheses>(module, "Hypotheses", "N hypotheses, posed and drawn.")
      .def_readonly("states", &Hypotheses::states, "Normalised states (N, D).")
      .def_readonly("inverse_depths", &Hypotheses::depths,
                    "For each view float32 (N, H, W): 1/z in 1/m of the nearest surface, 0 where "
                    "nothing is drawn. Empty without rendering.")
      .def("__len__", [](const Hypotheses& h) { return h.states.shape(0); });
  py::class_<TileView>(module, "TileView", "A square crop of a view around the last solution.")
      .def_property_readonly(
          "color", [](const TileView& v) { return array_of(v.color); },
          "uint8 (H, W, 3) BGR, or None.")
      .def_property_readonly(
          "valid", [](const TileView& v) { return array_of(v.valid); },
          "uint8 (H, W), not 0 where the pixel lies in the picture.")
      .def_property_readonly(
          "mask", [](const TileView& v) { return array_of(v.mask); },
          "uint8 (H, W), not 0 in the foreground, or None.")
      .def_property_readonly(
          "depth", [](const TileView& v) { return array_of(v.depth); },
          "float32 (H, W), metres, 0 where nothing was measured, or None.")
      .def_property_readonly(
          "background", [](const TileView& v) { return array_of(v.background); },
          "uint8 (H, W, 4): BGR without the models, and 255 where it is known; or None.")
      .def_property_readonly(
          "matrix", [](const TileView& v) { return matrix_of_tile(v.camera); },
          "Matrix (3, 3) of the tile's pinhole camera.")
      .def_property_readonly(
          "camera_from_world",
          [](const TileView& v) {
            return rows_of<double>(
                Eigen::MatrixXd(v.camera.camera_from_world.matrix().transpose()));
          },
          "Pose (4, 4) of the tile's camera, metres.");
  py::class_<Observation, std::shared_ptr<Observation>>(module, "Observation",
                                                        "The tiles of one frame.")
      .def_readonly("frame", &Observation::frame)
      .def_readonly("time", &Observation::time, "Seconds.")
      .def_property_readonly(
          "start", [](const Observation& o) { return array_of(o.start); },
          "State (D,) that the tiles were cropped around.")
      .def_readonly("views", &Observation::views, "A TileView for each camera.")
      .def_readonly("rectified", &Observation::rectified,
                    "Whether a point has the same row in both views.")
      .def_property_readonly("start_is_guess",
                             [](const Observation& o) { return o.context.start_is_guess; })
      .def_property_readonly(
          "previous_state",
          [](const Observation& o) -> py::object {
            if (!o.context.previous) return py::none();
            return array_of(o.context.previous->state);
          },
          "State (D,) of the last answer, or None.")
      .def_property_readonly(
          "seconds_since_previous",
          [](const Observation& o) { return o.context.seconds_since_previous; },
          "NaN without a last answer.");
}

}  // namespace hypotrack::python
