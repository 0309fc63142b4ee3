// The module hypotrack._core, which the package hypotrack offers to users.

#include "common.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace hypotrack::python;
  module.doc() = "3D tracking of hands and objects.";
  module.attr("version") = HYPOTRACK_VERSION;
  add_errors(module);
  add_scene(module);
  add_cameras(module);
  add_frames(module);
  add_solution(module);
  add_frame_cost(module);
  add_renderer(module);
  add_metrics(module);
  add_search(module);
  add_objective(module);
  add_judge(module);
  add_plugins(module);
  add_tracker(module);
  add_source(module);
  add_session(module);
}
