#include "output/verdicts.hpp"

namespace hypotrack {

FrameVerdicts verdicts_of(const Scene& scene, const Solution& solution) {
  FrameVerdicts out{verdict_named(to_string(solution.status)).value()};
  for (std::size_t m = 0; m < solution.models.size(); ++m)
    if (!scene.items()[m].model->data().landmarks.empty())
      out.models.push_back(verdict_named(to_string(solution.models[m])).value());
  return out;
}

}  // namespace hypotrack
