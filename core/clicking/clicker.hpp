#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/clicks.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack::clicking {

/// A landmark marked in one view.
struct Mark {
  std::size_t view = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::string name;
  bool asked = false;  ///< true for the landmark that is asked for now
};

/// What to draw over the first two views.
struct ClickDrawing {
  std::vector<Mark> marks;
  /// By view: where the landmark asked for must lie, as it is marked in the other view (2xN, NaN
  /// interrupts); empty if it is not.
  std::array<Eigen::Matrix2Xd, 2> lines;
  Eigen::VectorXd state;     ///< the fit; size 0: none yet
  std::vector<bool> hidden;  ///< for each model, true if it is not fitted
  std::vector<std::string> text;
};

/// Asks for landmarks one after the other, takes clicks and keys, and fits the models.
class Clicker {
 public:
  enum class Answer { go_on, save, quit };

  /// `tolerance`: pixels that a click may be from the epipolar line. Throws DataError if there are
  /// fewer than two cameras. The scene must outlive the clicker.
  Clicker(const Scene& scene, std::vector<Camera> cameras, double tolerance);

  /// Marks the landmark asked for in one of the first two views, in place of an earlier click.
  void click(std::size_t view, const Eigen::Vector2d& pixel);

  /// Takes a key: u (or backspace) undoes, x skips the landmark, n (space, enter) goes to the next,
  /// p to the previous one, s saves, q (escape) quits. Answers `save` only if there is a fit.
  Answer press(char key);

  ClickDrawing drawing() const;

  /// Returns the landmark that is asked for.
  const std::string& asked() const { return landmarks_[now_.asked].name; }
  /// Returns the clicks that the fit is of.
  std::vector<Click> clicks() const;
  /// Returns for each model whether it has as many whole clicks as a fit takes.
  std::vector<bool> complete_models() const;
  /// Returns the fit; nothing while no model has enough clicks or they do not fit.
  const std::optional<ClickFit>& fit() const { return fit_; }

 private:
  struct Asked {
    std::string name;  ///< in the clicks file
    std::size_t model = 0;
  };
  using Point = std::optional<Eigen::Vector2d>;
  /// What undo brings back.
  struct Progress {
    std::vector<std::array<Point, 2>> points;  ///< by landmark and view
    std::size_t asked = 0;
  };

  void remember() { earlier_.push_back(now_); }
  void refit();

  const Scene& scene_;
  std::vector<Camera> cameras_;
  double tolerance_;
  std::vector<Asked> landmarks_;
  Progress now_;
  std::vector<Progress> earlier_;
  std::optional<ClickFit> fit_;
  std::string problem_;  ///< why there is no fit
};

/// Draws the first two views of a frame side by side with the fit, the marks, the guiding lines and
/// the text below. `renderer` must be one of `scene`.
cv::Mat draw_clicks(Renderer& renderer, const Scene& scene, const std::vector<Camera>& cameras,
                    const Frame& frame, const ClickDrawing& drawing);

}  // namespace hypotrack::clicking
