#include "cost/cost.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/profile.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/stop.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the frame without the images that no term reads.
Frame looked_at(const Frame& frame, const ImageUse& use) {
  Frame out{frame.index, frame.time, frame.views, {}, {}};
  for (View& view : out.views) {
    if (!use.mask) view.mask.release();
    if (!use.depth) view.depth.release();
  }
  return out;
}

}  // namespace

ImageUse joined_use(const std::vector<ObjectiveTerm>& terms) {
  ImageUse all{.color = false, .mask = false, .depth = false};
  for (const ObjectiveTerm& term : terms) {
    const ImageUse use = term.objective->image_use();
    all.color = all.color || use.color;
    all.mask = all.mask || use.mask;
    all.depth = all.depth || use.depth;
    all.background = all.background || use.background;
    all.previous = all.previous || use.previous;
  }
  return all;
}

Cost::Cost(const Scene& scene, std::vector<ObjectiveTerm> terms)
    : scene_(scene), terms_(std::move(terms)) {}

Cost::~Cost() = default;

void Cost::prepare(const Observation& observation) {
  prepared_ = false;
  prepare_observation(observation);
  prepared_ = true;
}

void Cost::prepare_drawing(const Observation& observation) {
  prepared_ = false;
  prepare_only_drawing(observation);
  prepared_ = true;
}

void Cost::prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan) {
  check_stop();
  prepared_ = false;
  plan_ = std::move(plan);
  frame_ = looked_at(frame, joined_use(terms_));
  prepare_images(tiles, frame_, plan_);
  prepared_ = true;
}

void Cost::prepare_only_drawing(const Observation& observation) {
  prepare_observation(observation);
}

void Cost::prepare_images(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) {
  {
    const ProfiledPart part("resample");
    observation_ = tiles.resample(frame, plan);
  }
  prepare_observation(observation_);
}

void Cost::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                    Eigen::Ref<Eigen::VectorXd> costs) {
  evaluate_normalized(normalized(states, costs.size()), costs);
}

cuda::DeviceCost* Cost::device(const Eigen::VectorXd*) { return nullptr; }

void Cost::check_prepared() const {
  if (!prepared_) throw Error("evaluate: no frame has been prepared");
}

const Eigen::MatrixXd& Cost::normalized(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                        Eigen::Index costs) {
  check_stop();
  check_prepared();
  if (states.rows() != scene_.dimension() || costs != states.cols()) {
    throw Error(
        fmt::format("evaluate: found states {} x {} and room for {} costs, expected "
                    "states {} x N and room for N",
                    states.rows(), states.cols(), costs, scene_.dimension()));
  }
  normalized_ = states;
  for (Eigen::Index i = 0; i < states.cols(); ++i) scene_.normalize(normalized_.col(i));
  return normalized_;
}

}  // namespace hypotrack::internal
