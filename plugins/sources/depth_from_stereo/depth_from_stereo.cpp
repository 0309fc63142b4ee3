#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/plugin/plugin.hpp"
#include "matcher.hpp"
#include "params.hpp"
#include "rectified_pair.hpp"

namespace hypotrack::depth_from_stereo {
namespace {

/// Turns a stereo source into one camera with colour and depth. OpenCV's semi-global matching finds
/// the depth in the rectified pair. The camera is the first one of the pair, rotated and without
/// its lens, at the same place in the world, so truth and masks stay right.
class DepthFromStereo final : public Source {
 public:
  using Params = depth_from_stereo::Params;

  DepthFromStereo(const Params& params, PluginContext& context)
      : source_(context.make<Source>(params.source)),
        pair_(source_->cameras(), params.source.where()),
        matcher_(params, pair_, context.config().where()),
        cameras_{pair_.camera()} {}

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return source_->frame_rate(); }
  std::optional<int> do_frame_count() const override { return source_->frame_count(); }
  bool do_live() const override { return source_->live(); }
  std::vector<std::string> do_notes() const override { return source_->notes(); }
  std::vector<std::string> do_statistics() const override { return source_->statistics(); }

  std::optional<Frame> do_next() override {
    std::optional<Frame> frame = source_->next();
    if (!frame || frame->views.empty()) return frame;
    check(*frame);
    View view;
    view.color = pair_.rectify(frame->views[0].color, 0);
    view.depth = matcher_.depth(view.color, pair_.rectify(frame->views[1].color, 1));
    if (!frame->views[0].mask.empty()) {
      view.mask = pair_.rectify_mask(frame->views[0].mask, 0);
    }
    frame->views = {std::move(view)};
    return frame;
  }

  void check(const Frame& frame) const {
    for (std::size_t i = 0; i < 2; ++i) {
      const cv::Mat* color = i < frame.views.size() ? &frame.views[i].color : nullptr;
      if (color && color->type() == CV_8UC3 && color->size() == pair_.seen(i).size()) continue;
      throw DataError(
          fmt::format("source depth_from_stereo: view {} of frame {} has no colour image of its "
                      "camera's size; expected two colour images to match",
                      i, frame.index));
    }
  }

  std::unique_ptr<Source> source_;
  RectifiedPair pair_;
  Matcher matcher_;
  std::vector<Camera> cameras_;
};

}  // namespace
}  // namespace hypotrack::depth_from_stereo

HYPOTRACK_PLUGIN(hypotrack::depth_from_stereo::DepthFromStereo,
                 "one camera with depth from a stereo source, by OpenCV's semi-global matching",
                 "depth")
