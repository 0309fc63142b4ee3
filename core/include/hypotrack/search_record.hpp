#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/objective.hpp"
#include "hypotrack/observation.hpp"

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

}  // namespace hypotrack
