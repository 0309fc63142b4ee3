#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/gpu/skeleton.hpp"

/// Cost and residuals of plausible motion; the same source for the CPU and the GPU.
namespace hypotrack::plausible_motion {

/// A linear function of a state that should be 0: factor[0] * state[index[0]] + factor[1] *
/// state[index[1]] - offset.
struct LinearResidual {
  std::int32_t index[2];
  double factor[2];
  double offset;
};

/// A sum of squared residuals, in host or device memory.
struct MotionTerm {
  std::int64_t count;
  const LinearResidual* residuals;

  HYPOTRACK_PIXEL std::int64_t residual_count() const { return count; }
  HYPOTRACK_PIXEL double residual(std::int64_t i, const double* state) const {
    const LinearResidual& r = residuals[i];
    return r.factor[0] * state[r.index[0]] + r.factor[1] * state[r.index[1]] - r.offset;
  }

  HYPOTRACK_PIXEL int scratch_floats() const { return 0; }
  template <class Team, class Put>
  HYPOTRACK_PIXEL double cost_and_residuals(const double* state, int /*dimension*/,
                                            const Team& team, float* /*scratch*/,
                                            const Put& put) const {
    double sum = 0;
    for (std::int64_t i = team.rank(); i < count; i += team.size()) {
      const double r = residual(i, state);
      put(i, static_cast<float>(r));
      sum += r * r;
    }
    return team.sum(sum);
  }
  template <class Team>
  HYPOTRACK_PIXEL double cost(const double* state, int dimension, const Team& team,
                              float* scratch) const {
    return cost_and_residuals(state, dimension, team, scratch, IgnoreResidual{});
  }
};

/// Returns the term of a frame, in host memory that is valid until the next call.
using TermOfFrame = std::function<MotionTerm(const Observation&)>;

/// Makes the term on the GPU; null in a build without CUDA.
std::unique_ptr<cuda::DeviceObjective> on_device(TermOfFrame term_of_frame);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::plausible_motion
