// Tracks a mesh that is in memory through pictures that the program makes, without any file.
#include <cstdio>
#include <exception>
#include <hypotrack/api/config_value.hpp>
#include <hypotrack/api/renderer.hpp>
#include <hypotrack/api/session.hpp>

using Value = hypotrack::ConfigValue;

int main() try {
  hypotrack::MeshArrays box;  // 60 x 90 x 40 mm, a colour at each corner
  box.vertices.resize(3, 8);
  box.colors.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    box.vertices.col(i) << (i & 1 ? 30 : -30), (i & 2 ? 45 : -45), (i & 4 ? 20 : -20);
    box.colors.col(i) << (i & 1 ? 250 : 20), (i & 2 ? 240 : 30), (i & 4 ? 230 : 40);
  }
  box.triangles.resize(3, 12);
  box.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,               //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  const auto box_model = Value::map(
      {{"name", "box"}, {"type", "rigid_mesh"}, {"mesh", "attached:box"}, {"units", "mm"}});
  const auto start = Value::map({{"position_mm", Value::list({0, 0, 400})}});
  const auto scene = Value::map({{"models", Value::list({box_model})},
                                 {"tracker", "@trackers/rigid"},
                                 {"init", Value::map({{"pose", Value::map({{"box", start}})}})}});
  hypotrack::Session session(scene.document("box in memory"), {.meshes = {{"box", box}}});

  hypotrack::Camera left{.width = 640, .height = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240};
  hypotrack::Camera right = left;
  right.camera_from_world.translation().x() = -0.1;  // 10 cm to the right of the left one
  hypotrack::Tracker tracker = session.tracker({left, right});
  hypotrack::Renderer renderer(session.scene());
  Eigen::VectorXd truth = session.scene().rest_state();  // x y z in metres, quaternion w x y z
  for (int i = 0; i < 10; ++i) {
    truth.head<7>() << 0.003 * i, 0, 0.4, 1, 0.02 * i, 0.1 + 0.03 * i, 0;
    hypotrack::Frame frame{.index = i, .time = i / 30.0};
    for (const auto& camera : {left, right})
      frame.views.push_back({.color = renderer.render(truth, camera, {}).color});
    const hypotrack::Solution solution = tracker.track(frame);
    const Eigen::Matrix3Xd error = solution.landmarks - session.scene().landmarks(truth);
    std::printf("frame %d: %s, %.1f mm off\n", i, std::string(to_string(solution.status)).c_str(),
                1000 * error.colwise().norm().mean());
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "track_mesh_in_memory: %s\n", e.what());
  return 1;
}
