// Stands in for the plugin in a build without a CUDA toolkit.
#include "hypotrack/api/error.hpp"
#include "pso_cuda.hpp"

namespace hypotrack {

struct PsoCuda::OnDevice {};

PsoCuda::PsoCuda(const PsoParams& params, const std::string& where) : params_(params) {
  throw DeviceError(where +
                    ": pso_cuda: this hypotrack was built without CUDA. Write `type: pso`, the "
                    "same search on the CPU, or build with -DHYPOTRACK_CUDA=ON");
}

PsoCuda::~PsoCuda() = default;

std::int64_t PsoCuda::default_evaluations() const {
  return std::int64_t{params_.particles} * params_.generations;
}

Requirements PsoCuda::requirements() const { return {}; }

OptimizerResult PsoCuda::minimize(CostFunction&, const SearchRegion&, const Budget&,
                                  std::uint64_t) {
  return {};  // unreachable: the constructor throws
}

}  // namespace hypotrack
