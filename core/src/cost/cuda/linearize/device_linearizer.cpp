#include "cost/cuda/linearize/device_linearizer.hpp"

#include <algorithm>

#include "cost/cuda/linearize/device_residuals.hpp"
#include "cost/cuda/linearize/gram_matrix.hpp"
#include "cost/cuda/linearize/pixel_rows.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "cost/linearize/difference_blocks.hpp"

namespace hypotrack::cuda::internal {
namespace {

std::size_t size(std::int64_t numbers) { return static_cast<std::size_t>(numbers); }

/// Returns the dimensions with steps.
std::vector<Eigen::Index> moved_dimensions(const Eigen::VectorXd& steps) {
  std::vector<Eigen::Index> moved;
  for (Eigen::Index i = 0; i < steps.size(); ++i) {
    if (steps[i] != 0) moved.push_back(i);
  }
  return moved;
}

/// Returns the matrix of the sums of enqueue_pixel_rows(): (D + 1) x (D + 1), valid on and above
/// the diagonal.
Eigen::MatrixXd unpack_rows(const double* sums, int columns) {
  const int sides = (columns + kRowSide) / kRowSide;
  Eigen::MatrixXd all(sides * kRowSide, sides * kRowSide);
  for (int a = 0; a < sides; ++a) {
    for (int b = a; b < sides; ++b, sums += kRowSquare) {
      all.block<kRowSide, kRowSide>(kRowSide * a, kRowSide * b) =
          Eigen::Map<const Eigen::Matrix<double, kRowSide, kRowSide>>(sums);
    }
  }
  return all.topLeftCorner(columns + 1, columns + 1);
}

}  // namespace

std::vector<NormalEquations> DeviceLinearizer::linearize(std::span<const Neighbourhood> points) {
  std::vector<NormalEquations> out;
  frame_.device().use();
  const std::size_t most = points.size() > 1 ? most_together(points.size()) : 1;
  while (out.size() < points.size()) {
    const auto part = points.subspan(out.size(), std::min(most, points.size() - out.size()));
    linearize_together(part, out);
  }
  return out;
}

std::size_t DeviceLinearizer::most_together(std::size_t points) {
  constexpr std::size_t kMostDifferences = 8;  // points whose neighbours' residuals are kept
  frame_.reserve(static_cast<std::int64_t>(points));
  const std::size_t drawn = size(frame_.drawn_at_once());
  return frame_.draws_differences() ? std::min(drawn, kMostDifferences) : drawn;
}

void DeviceLinearizer::linearize_together(std::span<const Neighbourhood> points,
                                          std::vector<NormalEquations>& all) {
  std::vector<std::vector<Eigen::Index>> moved;
  int columns = 0;
  const std::size_t before = all.size();
  for (const Neighbourhood& at : points) {
    moved.push_back(moved_dimensions(at.steps));
    columns = std::max(columns, static_cast<int>(moved.back().size()));
    const Eigen::Index d = at.steps.size();
    all.push_back({Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)});
  }
  if (columns == 0) return;
  const std::span<NormalEquations> out = std::span(all).subspan(before);
  const auto count = static_cast<int>(points.size());
  take(points, moved, columns);
  const auto arguments = [&] {
    const auto shape = static_cast<std::uint64_t>(std::int64_t{count} << 32 | columns);
    return RepeatedWork::Arguments{shape, frame_.revision(), batch_.revision(), revision_};
  };
  if (!work_.launch(arguments(), frame_.stream())) {
    reserve(count, columns);
    work_.enqueue(arguments(), frame_.stream(), [&] {
      const LinearizedStates at = taken(count, columns);
      batch_.upload(frame_.stream());
      to_device(numbers_, numbers_staging_, size(std::int64_t{count} * (columns + 1)),
                frame_.stream());
      enqueue(at);
      download(at);
    });
  }
  wait_for(frame_.stream(), "linearising");
  const bool differs = frame_.difference_residual_count() > 0;
  if (differs && frame_.draws_differences()) {
    costs_.resize(count * (columns + 2));
    batch_.read(costs_, frame_.terms());
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto d = static_cast<Eigen::Index>(moved[k].size());
    if (frame_.sloped_terms() > 0) {
      const Eigen::MatrixXd sums =
          unpack_rows(row_sums_staging_.data() + k * size(row_numbers(columns)), columns);
      out[k].a(moved[k], moved[k]) =
          Eigen::MatrixXd(sums.topLeftCorner(d, d).selfadjointView<Eigen::Upper>());
      out[k].g(moved[k]) = sums.col(columns).head(d);
    }
    if (differs) {
      const NormalEquations differences =
          unpack_gram(gram_sums_staging_.data() + k * size(gram_numbers(columns)),
                      per_step(static_cast<int>(k), columns));
      out[k].a(moved[k], moved[k]) += differences.a.topLeftCorner(d, d);
      out[k].g(moved[k]) += differences.g.head(d);
    }
  }
}

LinearizedStates DeviceLinearizer::taken(int points, int columns) const {
  return {.points = points,
          .columns = columns,
          .states = batch_.layout(),
          .per_step = numbers_.data(),
          .blurs = numbers_.data() + std::int64_t{points} * columns};
}

void DeviceLinearizer::enqueue(const LinearizedStates& at) {
  try {
    enqueue_all(at);
  } catch (...) {
    frame_.end_sides();
    for (const SideStream* side : {&posing_, &differences_}) side->end();
    throw;
  }
}

void DeviceLinearizer::enqueue_all(const LinearizedStates& at) {
  const bool differs = frame_.difference_residual_count() > 0;
  const bool draws_differences = differs && frame_.draws_differences();
  // What does not need the drawing runs beside it.
  differences_.fork(frame_.stream());
  if (differs && !draws_differences) enqueue_differences(at);
  if (frame_.sloped_terms() > 0) enqueue_rows(at);
  if (draws_differences) enqueue_differences(at);
  differences_.join(frame_.stream());
}

void DeviceLinearizer::download(const LinearizedStates& at) {
  const std::int64_t points = at.points;
  const Stream stream = frame_.stream();
  if (row_sums())
    to_host(row_sums_staging_, row_sums_, 0, size(points * row_numbers(at.columns)), stream);
  if (!gram_sums()) return;
  to_host(gram_sums_staging_, gram_sums_, 0, size(points * gram_numbers(at.columns)), stream);
  if (frame_.draws_differences()) batch_.download(0, points * (at.columns + 2), stream);
}

Eigen::VectorXd DeviceLinearizer::per_step(int k, int columns) const {
  Eigen::VectorXd out =
      Eigen::Map<const Eigen::VectorXf>(numbers_staging_.data() + k * columns, columns)
          .cast<double>();
  if (!frame_.draws_differences()) return out;
  const Eigen::Index side = Eigen::Index{columns} + 1;
  const Eigen::Index points = costs_.size() / (side + 1);
  return scale_of_finite(out, costs_.segment(points + k * side + 1, columns));
}

void DeviceLinearizer::reserve(std::int64_t points, int columns) {
  const std::int64_t rows = frame_.difference_residual_count();
  const std::int64_t drawn_each = frame_.draws_differences() ? columns + 2 : 1;
  frame_.reserve(points * drawn_each, [&](std::int64_t hypotheses) {
    const std::int64_t count = std::max<std::int64_t>(hypotheses / drawn_each, 1);
    const std::int64_t pixels = count * frame_.pixels();
    if (frame_.sloped_terms() > 0) {
      const int sets = frame_.observation().pair ? 1 : frame_.view_count();
      grow(records_, count * record_floats(frame_.scene(), sets, columns));
      grow(slopes_, pixels * frame_.sloped_terms());
      grow(owners_, pixels);
      grow(row_parts_, count * row_numbers(columns) * row_blocks(frame_.pixels(), count));
    }
    grow(residuals_, count * rows * (columns + 1));
    grow(gram_parts_, count * gram_numbers(columns) * gram_blocks(rows));
  });
  grow(row_sums_, points * row_numbers(columns));
  grow(row_sums_staging_, points * row_numbers(columns));
  grow(gram_sums_, points * gram_numbers(columns));
  grow(gram_sums_staging_, points * gram_numbers(columns));
}

void DeviceLinearizer::take(std::span<const Neighbourhood> points,
                            const std::vector<std::vector<Eigen::Index>>& moved, int columns) {
  const auto count = static_cast<Eigen::Index>(points.size()), side = Eigen::Index{columns} + 1;
  grow(numbers_, count * side);
  grow(numbers_staging_, count * side);
  Eigen::MatrixXd states(points[0].points.rows(), count * (side + 1));
  for (Eigen::Index k = 0; k < count; ++k) {
    const Neighbourhood& at = points[static_cast<std::size_t>(k)];
    const std::vector<Eigen::Index>& own = moved[static_cast<std::size_t>(k)];
    float* per_step = numbers_staging_.data() + k * columns;
    std::fill_n(per_step, columns, 0.0f);
    states.middleCols(count + k * side, side) = at.points.col(0).replicate(1, side);
    for (std::size_t i = 0; i < own.size(); ++i) {
      states.col(count + k * side + 1 + static_cast<Eigen::Index>(i)) = at.points.col(own[i] + 1);
      per_step[i] = static_cast<float>(1 / at.steps[own[i]]);
    }
    states.col(k) = at.points.col(0);
    numbers_staging_.data()[count * columns + k] = static_cast<float>(at.blur);
  }
  batch_.take(cost_.normalized(states, states.cols()));
}

void DeviceLinearizer::enqueue_rows(const LinearizedStates& at) {
  const Stream stream = frame_.stream();
  BatchLayout centres = at.states;
  centres.count = at.points;
  PixelRowsJob job{.frame = frame_.observation().frame,
                   .view_count = frame_.view_count(),
                   .pair = frame_.observation().pair,
                   .pixels = static_cast<int>(frame_.pixels()),
                   .terms = frame_.sloped_terms(),
                   .columns = at.columns,
                   .points = at.points,
                   .states = at.states.points + std::int64_t{at.points} * frame_.scene().dimension,
                   .per_step = at.per_step,
                   .blurs = at.blurs,
                   .depth = nullptr,
                   .slopes = slopes_.data(),
                   .records = records_.data(),
                   .owners = owners_.data(),
                   .parts = row_parts_.data(),
                   .sums = row_sums_.data(),
                   .rests = at.rests};
  posing_.fork(stream);
  enqueue_posing(frame_.scene(), frame_.device().limits(), job, posing_.stream());
  const DrawnBatch drawn = frame_.draw(centres);
  job.depth = drawn.depth;
  frame_.fork_slopes(drawn, slopes_.data());
  posing_.join(stream);
  enqueue_owners(frame_.scene(), frame_.device().limits(), job, stream);
  frame_.join_slopes();
  enqueue_pixel_rows(frame_.scene(), frame_.device().limits(), job, stream);
}

void DeviceLinearizer::enqueue_differences(const LinearizedStates& at) {
  const Stream stream = frame_.draws_differences() ? frame_.stream() : differences_.stream();
  const std::int64_t rows = frame_.difference_residual_count();
  BatchLayout states = at.states;
  states.points += std::int64_t{at.points} * frame_.scene().dimension;
  states.costs += at.points;  // behind those of the drawn states
  states.count = std::int64_t{at.points} * (at.columns + 1);
  frame_.enqueue_differences(states, residuals_.data(), stream);
  enqueue_gram({.here = residuals_.data(),
                .beside = residuals_.data() + rows,
                .rows = rows,
                .dimension = at.columns,
                .parts = gram_parts_.data(),
                .sums = gram_sums_.data(),
                .count = at.points,
                .stride = rows * (at.columns + 1)},
               stream);
}

}  // namespace hypotrack::cuda::internal
