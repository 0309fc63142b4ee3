// A term that tells the user what it knows of earlier frames.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "hypotrack/plugin/plugin.hpp"

namespace {

class Telling : public hypotrack::Objective, public hypotrack::ResidualTerm {
 public:
  struct Params {
    bool tiles = false;
    int different = 0;
    void visit(hypotrack::ParamVisitor& v) {
      v("tiles", tiles, {.help = "reads the tiles of the previous frame"});
      v("different", different, {.help = "different texts per frame", .min = 0});
    }
  };
  Telling(const Params& params, hypotrack::PluginContext& context)
      : params_(params), log_(context.log()) {
    log_.note("was made");
  }

 private:
  bool do_needs_rendering() const override { return false; }
  hypotrack::ImageUse do_image_use() const override {
    return {.mask = false, .depth = false, .previous = params_.tiles};
  }
  void do_prepare(const hypotrack::Observation& observation) override {
    log_.note("prepares frames");
    for (int i = 0; i < params_.different; ++i) log_.note(fmt::format("text {}", i));
    const hypotrack::FrameContext& context = observation.context;
    if (context.no_motion_prior)
      log_.note(context.previous ? "some motion is assumed" : "no motion is assumed");
    if (!context.previous) {
      log_.note(std::isnan(context.seconds_since_previous) ? "no earlier frame" : "a time of none");
      return;
    }
    const hypotrack::PreviousSolution& before = *context.previous;
    const double seconds = context.seconds_since_previous;
    const bool is_right = std::abs(before.time + seconds - observation.time) < 1e-12 &&
                          before.state.size() == observation.scene->dimension();
    log_.note(fmt::format("after frame {}, {:.3f} s, tiles {}{}{}", before.frame, seconds,
                          before.views.size(), std::isfinite(before.cost) ? "" : ", no cost",
                          is_right ? "" : ", wrong"));
    for (const hypotrack::TileView& view : before.views)
      if (view.color.empty() || view.valid.empty() || !view.mask.empty() || !view.depth.empty() ||
          view.color.cols != view.camera.width || cv::mean(view.color) == cv::Scalar())
        log_.warning("a tile of the previous frame is not as promised");
  }
  double do_cost(const hypotrack::RenderedHypothesis&) const override {
    log_.warning("a cost\nof several threads");
    return 0;
  }

  const hypotrack::ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 1; }
  void do_write_residuals(const hypotrack::RenderedHypothesis&,
                          std::span<float> residuals) const override {
    residuals[0] = 0;
  }

  Params params_;
  hypotrack::PluginLog log_;
};

}  // namespace

HYPOTRACK_PLUGIN(Telling, "tells what it knows of earlier frames", "")
