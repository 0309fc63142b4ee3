#include "viewing/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "base/text_file.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/pose.hpp"
#include "viewing/view_drawing.hpp"

namespace hypotrack {
namespace {

/// Returns a picture as the content of a PNG file.
std::string png(const cv::Mat& picture) {
  const std::vector<unsigned char> bytes = encode_image(".png", picture);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

/// Connects the viewers with a run's scene, cameras and folder.
class LiveRun::SnapshotOutput final : public Output {
 public:
  explicit SnapshotOutput(LiveRun& live) : live_(live) {}
  ~SnapshotOutput() override { live_.close(); }

 private:
  std::vector<std::string> do_file_names() const override {
    return {"snapshot_#.png", "snapshot_#.yaml"};
  }
  void do_begin(OutputContext& run) override { live_.open(run); }
  void do_frame(const Frame& /*frame*/, const Solution& /*solution*/) override {}

  LiveRun& live_;
};

LiveRun::LiveRun(std::filesystem::path folder, std::function<void(const std::string&)> tell)
    : tell_(std::move(tell)),
      place_(std::move(folder)),
      recorder_([this](const std::string& text) { say(text); }) {}

LiveRun::~LiveRun() = default;

RunAdditions LiveRun::additions() {
  RunAdditions out;
  if (viewers_.empty()) return out;
  out.outputs.push_back({"live view", std::make_unique<SnapshotOutput>(*this)});
  out.searches_anew = [this] { return controls_.take_restart(); };
  out.opened = [this](const OpenedScene& opened) { recorder_.open(opened); };
  return out;
}

void LiveRun::open(OutputContext& run) {
  run_ = &run;
  folder_.emplace(place_);
  recorder_.set_folder(*folder_);
  // Here an error still may end the run: nothing is lost.
  for (const auto& viewer : viewers_) viewer->open(run.scene(), run.cameras());
}

void LiveRun::close() {
  end();
  for (const auto& viewer : viewers_) viewer->end();
  renderer_.reset();
  run_ = nullptr;
}

void LiveRun::begin(std::optional<int> frames) {
  tracking_ = true;
  show([&](Viewer& viewer) { viewer.begin(frames); });
}

void LiveRun::end() {
  if (!std::exchange(tracking_, false)) return;
  recorder_.stop();
  set_status();
}

void LiveRun::frame(const Frame& frame, const Solution& solution, double error) {
  if (viewers_.empty()) return;
  if (!frame.views.empty())
    shown_ = std::make_shared<const ShownViews>(shown_views(frame, solution));
  rate_.add(FrameRate::Clock::now());
  const LiveFrame live{.solution = solution,
                       .sigmas = model_sigmas(run_->scene(), solution),
                       .error = error,
                       .fps = rate_.per_second(),
                       .views = shown_,
                       .stamp = frame.stamp};
  show([&](Viewer& viewer) { viewer.frame(live); });
  if (controls_.recording_wanted() && !recorder_.add(frame, solution)) controls_.cancel_recording();
  do_what_is_asked();
}

bool LiveRun::wait_while_paused(const std::function<bool()>& interrupted) {
  if (tracking_ && !viewers_.empty()) {
    controls_.wait_while_paused([&] {
      rate_.clear();
      do_what_is_asked();
      return !interrupted();
    });
    do_what_is_asked();
  }
  return controls_.end_wanted();
}

void LiveRun::do_what_is_asked() {
  if (!controls_.recording_wanted()) recorder_.stop();
  set_status();
  if (!shown_ || !controls_.take_snapshot()) return;
  try {
    folder_->write_with([this] { write_snapshot(); });
  } catch (const std::exception& e) {  // the run goes on
    say(fmt::format("there is no snapshot: {}", e.what()));
  }
}

void LiveRun::set_status() {
  const LiveStatus now{.paused = controls_.paused(), .recorded = recorder_.recorded()};
  if (now == std::exchange(status_, now)) return;
  show([&](Viewer& viewer) { viewer.set_status(now); });
}

void LiveRun::write_snapshot() {
  const std::string name = fmt::format("snapshot_{:06}", shown_->frame);
  if (!renderer_) renderer_ = std::make_unique<Renderer>(run_->scene());
  const std::vector<cv::Mat> views =
      draw_views(*renderer_, run_->scene(), *shown_, run_->cameras());
  const std::string picture = png(joined(views, ViewLayout::row));
  TextFile(run_->file(name + ".png")).write(picture);
  std::vector<bool> known = shown_->hidden;
  known.flip();
  if (std::ranges::find(known, true) != known.end())
    TextFile(run_->file(name + ".yaml")).write(pose_yaml(run_->scene(), shown_->state, known));
  say(fmt::format("{}.png and its pose will be with the results when the run ends", name));
}

void LiveRun::say(const std::string& text) {
  tell_(text);
  show([&](Viewer& viewer) { viewer.say(text); });
}

/// Calls a function with every viewer. The run goes on without what one of them cannot show.
template <class Function>
void LiveRun::show(const Function& function) {
  for (const auto& viewer : viewers_) {
    try {
      function(*viewer);
    } catch (const std::exception& e) {
      if (!std::exchange(told_of_error_, true))
        tell_(fmt::format("note: the live view misses something: {}; the run goes on", e.what()));
    }
  }
}

}  // namespace hypotrack
