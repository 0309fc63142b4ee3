#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

namespace cuda {
class DeviceCost;
}

/// The normal equations A dx = -g of a linearised least-squares problem |r + J dx|^2. A = J^T J and
/// g = J^T r.
struct NormalEquations {
  Eigen::MatrixXd a;  ///< DxD
  Eigen::VectorXd g;  ///< D
};

/// A point of linearisation and its neighbours.
struct Neighbourhood {
  /// Dx(D+1): the point, then one per dimension. Column 1 + i differs from the first by steps[i] in
  /// dimension i.
  Eigen::MatrixXd points;
  Eigen::VectorXd steps;  ///< D; 0 leaves a dimension out
  double blur = 1;        ///< pixels over which a silhouette that crosses changes a residual
};

/// Normal equations from differences of residuals. The residuals stay where they are computed, in
/// GPU memory for a scene evaluated there. The object keeps the residuals of one point, at which it
/// linearises.
class HYPOTRACK_API ResidualDifferences {
 public:
  ResidualDifferences() = default;
  virtual ~ResidualDifferences();
  ResidualDifferences(const ResidualDifferences&) = delete;
  ResidualDifferences& operator=(const ResidualDifferences&) = delete;

  /// Computes the costs (N) of N points (DxN); each point counts as one evaluation.
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;
  /// Makes the i-th point of the last batch (of either function) the point of linearisation, with
  /// residuals r.
  virtual void move_to(Eigen::Index i) = 0;
  /// Computes the normal equations from the residuals r_i of D points (DxD), and the points' costs
  /// (D). Column i of J is (r_i - r) * scale[i]. It is 0 if scale[i] is 0 or the cost is infinite.
  /// Each point counts as one evaluation.
  virtual NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                           const Eigen::Ref<const Eigen::VectorXd>& scale,
                                           Eigen::Ref<Eigen::VectorXd> costs) = 0;
};

/// A cost function that is a sum of squares, given by its residuals.
class HYPOTRACK_API ResidualCost {
 public:
  virtual ~ResidualCost();
  /// Returns the number M of residuals per point; constant during a search.
  virtual Eigen::Index count() const = 0;
  /// Computes the residuals (MxN) and costs (N) of N points (DxN); each point counts as one
  /// evaluation. The costs are those of CostFunction::evaluate() and decide which point is better.
  /// A point's sum of squares is its cost plus a constant, or a substitute if the cost is not a sum
  /// of squares. Residuals are finite if the cost is. Batches are evaluated in parallel.
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::MatrixXf> residuals,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;

  /// Creates an object that computes numerical normal equations without copying residuals out. At
  /// most one may exist at a time, and this cost must outlive it. The default stores the results of
  /// evaluate().
  virtual std::unique_ptr<ResidualDifferences> differences();

  /// Returns true if linearize() is available.
  virtual bool can_linearize() const { return false; }
  /// Returns true if linearize() also draws the neighbours of a point, because a term offers
  /// nothing but residuals.
  virtual bool draws_neighbours() const { return false; }
  /// Returns the evaluations that linearize() counts as: one, and D more if it draws the
  /// neighbours.
  std::int64_t linearize_price(Eigen::Index dimension) const {
    return draws_neighbours() ? 1 + dimension : 1;
  }
  /// Computes the normal equations at points.col(0); counts as linearize_price() evaluations.
  /// points.col(1 + i) differs from it by steps[i] in dimension i. Its surfaces are only posed,
  /// unless draws_neighbours().
  /// Columns of J are derivatives per unit of the search point, 0 where the step is 0. `blur`: the
  /// residual of a pixel changes over this many pixels of motion of a silhouette that crosses it.
  virtual NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                    const Eigen::Ref<const Eigen::VectorXd>& steps, double blur);
  /// Computes the normal equations of several points at the same time. The default calls
  /// linearize() for one after the other.
  virtual std::vector<NormalEquations> linearize_each(std::span<const Neighbourhood> points);
};

/// The cost that an optimizer minimises. A search point is a column of D numbers. The search region
/// defines their meaning, including how rotations are parametrised.
class HYPOTRACK_API CostFunction {
 public:
  virtual ~CostFunction();
  /// Returns the length D of a search point.
  virtual int dimension() const = 0;
  /// Computes the costs (N) of N points (DxN); +infinity is infeasible, never NaN. Batches are
  /// evaluated in parallel, so pass as many points at once as the method allows.
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;
  /// Returns these costs for searches that stay on the GPU (hypotrack/gpu/device_cost.hpp). Null
  /// if the scene is not evaluated on a GPU.
  virtual cuda::DeviceCost* device() { return nullptr; }
  /// Returns these costs with their residuals, or null if they have none. This cost owns the
  /// result.
  virtual ResidualCost* residuals() { return nullptr; }
  /// Returns true if the batches of this search are recorded or traced. A search that stays on the
  /// GPU shows none.
  virtual bool is_watched() const { return false; }
};

/// The dimensions of a search point that move one part of the scene.
struct SearchGroup {
  enum class Kind {
    pose,  ///< position and rotation of a model
    limb,  ///< a chain of joints, such as an arm
  };
  Kind kind = Kind::limb;
  std::vector<int> dimensions;
};

/// The start, bounds and spread of a search. All vectors have length D.
struct SearchRegion {
  Eigen::VectorXd start;  ///< the prior's mean, within the bounds
  Eigen::VectorXd lower;  ///< hard bounds (anatomy); may be infinite
  Eigen::VectorXd upper;
  Eigen::VectorXd spread;  ///< plausible distance of the answer from `start`, to each side; > 0
  /// A partition of the dimensions into groups. Empty: unknown.
  std::vector<SearchGroup> groups = {};
  /// The search point of the previous frame's answer, perhaps outside the bounds. Empty: none, as
  /// for FrameContext::previous. `start` is there already or at its extrapolated motion.
  Eigen::VectorXd previous = {};
  double seconds_since_previous = std::numeric_limits<double>::quiet_NaN();  ///< NaN without it
};

/// The limits of a search. Evaluations count single points, not batches.
struct Budget {
  std::int64_t evaluations = 0;
  double seconds = std::numeric_limits<double>::infinity();
  /// Expected cost of a good answer, from recent searches. At or below it, an optimizer may skip
  /// steps that are a fallback for failed searches. -infinity = unknown.
  double usual_cost = -std::numeric_limits<double>::infinity();
};

/// The answer of a search.
struct OptimizerResult {
  Eigen::VectorXd point;  ///< the best point evaluated
  double cost = std::numeric_limits<double>::infinity();
  std::int64_t evaluations = 0;
};

/// An optimizer's use of ResidualCost::linearize().
enum class Linearization {
  unused,
  welcome,  ///< used if available
  needed,
};

/// The optional parts of a cost that an optimizer uses. A scene whose cost lacks a needed part is
/// refused at set-up.
struct HYPOTRACK_API Requirements {
  /// True if the optimizer minimises only costs with residuals().
  bool least_squares = false;
  /// Use of linearize() by an optimizer that needs residuals. `evaluate.backend: auto` chooses the
  /// backend by it.
  Linearization jacobian = Linearization::unused;
  /// True if the optimizer minimises only costs with a device().
  bool device = false;
  /// The optimizer that needs the device, after its place in the scene: `a.yaml:7:3: pso_cuda`.
  std::string device_by = {};
  /// Text for the end of the message on a missing device: what to write for a scene on the CPU.
  std::string instead_of_device = {};

  /// Adds the requirements of another user of the same cost. The texts are those of the first one
  /// that needs a device.
  void merge(const Requirements& other);
};

/// Says which optional parts a cost has.
struct CostOffer {
  std::string no_least_squares = {};  ///< why there are no residuals() and what to do; or empty
  std::string no_jacobian = {};       ///< why linearize() is not available; or empty
  bool device = false;                ///< whether there is a device()
  /// Why there is no device() where the scene is evaluated on a GPU, and what to do; or empty.
  std::string no_device = {};
};

/// Throws unless a cost has what is required: ConfigError for residuals and analytic Jacobians,
/// DeviceError for a device. The message says what to write instead.
HYPOTRACK_API void check_requirements(const Requirements& requirements, const CostOffer& offer);
/// Throws unless a cost has what is required. Pass its residuals() and device(), null if it has
/// none.
HYPOTRACK_API void check_requirements(const Requirements& requirements,
                                      const ResidualCost* residuals,
                                      const cuda::DeviceCost* device);

/// Searches for the point of lowest cost. Equal input, seed and machine give the equal answer,
/// unless the budget is in seconds.
class HYPOTRACK_API Optimizer : public PluginObject {
 public:
  Optimizer() = default;
  ~Optimizer() override;

  /// Returns what the optimizer uses besides plain costs; constant. An optimizer that wraps others
  /// merges theirs.
  virtual Requirements requirements() const { return {}; }

  /// Returns the evaluation budget that the optimizer's parameters imply, for scenes that give
  /// none.
  virtual std::int64_t default_evaluations() const = 0;

  /// Minimises `cost` and returns the best point evaluated. Never exceeds the budget, evaluates
  /// `start` first and stays within the bounds. Exceptions of `cost` pass through unchanged.
  virtual OptimizerResult minimize(CostFunction& cost, const SearchRegion& region,
                                   const Budget& budget, std::uint64_t seed) = 0;

  /// Searches several regions of one cost and returns the result of each. Every search has the
  /// budget's evaluations; all share its seconds. Search k has seed_of_part(seed, k). The default
  /// searches one after the other; an optimizer whose searches can share batches overrides it.
  virtual std::vector<OptimizerResult> minimize_each(CostFunction& cost,
                                                     std::span<const SearchRegion> regions,
                                                     const Budget& budget, std::uint64_t seed);
};

}  // namespace hypotrack
