// A source that gives the frames of another one, and fails at one frame.
#include <array>
#include <csignal>
#include <memory>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How {
  kException,
  kDataError,
  kSegfault,
  kEarlyEnd,
  kGrey,
  kSmall,
  kOneView,
  kThreeViews,
};

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 8> kNames = {"exception", "data_error", "segfault",
                                                             "early_end", "grey",       "small",
                                                             "one_view",  "three_views"};
  return kNames;
}

class Failing : public hypotrack::Source {
 public:
  struct Params {
    How how = How::kException;
    int at = 3;
    hypotrack::ConfigNode source;
    void visit(hypotrack::ParamVisitor& v) {
      v("how", how, {.help = "it fails"});
      v("at", at, {.help = "number of the frame"});
      v("source", source, {.help = "the other source", .required = true});
    }
  };
  Failing(const Params& params, hypotrack::PluginContext& context)
      : how_(params.how), at_(params.at), source_(context.make<hypotrack::Source>(params.source)) {}

 private:
  const std::vector<hypotrack::Camera>& do_cameras() const override { return source_->cameras(); }
  double do_frame_rate() const override { return source_->frame_rate(); }
  std::optional<int> do_frame_count() const override { return 40; }
  std::optional<hypotrack::Frame> do_next() override {
    std::optional<hypotrack::Frame> frame = source_->next();
    if (!frame || frame->index != at_) return frame;
    if (how_ == How::kException) throw std::runtime_error("no picture");
    if (how_ == How::kDataError) throw hypotrack::DataError("the file is broken");
    if (how_ == How::kSegfault) raise(SIGSEGV);
    if (how_ == How::kEarlyEnd) return std::nullopt;
    spoil(frame->views);
    return frame;
  }

  void spoil(std::vector<hypotrack::View>& views) const {
    if (how_ == How::kGrey) views[1].color = cv::Mat::zeros(views[1].color.size(), CV_8UC1);
    if (how_ == How::kSmall) views[1].color = cv::Mat::zeros(10, 10, CV_8UC3);
    if (how_ == How::kOneView) views.pop_back();
    if (how_ == How::kThreeViews) views.push_back(views[0]);
  }

  How how_;
  int at_;
  std::unique_ptr<hypotrack::Source> source_;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
