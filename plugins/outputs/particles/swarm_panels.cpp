#include "swarm_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace hypotrack::particles {
namespace {

/// Returns the search whose answer is nearest that of the record.
const RecordedSearch& search_of(const SearchRecord& record) {
  return *std::ranges::min_element(record.searches, {}, [&](const RecordedSearch& search) {
    return search.state.size() == record.state.size() ? (search.state - record.state).norm()
                                                      : std::numeric_limits<double>::infinity();
  });
}

/// Returns up to `most` evenly spaced batches, from the first to the last large one. Batches of
/// less than a quarter of the largest are left out: least squares tries a few points at a time.
std::vector<std::size_t> chosen_batches(const RecordedSearch& search, std::size_t most) {
  Eigen::Index largest = 0;
  for (const HypothesisBatch& batch : search.batches)
    largest = std::max(largest, batch.costs.size());
  std::vector<std::size_t> large, chosen;
  for (std::size_t b = 0; b < search.batches.size(); ++b) {
    const Eigen::Index size = search.batches[b].costs.size();
    if (size > 1 && 4 * size >= largest) large.push_back(b);
  }
  const std::size_t count = std::min(most, large.size());
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(large[count == 1 ? 0 : i * (large.size() - 1) / (count - 1)]);
  return chosen;
}

/// Returns the root mean square distance of the landmarks from their means, over hypotheses;
/// metres.
double spread_of(const Scene& scene, const HypothesisBatch& batch) {
  Eigen::Matrix3Xd mean = Eigen::Matrix3Xd::Zero(3, std::ssize(scene.landmark_names()));
  std::vector<Eigen::Matrix3Xd> all;
  for (const auto& state : batch.states.colwise()) {
    all.push_back(scene.landmarks(state));
    mean += all.back() / static_cast<double>(batch.states.cols());
  }
  double sum = 0;
  for (const Eigen::Matrix3Xd& points : all) sum += (points - mean).colwise().squaredNorm().mean();
  return std::sqrt(sum / static_cast<double>(all.size()));
}

/// Returns how many of a batch's hypotheses are drawn: more would hide each other.
std::size_t drawn_count(const HypothesisBatch& batch) {
  constexpr std::size_t kMostDrawn = 64;
  return std::min(kMostDrawn, static_cast<std::size_t>(batch.costs.size()));
}

/// Returns the indices of the hypotheses that are drawn, from the worst to the best.
std::vector<Eigen::Index> drawn_order(const HypothesisBatch& batch) {
  const Eigen::VectorXd& costs = batch.costs;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(costs.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater{}, [&](Eigen::Index i) { return costs[i]; });
  std::vector<Eigen::Index> drawn;
  const std::size_t count = drawn_count(batch);
  for (std::size_t i = 0; i < count; ++i)
    drawn.push_back(order[order.size() - 1 - (count - 1 - i) * order.size() / count]);
  return drawn;
}

/// Draws outlines: the worse a hypothesis, the bluer; the best thick and white.
cv::Mat draw_batch(Renderer& renderer, const HypothesisBatch& batch, const TileView& view) {
  constexpr double kDark = 0.55;
  cv::Mat picture = kDark * panel_picture(view);
  const Camera camera = panel_camera(view.camera);
  const std::vector<Eigen::Index> order = drawn_order(batch);
  cv::Mat1b ranks(1, static_cast<int>(order.size()));
  for (int i = 0; i < ranks.cols; ++i)
    ranks(i) = static_cast<unsigned char>(255 * i / std::max(ranks.cols - 1, 1));
  cv::Mat colors;
  cv::applyColorMap(ranks, colors, cv::COLORMAP_PLASMA);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool best = i + 1 == order.size();
    const cv::Vec3b rank = colors.at<cv::Vec3b>(0, static_cast<int>(i));
    cv::polylines(picture, outlines(renderer, batch.states.col(order[i]), camera), true,
                  best ? cv::Scalar::all(255) : cv::Scalar(rank), best ? 2 : 1, cv::LINE_AA);
  }
  return picture;
}

}  // namespace

SwarmRow swarm_row(Renderer& renderer, const Scene& scene, const SearchRecord& record) {
  constexpr std::size_t kPanels = 5;
  if (record.searches.empty()) return {"no search in this frame", {}};
  const RecordedSearch& search = search_of(record);
  if (search.on_device)
    return {"hypotheses: they stay in GPU memory with this optimizer and are not shown", {}};
  const std::vector<std::size_t> chosen = chosen_batches(search, kPanels);
  if (chosen.empty()) return {"hypotheses: the optimizer evaluates them one by one", {}};
  SwarmRow row{
      fmt::format("hypotheses of search {} of {}, {} batches, over the first view. White: best of "
                  "the batch; others from yellow (better) to blue",
                  1 + (&search - record.searches.data()), record.searches.size(),
                  search.batches.size()),
      {}};
  for (const std::size_t b : chosen) {
    const HypothesisBatch& batch = search.batches[b];
    row.panels.push_back(
        {fmt::format("batch {}: {}, spread {:.1f} mm, best {:.4g}", b + 1, batch.costs.size(),
                     1000 * spread_of(scene, batch), batch.costs.minCoeff()),
         draw_batch(renderer, batch, record.observation.views[0])});
  }
  return row;
}

}  // namespace hypotrack::particles
