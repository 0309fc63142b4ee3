#pragma once

#include <Eigen/Core>
#include <iosfwd>

#include "cost/cost.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "session/opened_scene.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::test {

/// How the two cameras stand that take a scene's pictures.
enum class Rig {
  rectified,  ///< side by side, as the scene has them
  general,    ///< turned towards each other by 40 degrees, too much to be rectified
};

/// What a search looks at.
struct RecordedCase {
  const char* scene;  ///< one of configs/, without its extension
  const char* objective;
  Rig rig;
  int tile;  ///< pixels along one side
};
/// `demo_stereo_color_rectified_128`
std::ostream& operator<<(std::ostream& out, const RecordedCase& c);

/// Every hypothesis that a particle swarm of 32 x 32 evaluates on the CPU in the first frame of a
/// scene. The search starts from the truth, which the tiles are cut around.
class RecordedSearch {
 public:
  /// Renders the frame; throws DeviceError where there is no OpenGL for that.
  explicit RecordedSearch(const RecordedCase& c);
  RecordedSearch(const RecordedSearch&) = delete;
  RecordedSearch& operator=(const RecordedSearch&) = delete;

  bool rectified() const { return tiles_.rectifies(); }
  /// The hypotheses, one per column, the truth first.
  const Eigen::MatrixXd& states() const { return states_; }
  /// What the search was told that they cost.
  const Eigen::VectorXd& costs() const { return costs_; }
  /// What they cost on a backend, all in one batch. The tiles are cut there.
  Eigen::VectorXd costs_on(Backend backend) const;

 private:
  std::unique_ptr<Cost> cost_on(Backend backend) const;
  void record();

  PluginLoader plugins_;
  OpenedScene session_;
  TileMaker tiles_;
  Frame frame_;
  Eigen::MatrixXd states_;
  Eigen::VectorXd costs_;
};

}  // namespace hypotrack::test
