#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

/// Hypotheses that an optimizer evaluated together, such as a generation of a swarm.
struct HypothesisBatch {
  Eigen::MatrixXd states;  ///< DxN, states of the scene
  Eigen::VectorXd costs;   ///< N
};

/// One call of the scene's optimizer. Perturbations for numerical Jacobians are not recorded.
struct RecordedSearch {
  std::vector<HypothesisBatch> batches = {};
  bool on_device = false;  ///< hypotheses stayed in GPU memory and are not in `batches`
  Eigen::VectorXd state;   ///< the answer
  double cost = 0;
};

/// A map of a term of the cost.
struct TermMap {
  std::string term;  ///< name of the objective
  PixelMap map;
};

/// How a frame was searched, for outputs that show it.
struct SearchRecord {
  std::vector<RecordedSearch> searches;  ///< in their order; the frame may need several
  Eigen::VectorXd state;    ///< found, before any smoothing; models that are not shown are behind
                            ///< the camera; empty: nothing was found
  Observation observation;  ///< the tiles of the last search; empty: there was none
  std::vector<cv::Mat> depth = {};  ///< of `state` drawn in each tile: 32-bit float z, metres; 0 =
                                    ///< not covered
  std::vector<TermMap> maps = {};   ///< of `state`, by the terms that have maps
};

/// A run as its outputs see it.
class HYPOTRACK_API OutputContext {
 public:
  OutputContext() = default;
  virtual ~OutputContext();
  OutputContext(const OutputContext&) = delete;
  OutputContext& operator=(const OutputContext&) = delete;

  virtual const Scene& scene() const = 0;
  /// Returns the cameras in the order of a frame's views.
  virtual const std::vector<Camera>& cameras() const = 0;
  /// Returns the source's frames per second.
  virtual double frame_rate() const = 0;
  /// Returns true if the run smooths solutions over a fixed lag of later frames.
  virtual bool fixed_lag() const = 0;
  /// Returns the path at which to write the file of this name, one of Output::file_names(). Others
  /// may read the file while it grows. Throws PluginError for other names.
  virtual std::filesystem::path file(const std::string& name) = 0;
  /// Returns the run's renderer, made at the first call. Use it in calls of the output.
  virtual Renderer& renderer() = 0;
  /// Returns the names of the columns that the run's outputs add to track.csv.
  virtual std::vector<std::string> columns() const { return {}; }
  /// Returns a number for each of columns(), NaN where an output knows none.
  virtual std::vector<double> values(const Frame& /*frame*/, const Solution& /*solution*/) {
    return {};
  }
};

/// Writes something of every solution of a run.
///
/// A run calls begin(), then wants_search(), search() if it is wanted, online() and frame() for
/// every frame, then finish(). An output that is destroyed without finish() leaves its files as
/// they are.
/// Calls come one after the other. An output that takes the renderer in begin() gets its frames in
/// another thread, while the next are tracked; wants_search() may then come during another call.
class HYPOTRACK_API Output : public PluginObject {
 public:
  Output() = default;
  ~Output() override;

  /// Returns the names of all files that a run may write, without folders. One # in a name stands
  /// for any number: `worst_#.jpg`. Files of these names from an earlier run are replaced or
  /// removed.
  std::vector<std::string> file_names() const;

  /// Is called before the first frame. `run` lives until the output is destroyed. Throws
  /// OutputError.
  void begin(OutputContext& run);

  /// Returns true to receive how the search of this frame goes. Recording costs time and memory.
  bool wants_search(const Frame& frame) const;

  /// Receives how a frame was searched, with its solution before fixed-lag smoothing. Is called for
  /// frames that were wanted and have views.
  void search(const Frame& frame, const Solution& solution, const SearchRecord& record);

  /// Receives every frame, with its pictures, and its solution before fixed-lag smoothing.
  void online(const Frame& frame, const Solution& solution);

  /// Receives every frame and its final solution, in order. With fixed-lag smoothing it comes some
  /// frames later and without pictures. A missing frame has no views either.
  void frame(const Frame& frame, const Solution& solution);

  /// Returns the names of columns that this output adds to track.csv: letters, digits and _, none
  /// of the table's own names. The answer never changes. An output with columns must not take the
  /// renderer in begin().
  std::vector<std::string> columns() const;
  /// Writes a number for each of columns(); they are NaN before, `nan` in the table. Is called
  /// for every frame before frame(), with the same arguments.
  void values(const Frame& frame, const Solution& solution, std::span<double> values);

  /// Completes the files. `complete` is false if the run was interrupted or an error ended it.
  void finish(bool complete);

 protected:
  // What plugins write: each function as the public one of its name says.
  virtual std::vector<std::string> do_file_names() const = 0;
  virtual void do_begin(OutputContext& run) = 0;
  virtual bool do_wants_search(const Frame& /*frame*/) const { return false; }
  virtual void do_search(const Frame& /*frame*/, const Solution& /*solution*/,
                         const SearchRecord& /*record*/) {}
  virtual void do_online(const Frame& /*frame*/, const Solution& /*solution*/) {}
  virtual void do_frame(const Frame& frame, const Solution& solution) = 0;
  virtual std::vector<std::string> do_columns() const { return {}; }
  virtual void do_values(const Frame& /*frame*/, const Solution& /*solution*/,
                         std::span<double> /*values*/) {}
  virtual void do_finish(bool /*complete*/) {}
};

/// Returns the name of an output's file for one model: `box.bvh` for the model `box` and the
/// extension `bvh`. Throws ConfigError, naming the model, if its name cannot be part of a file's:
/// it holds a slash, a # or a control character.
HYPOTRACK_API std::string model_file_name(const std::string& model, std::string_view extension);

/// Returns true if a model's pose is known: `tracked` or `uncertain`.
HYPOTRACK_API bool pose_known(Status status);

}  // namespace hypotrack
