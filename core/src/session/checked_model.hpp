#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Wraps a plugin's model: names it in what it throws and where it crashes, and checks the points
/// that it poses.
class CheckedModel final : public Model {
 public:
  /// `who`: plugin_label() of the model.
  CheckedModel(std::shared_ptr<const Model> model, std::string who);

  bool poses_itself() const override { return poses_itself_; }
  /// Throws PluginError if the number of points is another than in data(), or one is not finite.
  void pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
            Eigen::Matrix3Xd& landmarks) const override;
  /// Throws PluginError if shape_correlations() refuses them.
  std::vector<ShapeParameter> shape_parameters() const override;
  ModelData shaped(std::span<const double> values) const override;
  /// Throws PluginError if they are no unit vectors, not perpendicular, or share a name.
  std::vector<NamedDirection> directions() const override;
  std::vector<std::string> clear_landmarks() const override;

 private:
  template <class Points>
  void check_points(const Points& points, Eigen::Index expected, const char* what) const;

  std::shared_ptr<const Model> model_;
  std::string who_;
  bool explains_, poses_itself_;
};

/// Returns a plugin's model, wrapped if its code runs once it is made. Throws PluginError, naming
/// `who`, its plugin_label(), if it has no landmarks.
std::shared_ptr<const Model> checked_model(std::shared_ptr<const Model> model, std::string who);

}  // namespace internal
}  // namespace hypotrack
