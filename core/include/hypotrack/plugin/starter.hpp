#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

/// Receives the parameters of one model in a pose that may be right. Returns false if no further
/// pose is wanted.
using TakePose = std::function<bool(const Eigen::VectorXd& parameters)>;

/// Settings of GlobalSearch::find(). A 0 stands for the value in `recovery`.
struct GlobalSearchSettings {
  int hypotheses = 0;  ///< poses evaluated per place
  int refined = 0;     ///< best of them refined by least squares
  int searched = 0;    ///< best of those proposed per place
};

/// Searches whole pictures for a model in any pose, with the scene's objective and without training
/// data. A tracker lends it to its starters.
class HYPOTRACK_API GlobalSearch {
 public:
  GlobalSearch() = default;
  virtual ~GlobalSearch();
  GlobalSearch(const GlobalSearch&) = delete;
  GlobalSearch& operator=(const GlobalSearch&) = delete;

  /// Proposes poses of the model that is looked for, place by place, likeliest places first.
  virtual void find(const GlobalSearchSettings& settings, const TakePose& take) = 0;
};

/// Data that a starter may look at.
struct StarterContext {
  const Scene& scene;
  const std::vector<Camera>& cameras;  ///< in the order of a frame's views
  const Frame* frame = nullptr;    ///< the frame to search, with views; null before there is one
  GlobalSearch* search = nullptr;  ///< for find(); null: not in this frame, where
                                   ///< find() has to be quick
  bool sure_only = false;  ///< find() proposes only what is surely this model, of several alike
  /// Takes messages to the user; null: nobody reads them.
  std::vector<std::string>* notes = nullptr;
};

/// Says where a search begins. Some starters know a state of the scene before they see pictures.
/// Others look for each model in the pictures, in the first frames and after every loss.
class HYPOTRACK_API Starter : public PluginObject {
 public:
  Starter() = default;
  ~Starter() override;

  /// Returns whether this starter looks for models in pictures: find() is called then, state()
  /// never.
  bool looks() const { return do_looks(); }

  /// Returns whether find() sees a model (its index) in nearly all pictures that show it. If it
  /// then proposes no pose, others are doubted. A pose near one that it proposes is followed even
  /// where the pictures deny it.
  bool detects(std::size_t model) const { return do_detects(model); }

  /// Returns a state of the scene with unit quaternions and angles within their bounds. Returns
  /// nothing if it needs a frame and there is none yet; with a frame it returns a state or throws.
  /// Equal contexts give equal states. Throws ConfigError or DataError, which say where it looked
  /// and what it did not find.
  std::optional<Eigen::VectorXd> state(const StarterContext& context);

  /// Proposes poses of one model of the scene (its index) in a frame, likeliest first, with unit
  /// quaternions and angles within their bounds. Proposes none if it sees none. The tracker refines
  /// them and chooses. Equal calls propose equal poses. Throws ConfigError or DataError.
  void find(const StarterContext& context, std::size_t model, const TakePose& take);

  /// Returns how large a model (its index) looks in a frame, as a factor on its size. Returns
  /// nothing if this starter does not see it well.
  std::optional<double> size(const StarterContext& context, std::size_t model);

 protected:
  // What plugins write: each function as the public one of its name says.
  virtual bool do_looks() const { return false; }
  virtual bool do_detects(std::size_t model) const;
  virtual std::optional<Eigen::VectorXd> do_state(const StarterContext& context);
  virtual void do_find(const StarterContext& context, std::size_t model, const TakePose& take);
  virtual std::optional<double> do_size(const StarterContext& context, std::size_t model);
};

}  // namespace hypotrack
