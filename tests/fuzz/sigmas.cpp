// Tables of uncertainties.

#include "output/evaluate/sigma_table.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(sigmas, "csv") {
  const SigmaTable table(scratch_file("uncertainty.csv", bytes));
  for (const auto& [frame, sigmas] : table.by_frame())
    require(sigmas.size() == static_cast<Eigen::Index>(table.names().size()),
            "a sigma per landmark");
}

}  // namespace hypotrack::fuzz
