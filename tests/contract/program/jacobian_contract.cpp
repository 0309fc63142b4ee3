#include "jacobian_contract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "report.hpp"

namespace hypotrack::contract {
namespace {

constexpr double kStep = 1e-3;  // metres, radians or a quaternion's component

Eigen::VectorXd residuals_of(const ResidualTerm& term, const Eigen::VectorXd& state) {
  Eigen::VectorXf out(term.residual_count());
  term.write_residuals({{state.data(), static_cast<std::size_t>(state.size())}, {}},
                       {out.data(), static_cast<std::size_t>(out.size())});
  return out.cast<double>();
}

/// Residuals of a state and of its two neighbours along one parameter.
struct Sides {
  Sides(const ResidualTerm& term, const Scene& scene, const Eigen::VectorXd& state, Eigen::Index k)
      : beyond(state), before(state) {
    beyond[k] += kStep;
    before[k] -= kStep;
    scene.normalize(beyond);
    scene.normalize(before);
    r_beyond = residuals_of(term, beyond);
    r_before = residuals_of(term, before);
  }
  Eigen::VectorXd beyond, before;
  Eigen::VectorXd r_beyond, r_before;
};

std::string place(const Scene& scene, Eigen::Index residual, Eigen::Index k) {
  return fmt::format("residual {} by '{}' (number {} of the state)", residual,
                     scene.parameters()[static_cast<std::size_t>(k)].name, k);
}

/// A slope that lies between those of a residual's two sides passes, so that kinks do.
void compare(const Scene& scene, const ResidualTerm& term, const Eigen::VectorXd& state,
             const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& r, const std::string& where) {
  const Eigen::VectorXd largest = jacobian.cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index k = 0; k < state.size(); ++k) {
    const Sides sides(term, scene, state, k);
    const Eigen::VectorXd found = jacobian * (sides.beyond - sides.before) / (2 * kStep);
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double ahead = (sides.r_beyond[i] - r[i]) / kStep;
      const double behind = (r[i] - sides.r_before[i]) / kStep;
      const double low = std::min(ahead, behind), high = std::max(ahead, behind);
      const double rounding = 4e-7 * std::abs(r[i]) / kStep + 1e-6;
      const double slack =
          0.01 * std::max(std::abs(low), std::abs(high)) + 1e-3 * largest[i] + rounding;
      require(found[i] > low - slack && found[i] < high + slack,
              fmt::format("{}: the Jacobian says {:.6g} for {}, but differences of residuals are "
                          "{:.6g}",
                          where, found[i], place(scene, i, k), (low + high) / 2));
    }
  }
}

}  // namespace

void check_jacobian(const Objective& objective, const Scene& scene,
                    const RenderedHypothesis& hypothesis, const std::string& where) {
  const ResidualTerm& term = *objective.residual_term();
  const auto rows = static_cast<Eigen::Index>(term.residual_count());
  const Eigen::Index columns = scene.dimension();
  std::vector<float> expected(static_cast<std::size_t>(rows)), own(expected.size(), NAN);
  term.write_residuals(hypothesis, expected);
  Jacobian jacobian = Jacobian::Zero(rows, columns);
  try {
    term.write_jacobian(hypothesis, own, jacobian);
  } catch (const PluginError& error) {
    throw Violation(where + ": " + error.what());
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    const float with = own[static_cast<std::size_t>(i)];
    require(std::abs(with - expected[static_cast<std::size_t>(i)]) <= 1e-4f * (1 + std::abs(with)),
            fmt::format("{}: with a Jacobian, residual {} is another one", where, i));
  }
  if (objective.needs_rendering()) return;
  const Eigen::VectorXd state =
      Eigen::Map<const Eigen::VectorXd>(hypothesis.state.data(), std::ssize(hypothesis.state));
  compare(scene, term, state, jacobian.cast<double>(), residuals_of(term, state), where);
}

}  // namespace hypotrack::contract
