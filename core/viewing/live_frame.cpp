#include "viewing/live_frame.hpp"

#include <iterator>

#include "hypotrack/api/overlay.hpp"

namespace hypotrack {

ShownViews shown_views(const Frame& frame, const Solution& solution) {
  ShownViews shown;
  shown.frame = frame.index;
  for (const View& view : frame.views) shown.images.push_back(picture_of(view));
  shown.state = solution.state;
  for (const Status status : solution.models)
    shown.hidden.push_back(status == Status::lost || status == Status::absent ||
                           status == Status::missing);
  return shown;
}

std::vector<double> model_sigmas(const Scene& scene, const Solution& solution) {
  std::vector<double> sigmas;
  Eigen::Index first = 0;
  for (const Scene::Item& item : scene.items()) {
    const std::ptrdiff_t count = std::ssize(item.model->data().landmarks);
    const bool known = count > 0 && solution.sigma.size() >= first + count;
    sigmas.push_back(known ? solution.sigma.segment(first, count).mean() : std::nan(""));
    first += count;
  }
  return sigmas;
}

}  // namespace hypotrack
