#include "cost/batched_terms.hpp"

#include <algorithm>
#include <cmath>

#include "base/profile.hpp"
#include "cost/backends.hpp"

namespace hypotrack::internal {

BatchedTerms::BatchedTerms(const std::vector<ObjectiveTerm>& terms) : terms_(terms) {
  for (const ObjectiveTerm& term : terms) {
    const int most = term.weight != 0 ? term.objective->most_at_once() : 0;
    batched_.push_back(most > 0);
    if (most > 0) most_ = most_ == 0 ? most : std::min<Eigen::Index>(most_, most);
  }
}

void BatchedTerms::begin(Eigen::Index count) {
  count_ = count;
  if (drawings_.size() < static_cast<std::size_t>(count))
    drawings_.resize(static_cast<std::size_t>(count));
}

void BatchedTerms::keep(Eigen::Index index, const RenderedHypothesis& hypothesis) {
  Drawing& to = drawings_[static_cast<std::size_t>(index)];
  to.state.assign(hypothesis.state.begin(), hypothesis.state.end());
  to.views.assign(hypothesis.views.begin(), hypothesis.views.end());
  to.pixels.resize(to.views.size());
  for (std::size_t v = 0; v < to.views.size(); ++v) {
    DepthTile& view = to.views[v];
    const float* first = view.inverse_depth;
    to.pixels[v].assign(first, first + static_cast<std::ptrdiff_t>(view.stride) * view.height);
    view.inverse_depth = to.pixels[v].data();
  }
}

void BatchedTerms::add(Eigen::Ref<Eigen::VectorXd> costs) const {
  std::vector<RenderedHypothesis> drawn, posed;
  for (Eigen::Index i = 0; i < count_; ++i) {
    const Drawing& drawing = drawings_[static_cast<std::size_t>(i)];
    drawn.push_back({drawing.state, drawing.views});
    posed.push_back({drawing.state, {}});
  }
  std::vector<double> own(static_cast<std::size_t>(count_));
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (!batched_[t]) continue;
    const ProfiledPart part(terms_[t].name);
    terms_[t].objective->costs(terms_[t].objective->needs_rendering() ? drawn : posed, own);
    for (Eigen::Index i = 0; i < count_; ++i) {
      costs[i] += terms_[t].weight * own[static_cast<std::size_t>(i)];
      if (std::isnan(costs[i])) refuse_cost(terms_[t], i, "adds an infinity to its opposite");
    }
  }
}

}  // namespace hypotrack::internal
