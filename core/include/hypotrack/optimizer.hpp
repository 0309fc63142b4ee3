#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

namespace cuda {
class DeviceCost;
}

/// The normal equations of a linearised sum of squares, |r + J dx|^2: A = J^T J, g = J^T r.
struct NormalEquations {
  Eigen::MatrixXd a;  ///< DxD
  Eigen::VectorXd g;  ///< D
};

/// Jacobians by differences of residuals that stay where they are computed: in GPU memory where a
/// scene is evaluated there. It remembers the residuals of one point, at which it linearises.
class HYPOTRACK_API ResidualDifferences {
 public:
  ResidualDifferences() = default;
  virtual ~ResidualDifferences();
  ResidualDifferences(const ResidualDifferences&) = delete;
  ResidualDifferences& operator=(const ResidualDifferences&) = delete;

  /// The costs (N) of N points (DxN), each counted as one evaluation, as from
  /// ResidualCost::evaluate().
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;
  /// Takes residuals r of the i-th point of the last batch, whichever function that was given to.
  virtual void move_to(Eigen::Index i) = 0;
  /// Costs (D) of D points (DxD), each counted as one evaluation, and from their residuals r_i the
  /// normal equations for the J whose i-th column is (r_i - r) * scale[i]. That column is 0 where
  /// scale[i] is 0 or the point's cost is infinite.
  virtual NormalEquations normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                           const Eigen::Ref<const Eigen::VectorXd>& scale,
                                           Eigen::Ref<Eigen::VectorXd> costs) = 0;
};

/// A cost function that is a sum of squares, seen square by square.
class HYPOTRACK_API ResidualCost {
 public:
  virtual ~ResidualCost();
  /// Number M of residuals of every point; the same during a search.
  virtual Eigen::Index count() const = 0;
  /// Residuals (MxN) and costs (N) of N points (DxN), each counted as one evaluation. The costs are
  /// those of CostFunction::evaluate(): they say which point is better. The sum of a point's
  /// squared residuals is its cost plus a constant, or a stand-in for it where a cost is no sum of
  /// squares. Residuals are finite where the cost is. Batches are evaluated in parallel.
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::MatrixXf> residuals,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;

  /// The same without handing residuals out, for a search by numerical Jacobians. One at a time,
  /// outlived by this cost. The default keeps what evaluate() gives.
  virtual std::unique_ptr<ResidualDifferences> differences();

  /// Whether linearize() is there.
  virtual bool can_linearize() const { return false; }
  /// The normal equations at points.col(0) without evaluating what lies beside it: points.col(1 +
  /// i) is a point off by steps[i] in dimension i, for which surfaces are posed and not drawn.
  /// Columns of J are per unit of a point; those of steps 0 are 0. `blur`: a silhouette that passes
  /// a pixel changes its residual over this many pixels of the way. Counts as one evaluation.
  virtual NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                    const Eigen::Ref<const Eigen::VectorXd>& steps, double blur);
};

/// What an optimizer minimises. One search point is a column of D numbers; what they mean (and how
/// rotations are parametrised) is the region's business, not the optimizer's.
class HYPOTRACK_API CostFunction {
 public:
  virtual ~CostFunction();
  /// Length D of a search point.
  virtual int dimension() const = 0;
  /// Costs (N) of N points (DxN). +infinity is infeasible; never NaN. Batches are evaluated in
  /// parallel: hand over as many points at once as the method allows.
  virtual void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& points,
                        Eigen::Ref<Eigen::VectorXd> costs) = 0;
  /// The same costs for searches that stay on the GPU (hypotrack/cuda/device_cost.hpp); null if the
  /// scene is not evaluated there.
  virtual cuda::DeviceCost* device() { return nullptr; }
  /// The same costs with their residuals; null if they have none. Lives as long as this one.
  virtual ResidualCost* residuals() { return nullptr; }
};

/// Dimensions of a search point that move one part of the scene.
struct SearchGroup {
  enum class Kind {
    pose,  ///< where a model is and how it is turned
    limb,  ///< a chain of joints, say a finger
  };
  Kind kind = Kind::limb;
  std::vector<int> dimensions;
};

/// Where to look. All vectors have length D.
struct SearchRegion {
  Eigen::VectorXd start;  ///< the prior's mean, within the bounds
  Eigen::VectorXd lower;  ///< hard bounds (anatomy); may be infinite
  Eigen::VectorXd upper;
  Eigen::VectorXd spread;  ///< how far the answer may plausibly be from `start`, each side; > 0
  /// Every dimension is in one of them. Empty: nobody knows what belongs together.
  std::vector<SearchGroup> groups = {};
};

/// What a search may cost. Evaluations count single points, not batches.
struct Budget {
  std::int64_t evaluations = 0;
  double seconds = std::numeric_limits<double>::infinity();
  /// What recent searches lead to expect of a good answer's cost: what only searches gone wrong
  /// need may be left out at or below it. -infinity where nothing is known.
  double usual_cost = -std::numeric_limits<double>::infinity();
};

struct OptimizerResult {
  Eigen::VectorXd point;  ///< the best point evaluated
  double cost = std::numeric_limits<double>::infinity();
  std::int64_t evaluations = 0;
};

/// What an optimizer wants of ResidualCost::linearize(), which is computed on the CPU only.
enum class Linearization {
  unused,
  welcome,  ///< taken where it is there
  needed,
};

/// Looks for the point of lowest cost. Equal input, seed and machine give the equal answer (unless
/// the budget is in seconds).
class HYPOTRACK_API Optimizer {
 public:
  Optimizer() = default;
  virtual ~Optimizer();
  Optimizer(const Optimizer&) = delete;
  Optimizer& operator=(const Optimizer&) = delete;

  /// Whether it minimises only costs with residuals(). A scene with it is refused at once if one of
  /// its terms has none.
  virtual bool needs_residuals() const { return false; }
  /// Of optimizers that need residuals. It decides where `evaluate.backend: auto` evaluates.
  virtual Linearization linearization() const { return Linearization::unused; }

  /// Of an optimizer that searches only costs with a device(): what to tell of a scene that is not
  /// evaluated on a GPU, and what to write instead. Such a scene is refused with it at once. Empty
  /// for all others; those that make other optimizers pass on what these say.
  virtual std::string needs_device() const { return {}; }

  /// The budget its own parameters imply, for scenes that name none.
  virtual std::int64_t default_evaluations() const = 0;

  /// Never evaluates more than the budget, evaluates `start` first, stays within the bounds and
  /// returns the best point it evaluated. Exceptions of `cost` pass through unchanged.
  virtual OptimizerResult minimize(CostFunction& cost, const SearchRegion& region,
                                   const Budget& budget, std::uint64_t seed) = 0;
};

}  // namespace hypotrack
