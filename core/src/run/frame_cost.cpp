#include "hypotrack/api/frame_cost.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "cost/cuda/device.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/plugin_call.hpp"
#include "run/frame_cost_impl.hpp"

namespace hypotrack {
namespace {

TrackerParts& with_cameras(TrackerParts& parts, const std::vector<Camera>& cameras) {
  if (cameras.empty()) throw DataError("the cost of a frame needs at least one camera");
  for (std::size_t i = 0; i < cameras.size(); ++i)
    validate(cameras[i], fmt::format("camera {} of the cost", i));
  parts.cameras = cameras;
  return parts;
}

}  // namespace

FrameCost::Impl::Impl(OpenedScene from_scene, std::vector<Camera> from)
    : opened(std::move(from_scene)),
      cameras(std::move(from)),
      evaluate(opened.parts.evaluate),
      terms(opened.parts.objective),
      search(*opened.scene, with_cameras(opened.parts, cameras)) {
  for (const ObjectiveTerm& term : terms) {
    names.push_back(term.name);
    weights.push_back(term.weight);
  }
}

Cost& FrameCost::Impl::cost_of(const Eigen::Ref<const Eigen::MatrixXd>& states) {
  if (!frame) throw Error("no frame is prepared; call look() with one before");
  if (states.rows() != opened.scene->dimension() || states.cols() < 1)
    throw Error(fmt::format("expected states of {} numbers, one at least; found {} x {}",
                            opened.scene->dimension(), states.rows(), states.cols()));
  for (Eigen::Index k = 0; k < states.cols(); ++k)
    if (!states.col(k).allFinite())
      throw Error(fmt::format("state {} has a number that is not finite", k));
  return search.cost();
}

StateResiduals& FrameCost::Impl::residuals() {
  if (StateResiduals* residuals = search.cost().least_squares()) return *residuals;
  throw ConfigError(
      "the scene's objective has no residuals on this backend, because one of its terms has none; "
      "ask least_squares() before, or leave that term out");
}

void FrameCost::Impl::prepare_terms() {
  for (std::size_t i = single.size(); i < terms.size(); ++i)
    single.push_back(make_cost(*opened.scene, {{1, terms[i].objective, names[i]}}, evaluate));
  if (std::exchange(single_prepared, true)) return;
  observation = search.prepared(*frame);
  observation.scene = opened.scene.get();
  for (const auto& cost : single) cost->prepare(observation);
}

FrameCost::FrameCost(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameCost::FrameCost(FrameCost&&) noexcept = default;
FrameCost& FrameCost::operator=(FrameCost&&) noexcept = default;
FrameCost::~FrameCost() = default;

void FrameCost::look(const Frame& frame, const Eigen::VectorXd& around) {
  const cuda::KeepDevice keep;
  Impl& self = *impl_;
  if (frame.views.empty())
    throw DataError(fmt::format("frame {} has no views, so that it has no cost", frame.index));
  self.opened.scene->check(around, "the state to look around");
  self.frame.reset();
  self.single_prepared = false;
  self.search.forget_colors();
  detail::in_frame(frame.index, [&] { self.search.look(frame, around, false); });
  self.frame = frame;
}

Eigen::VectorXd FrameCost::costs(const Eigen::Ref<const Eigen::MatrixXd>& states) {
  const cuda::KeepDevice keep;
  Eigen::VectorXd costs(states.cols());
  impl_->cost_of(states).evaluate(states, costs);
  return costs;
}

Eigen::MatrixXd FrameCost::terms(const Eigen::Ref<const Eigen::MatrixXd>& states) {
  const cuda::KeepDevice keep;
  impl_->cost_of(states);
  impl_->prepare_terms();
  Eigen::MatrixXd costs(states.cols(), std::ssize(impl_->single));
  for (std::size_t i = 0; i < impl_->single.size(); ++i)
    impl_->single[i]->evaluate(states, costs.col(static_cast<Eigen::Index>(i)));
  return costs.transpose();
}

Eigen::MatrixXf FrameCost::residuals(const Eigen::Ref<const Eigen::MatrixXd>& states) {
  const cuda::KeepDevice keep;
  impl_->cost_of(states);
  StateResiduals& from = impl_->residuals();
  Eigen::MatrixXf residuals(from.count(), states.cols());
  Eigen::VectorXd costs(states.cols());
  from.evaluate(states, residuals, costs);
  return residuals;
}

Eigen::MatrixXf FrameCost::jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& steps) {
  const cuda::KeepDevice keep;
  impl_->cost_of(state);
  const Eigen::Index d = state.size();
  if (steps.size() != d || !steps.allFinite())
    throw Error(
        fmt::format("expected {} finite steps, one for each parameter; found {}", d, steps.size()));
  StateResiduals& from = impl_->residuals();
  Eigen::MatrixXd beside(d, 2 * d);
  beside.colwise() = state;
  beside.leftCols(d).diagonal() += steps;
  beside.rightCols(d).diagonal() -= steps;
  Eigen::MatrixXf residuals(from.count(), 2 * d);
  Eigen::VectorXd costs(2 * d);
  from.evaluate(beside, residuals, costs);
  Eigen::MatrixXf jacobian = Eigen::MatrixXf::Zero(from.count(), d);
  for (Eigen::Index i = 0; i < d; ++i)
    if (steps[i] != 0 && std::isfinite(costs[i]) && std::isfinite(costs[d + i]))
      jacobian.col(i) =
          (residuals.col(i) - residuals.col(d + i)) / static_cast<float>(2 * steps[i]);
  return jacobian;
}

NormalEquations FrameCost::linearize(const Eigen::VectorXd& state, const Eigen::VectorXd& steps,
                                     double blur) {
  const cuda::KeepDevice keep;
  impl_->cost_of(state);
  if (steps.size() != state.size() || !steps.allFinite())
    throw Error(fmt::format("expected {} finite steps, one for each parameter; found {}",
                            state.size(), steps.size()));
  StateResiduals& from = impl_->residuals();
  if (!from.can_linearize())
    throw ConfigError("the scene's objective has no analytic derivatives; take jacobian()");
  Eigen::MatrixXd points = state.replicate(1, state.size() + 1);
  points.rightCols(state.size()).diagonal() += steps;
  return from.linearize(points, steps, blur);
}

bool FrameCost::least_squares() const { return impl_->search.cost().least_squares() != nullptr; }
bool FrameCost::can_linearize() const {
  return least_squares() && impl_->search.cost().least_squares()->can_linearize();
}
const std::vector<std::string>& FrameCost::term_names() const { return impl_->names; }
const std::vector<double>& FrameCost::weights() const { return impl_->weights; }
const Scene& FrameCost::scene() const { return *impl_->opened.scene; }
const std::vector<Camera>& FrameCost::cameras() const { return impl_->cameras; }
std::string FrameCost::backend() const { return impl_->search.cost().backend(); }

}  // namespace hypotrack
