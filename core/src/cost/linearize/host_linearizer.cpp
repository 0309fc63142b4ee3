#include "cost/linearize/host_linearizer.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cost/linearize/drawn_differences.hpp"
#include "cost/linearize/pixel_rows.hpp"
#include "cost/linearize/posed_neighbours.hpp"
#include "cost/linearize/term_equations.hpp"

namespace hypotrack::internal {
namespace {

using Products = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Adds the sums of a band to those of other bands.
void add(const PixelRows& rows, Products& sums) {
  using Sums =
      Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  const auto columns = static_cast<Eigen::Index>(rows.columns());
  if (sums.size() == 0) sums.setZero(columns, columns);
  sums += Sums(rows.sums().data(), columns, columns).cast<double>();
}

/// Adds sums, whose columns are some dimensions and then the residual.
void add(const Products& all, const std::vector<Eigen::Index>& dimensions, NormalEquations& sums) {
  const auto d = static_cast<Eigen::Index>(dimensions.size());
  for (Eigen::Index i = 0; i < d; ++i) {
    const Eigen::Index row = dimensions[static_cast<std::size_t>(i)];
    sums.g[row] += all(i, d);
    for (Eigen::Index k = i; k < d; ++k) {
      const Eigen::Index column = dimensions[static_cast<std::size_t>(k)];
      sums.a(row, column) += all(i, k);
      if (k != i) sums.a(column, row) += all(i, k);
    }
  }
}

bool has_jacobian(const ObjectiveTerm& term) {
  return term.objective->residual_term()->has_jacobian();
}

bool has_slopes(const ObjectiveTerm& term) { return term.objective->residual_term()->has_slopes(); }

/// Returns the terms that need rendering and have neither slopes nor a Jacobian.
std::vector<ObjectiveTerm> with_residuals_only(const std::vector<ObjectiveTerm>& terms) {
  std::vector<ObjectiveTerm> out;
  std::ranges::copy_if(terms, std::back_inserter(out), [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering() && !has_jacobian(term) &&
           !has_slopes(term);
  });
  return out;
}

std::span<const double> state_of(const Eigen::MatrixXd& states) {
  return {states.col(0).data(), static_cast<std::size_t>(states.rows())};
}

}  // namespace

struct HostLinearizer::Impl {
  /// The pixels of a view in one term.
  struct PixelPart {
    const ResidualTerm* term;
    std::size_t index;  ///< index of the view in its pixel_views()
    float factor;       ///< root of the term's weight
    std::vector<float> residuals = {}, slopes = {};

    void resize(std::size_t pixels) {
      residuals.resize(pixels);
      slopes.resize(pixels);
    }
  };

  /// All terms of one view.
  struct ViewPart {
    std::size_t view = 0;
    std::vector<PixelPart> parts = {};
    std::vector<PixelSlopes> slopes = {};  // of the parts
    std::vector<PixelRows> bands;          // of the tile's rows
    BandTriangles triangles = {};
  };

  Impl(const Scene& own_scene, const std::vector<ObjectiveTerm>& scene_terms, int threads,
       int band_count)
      : scene(own_scene),
        plan(scene, ScenePlan::Surface::simplified),
        terms(scene_terms),
        bands(static_cast<std::size_t>(band_count)),
        neighbours(plan, threads),
        differences(plan, with_residuals_only(terms), threads) {}

  /// Collects what the terms read in the prepared frame.
  void take_terms() {
    others.clear();
    jacobians.clear();
    for (ViewPart& view : views) view.parts.clear();
    for (const ObjectiveTerm& term : terms) {
      if (term.weight != 0) add_term(term);
    }
    std::erase_if(views, [](const ViewPart& view) { return view.parts.empty(); });
  }

  void add_term(const ObjectiveTerm& term) {
    if (!term.objective->needs_rendering()) return others.push_back(term);
    if (has_jacobian(term)) return jacobians.push_back(term);
    if (!has_slopes(term)) return;  // the differences have it
    const ResidualTerm* own = term.objective->residual_term();
    const std::span<const int> wanted = own->pixel_views();
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto view = static_cast<std::size_t>(wanted[i]);
      auto found = std::ranges::find(views, view, &ViewPart::view);
      if (found == views.end())
        found = views.insert(found, {.view = view, .bands = std::vector<PixelRows>(bands)});
      found->parts.push_back({own, i, static_cast<float>(std::sqrt(term.weight))});
    }
  }

  /// Computes the residuals and slopes of every term in every view.
  void write_slopes(const RenderedHypothesis& hypothesis) {
    std::vector<std::pair<PixelPart*, const DepthTile*>> parts;
    for (ViewPart& view : views) {
      for (PixelPart& part : view.parts) parts.emplace_back(&part, &hypothesis.views[view.view]);
    }
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      const auto [part, tile] = parts[i];
      part->resize(static_cast<std::size_t>(tile->width) * static_cast<std::size_t>(tile->height));
      part->term->write_slopes(hypothesis, part->index, part->residuals, part->slopes);
    });
    for (ViewPart& view : views) {
      view.slopes.clear();
      for (const PixelPart& part : view.parts) {
        view.slopes.push_back({part.residuals.data(), part.slopes.data(), part.factor});
      }
    }
  }

  /// Returns the first rows of bands that show about equally many pixels of the scene, and the last
  /// band's end.
  std::vector<int> band_rows(const DepthTile& tile) const {
    std::vector<int> seen;  // pixels above each row
    int sum = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      const float* row = tile.inverse_depth + std::ptrdiff_t{y} * tile.stride;
      seen.push_back(sum);
      sum += static_cast<int>(
          std::count_if(row + tile.x0, row + tile.x1, [](float w) { return w > 0; }));
    }
    std::vector<int> rows;
    for (std::size_t band = 0; band < bands; ++band) {
      const auto before = static_cast<int>(band) * sum / static_cast<int>(bands);
      rows.push_back(tile.y0 +
                     static_cast<int>(std::ranges::lower_bound(seen, before) - seen.begin()));
    }
    rows.push_back(tile.y1);
    return rows;
  }

  /// Sums the products of the pixels' rows, in bands of every view.
  void sum_rows(const RenderedHypothesis& hypothesis, const std::vector<float>& per_step,
                float blur) {
    const auto drawn = [&](std::size_t view) {
      const HypothesisDrawer& centre = neighbours.centre();
      return DrawnView{&plan,
                       &frame.views[view],
                       &centre.visible(view),
                       frame.pair && view == 1,
                       hypothesis.views[view].inverse_depth,
                       centre.records(view),
                       neighbours.records(view).data(),
                       per_step.data(),
                       static_cast<int>(per_step.size()),
                       neighbours.movers(view)};
    };
    std::vector<std::vector<int>> rows(views.size());
    tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t i) {
      rows[i] = band_rows(hypothesis.views[views[i].view]);
      find_triangles(drawn(views[i].view), rows[i], views[i].triangles);
    });
    tbb::parallel_for(std::size_t{0}, views.size() * bands, [&](std::size_t i) {
      ViewPart& part = views[i / bands];
      const std::size_t band = i % bands;
      part.bands[band].sum(drawn(part.view), part.slopes, blur,
                           {rows[i / bands][band], rows[i / bands][band + 1]},
                           part.triangles[band]);
    });
  }

  /// Adds the terms that look at what is drawn, by the slopes of their pixels or their Jacobians.
  void add_pixels(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps, float blur,
                  NormalEquations& sums) {
    if (views.empty() && jacobians.empty()) return;
    std::vector<Eigen::Index> moved;
    std::vector<float> per_step;
    for (Eigen::Index i = 0; i < steps.size(); ++i) {
      if (steps[i] == 0) continue;
      moved.push_back(i);
      per_step.push_back(static_cast<float>(1 / steps[i]));
    }
    neighbours.draw(states, moved);
    const RenderedHypothesis hypothesis{state_of(states), neighbours.centre().tiles()};
    const Eigen::MatrixXd derivatives = state_derivatives(scene, states, steps);
    for (const ObjectiveTerm& term : jacobians) {
      add_by_jacobian(scene, term, hypothesis, derivatives, sums);
    }
    if (views.empty()) return;
    write_slopes(hypothesis);
    sum_rows(hypothesis, per_step, blur);
    Products products;
    for (const ViewPart& view : views) {
      for (const PixelRows& rows : view.bands) add(rows, products);
    }
    add(products, moved, sums);
  }

  /// Adds the terms of the state alone.
  void add_others(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                  NormalEquations& sums) const {
    const RenderedHypothesis hypothesis{state_of(states), {}};
    const Eigen::MatrixXd derivatives = state_derivatives(scene, states, steps);
    for (const ObjectiveTerm& term : others) {
      if (has_jacobian(term)) {
        add_by_jacobian(scene, term, hypothesis, derivatives, sums);
      } else {
        add_by_differences(term, states, steps, sums);
      }
    }
  }

  const Scene& scene;
  ScenePlan plan;
  std::vector<ObjectiveTerm> terms;
  std::size_t bands;
  FrameProjection frame;
  PosedNeighbours neighbours;
  std::vector<ViewPart> views;
  std::vector<ObjectiveTerm> jacobians;  // that need rendering
  std::vector<ObjectiveTerm> others;     // that need none
  DrawnDifferences differences;
};

bool HostLinearizer::can_linearize(const std::vector<ObjectiveTerm>& terms) {
  bool draws = false, analytic = false;
  for (const ObjectiveTerm& term : terms) {
    if (term.weight == 0) continue;
    if (!term.objective->residual_term()) return false;
    draws |= term.objective->needs_rendering();
    analytic |= term.objective->needs_rendering() && (has_jacobian(term) || has_slopes(term));
  }
  return analytic || !draws;
}

bool HostLinearizer::draws_neighbours(const std::vector<ObjectiveTerm>& terms) {
  return !with_residuals_only(terms).empty();
}

HostLinearizer::HostLinearizer(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                               int threads, int bands)
    : impl_(std::make_unique<Impl>(scene, terms, threads, bands)) {}

HostLinearizer::~HostLinearizer() = default;

void HostLinearizer::prepare(const Observation& observation) {
  Impl& self = *impl_;
  self.frame = FrameProjection(observation);
  self.neighbours.prepare(self.frame);
  self.differences.prepare(self.frame);
  self.take_terms();
}

NormalEquations HostLinearizer::linearize(const Eigen::MatrixXd& states,
                                          const Eigen::VectorXd& steps, double blur) {
  const Eigen::Index d = steps.size();
  const NormalEquations nothing{Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)};
  NormalEquations pixels = nothing, others = nothing, drawn = nothing;
  tbb::parallel_invoke([&] { impl_->add_pixels(states, steps, static_cast<float>(blur), pixels); },
                       [&] { impl_->add_others(states, steps, others); },
                       [&] { impl_->differences.add(states, steps, drawn); });
  return {pixels.a + others.a + drawn.a, pixels.g + others.g + drawn.g};
}

}  // namespace hypotrack::internal
