#include "cost/linearizer.hpp"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cost/hypothesis_drawer.hpp"
#include "cost/pixel_rows.hpp"

namespace hypotrack {
struct Linearizer::Impl {
  /// The pixels of a view in one term.
  struct PixelPart {
    const ResidualTerm* term;
    std::size_t index;  ///< index of the view in its pixel_views()
    float factor;       ///< root of the term's weight
    std::vector<float> residuals = {}, slopes = {};
  };

  /// All terms of one view; one thread handles them at a time.
  struct ViewPart {
    std::size_t view = 0;
    std::vector<PixelPart> parts = {};
    PixelRows rows = {};
  };

  struct StatePart {
    const ResidualTerm* term;
    double weight;
  };

  Impl(const Scene& scene, const std::vector<ObjectiveTerm>& scene_terms, int threads)
      : arena(threads > 0 ? threads : tbb::info::default_concurrency()),
        plan(scene),
        terms(scene_terms) {
    for (int i = 0; i < arena.max_concurrency(); ++i) {
      drawers.push_back(std::make_unique<HypothesisDrawer>(plan));
    }
    centre = std::make_unique<HypothesisDrawer>(plan);
  }

  /// Collects what the terms read in the prepared frame.
  void take_terms() {
    others.clear();
    for (ViewPart& view : views) view.parts.clear();
    for (const ObjectiveTerm& term : terms) {
      if (term.weight != 0) add(term);
    }
    std::erase_if(views, [](const ViewPart& view) { return view.parts.empty(); });
  }

  void add(const ObjectiveTerm& term) {
    const ResidualTerm* own = term.objective->residual_term();
    if (!term.objective->needs_rendering()) {
      others.push_back({own, term.weight});
      return;
    }
    const std::span<const int> wanted = own->pixel_views();
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto view = static_cast<std::size_t>(wanted[i]);
      auto found = std::ranges::find(views, view, &ViewPart::view);
      if (found == views.end()) found = views.insert(found, ViewPart{view});
      found->parts.push_back({own, i, static_cast<float>(std::sqrt(term.weight))});
    }
  }

  void draw(const Eigen::MatrixXd& states) {
    const auto dimension = static_cast<std::size_t>(states.rows());
    const std::size_t sets = frame.pair ? 1 : frame.views.size();
    const std::size_t size = std::size_t{plan.vertex_count} * kRecord;
    const auto count = static_cast<std::size_t>(states.cols() - 1);
    records.resize(sets * count * size);
    tbb::parallel_for(std::size_t{0}, count + 1, [&](std::size_t i) {
      const std::span<const double> state(states.col(static_cast<Eigen::Index>(i)).data(),
                                          dimension);
      if (i == 0) {
        centre->draw(state);
        return;
      }
      const int thread = tbb::this_task_arena::current_thread_index();
      HypothesisDrawer& drawer = *drawers[static_cast<std::size_t>(thread)];
      drawer.pose(state);
      drawer.project();
      for (std::size_t view = 0; view < sets; ++view) {
        std::copy_n(drawer.records(view), size, record(view, i - 1, count));
      }
    });
  }

  float* record(std::size_t set, std::size_t i, std::size_t count) {
    return records.data() + (set * count + i) * std::size_t{plan.vertex_count} * kRecord;
  }

  void add_rows(ViewPart& part, const RenderedHypothesis& hypothesis,
                const std::vector<float>& per_step, float blur) {
    const std::size_t set = frame.pair ? 0 : part.view;
    std::vector<const float*> beside;
    for (std::size_t i = 0; i < per_step.size(); ++i) {
      beside.push_back(record(set, i, per_step.size()));
    }
    const DepthTile& tile = hypothesis.views[part.view];
    part.rows.begin({&plan, &frame.views[part.view], &centre->visible(part.view),
                     frame.pair && part.view == 1, tile.inverse_depth, centre->records(part.view),
                     beside.data(), per_step.data(), static_cast<int>(per_step.size())});
    const auto pixels =
        static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    for (PixelPart& pixel : part.parts) {
      pixel.residuals.resize(pixels);
      pixel.slopes.resize(pixels);
      pixel.term->write_slopes(hypothesis, pixel.index, pixel.residuals, pixel.slopes);
      if (pixel.factor != 1) {
        for (float& r : pixel.residuals) r *= pixel.factor;
        for (float& s : pixel.slopes) s *= pixel.factor;
      }
      part.rows.add({pixel.residuals.data(), pixel.slopes.data(), blur});
    }
  }

  /// Adds a term of the state by differences.
  void add_differences(const StatePart& part, const Eigen::MatrixXd& states,
                       const Eigen::VectorXd& steps, NormalEquations& sums) const {
    const auto count = static_cast<std::size_t>(part.term->residual_count());
    Eigen::MatrixXf r(part.term->residual_count(), states.cols());
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      part.term->write_residuals(
          {{states.col(i).data(), static_cast<std::size_t>(states.rows())}, {}},
          {r.col(i).data(), count});
    }
    const Eigen::VectorXd at = r.col(0).cast<double>();
    Eigen::MatrixXd j(r.rows(), steps.size());
    for (Eigen::Index i = 0; i < steps.size(); ++i) {
      j.col(i) = steps[i] == 0 ? Eigen::VectorXd::Zero(r.rows())
                               : ((r.col(i + 1).cast<double>() - at) / steps[i]).eval();
    }
    sums.a += part.weight * j.transpose() * j;
    sums.g += part.weight * j.transpose() * at;
  }

  tbb::task_arena arena;
  ScenePlan plan;
  std::vector<ObjectiveTerm> terms;
  FrameProjection frame;
  std::vector<std::unique_ptr<HypothesisDrawer>> drawers;  // for posing, one per slot of the arena
  std::unique_ptr<HypothesisDrawer> centre;                // draws the point of linearisation
  std::vector<ViewPart> views;
  std::vector<StatePart> others;
  std::vector<float> records;
};

bool Linearizer::can_linearize(const std::vector<ObjectiveTerm>& terms) {
  return std::ranges::all_of(terms, [](const ObjectiveTerm& term) {
    if (term.weight == 0) return true;
    const ResidualTerm* residuals = term.objective->residual_term();
    return residuals && (!term.objective->needs_rendering() || residuals->has_slopes());
  });
}

Linearizer::Linearizer(const Scene& scene, const std::vector<ObjectiveTerm>& terms, int threads)
    : impl_(std::make_unique<Impl>(scene, terms, threads)) {}

Linearizer::~Linearizer() = default;

void Linearizer::prepare(const Observation& observation) {
  Impl& self = *impl_;
  self.frame = FrameProjection(observation);
  self.centre->prepare(self.frame);
  for (const auto& drawer : self.drawers) drawer->prepare(self.frame);
  self.take_terms();
}

NormalEquations Linearizer::linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                                      double blur) {
  Impl& self = *impl_;
  const Eigen::Index d = steps.size();
  NormalEquations sums{Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)};
  std::vector<float> per_step;
  for (const double step : steps) per_step.push_back(step == 0 ? 0 : static_cast<float>(1 / step));
  self.arena.execute([&] {
    if (self.views.empty()) return;
    self.draw(states);
    const RenderedHypothesis hypothesis{
        {states.col(0).data(), static_cast<std::size_t>(states.rows())}, self.centre->tiles()};
    tbb::parallel_for(std::size_t{0}, self.views.size(), [&](std::size_t i) {
      self.add_rows(self.views[i], hypothesis, per_step, static_cast<float>(blur));
    });
  });
  for (const Impl::ViewPart& view : self.views) {
    const auto columns = static_cast<Eigen::Index>(view.rows.columns());
    const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
        all(view.rows.sums().data(), columns, columns);
    const Eigen::MatrixXd upper = all.topLeftCorner(d, d).cast<double>();
    sums.a += Eigen::MatrixXd(upper.selfadjointView<Eigen::Upper>());
    sums.g += all.col(d).head(d).cast<double>();
  }
  for (const Impl::StatePart& part : self.others) self.add_differences(part, states, steps, sums);
  return sums;
}

}  // namespace hypotrack
