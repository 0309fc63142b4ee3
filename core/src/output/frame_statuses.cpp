#include "output/frame_statuses.hpp"

namespace hypotrack::internal {

FrameStatuses statuses_of(const Scene& scene, const Solution& solution) {
  FrameStatuses out{status_named(to_string(solution.status)).value()};
  for (std::size_t m = 0; m < solution.models.size(); ++m)
    if (!scene.items()[m].model->data().landmarks.empty())
      out.models.push_back(status_named(to_string(solution.models[m])).value());
  return out;
}

}  // namespace hypotrack::internal
