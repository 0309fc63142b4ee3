#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/frame_cost.hpp"
#include "session/opened_scene.hpp"
#include "track/search/frame_search.hpp"

namespace hypotrack {

struct FrameCost::Impl {
  /// Takes a scene with all parts but the source. Throws DataError, ConfigError or DeviceError.
  Impl(OpenedScene opened, std::vector<Camera> from);

  /// Returns the cost of the prepared frame. Throws Error if there is none, or if states (DxN) do
  /// not fit.
  Cost& cost_of(const Eigen::Ref<const Eigen::MatrixXd>& states);
  /// Returns its residuals. Throws ConfigError if there are none.
  StateResiduals& residuals();
  /// Makes and prepares the costs of single terms.
  void prepare_terms();

  OpenedScene opened;
  std::vector<Camera> cameras;
  EvaluateSettings evaluate;
  std::vector<ObjectiveTerm> terms;
  std::vector<std::string> names;
  std::vector<double> weights;
  FrameSearch search;
  std::optional<Frame> frame;                 ///< the prepared one; its pictures live as long
  Observation observation;                    ///< of `frame`, for single terms
  std::vector<std::unique_ptr<Cost>> single;  ///< a cost for each term; empty: not made
  bool single_prepared = false;
};

}  // namespace hypotrack
