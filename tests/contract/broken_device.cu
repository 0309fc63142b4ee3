#include "broken_device.hpp"

#include "hypotrack/gpu/state_objective.cuh"

namespace hypotrack {
namespace {

using namespace cuda;

struct Term {
  double offset;
  unsigned* calls;  ///< makes every cost different; null: does not

  __device__ double cost(const double* state, int dimension) const {
    const double sum = offset + SquaredLength().cost(state, dimension);
    return calls ? sum + 1e-9 * atomicAdd(calls, 1u) : sum;
  }
};

class OnDevice final : public StateObjective<Term> {
 public:
  explicit OnDevice(const DeviceFaults& faults)
      : StateObjective({faults.another_cost ? 1.0 : 0.0, nullptr}), faults_(faults), calls_(1) {
    check(cudaMemset(calls_.data(), 0, sizeof(unsigned)), "clearing memory");
    check(cudaDeviceSynchronize(), "clearing memory");
  }

 private:
  Term make_term(const DeviceObservation& observation, Stream stream) override {
    if (!faults_.accepts_everything && observation.tiles[1].layout.width == 0) {
      throw DataError("expected two views");
    }
    Term term = StateObjective::make_term(observation, stream);
    if (faults_.never_repeats) term.calls = calls_.data();
    return term;
  }

  DeviceFaults faults_;
  DeviceBuffer<unsigned> calls_;
};

}  // namespace

std::unique_ptr<DeviceObjective> on_device(const DeviceFaults& faults) {
  return std::make_unique<OnDevice>(faults);
}

}  // namespace hypotrack
