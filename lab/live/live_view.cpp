#include "lab/live/live_view.hpp"

#include <fmt/format.h>

#include "lab/live/access.hpp"
#include "lab/live/live_server.hpp"
#include "lab/live/live_state.hpp"
#include "lab/live/run_controls.hpp"
#include "lab/live/view_pictures.hpp"

namespace hypotrack {
namespace {

AccessRules checked(const LiveViewOptions& options) {
  AccessRules rules{.host = options.host, .token = options.token};
  check(rules);
  return rules;
}

class HttpLiveView final : public LiveView {
 public:
  explicit HttpLiveView(const LiveViewOptions& options)
      : rules_(checked(options)), server_(rules_, options.port, {state_, pictures_, controls_}) {
    state_.say("the scene is being opened");
  }
  ~HttpLiveView() override {
    state_.end();
    pictures_.close();
  }

  std::string address() const override;
  std::unique_ptr<Output> output() override;
  void begin(std::optional<int> frames) override;
  void frame(const Frame& frame, const Solution& solution, double error) override;
  void wait_while_paused(const std::function<bool()>& interrupted) override;
  bool take_restart() override { return controls_.take_restart(); }

 private:
  class SnapshotOutput;
  void write_wanted_snapshot();

  AccessRules rules_;
  LiveState state_;
  RunControls controls_;
  ViewPictures pictures_{[this](const std::string& text) { state_.say(text); }};
  OutputContext* run_ = nullptr;  ///< while there is one
  std::optional<int> last_frame_;
  bool tracking_ = false;  ///< from the first frame on
  LiveServer server_;
};

/// Connects the view with a run's scene, cameras and folder.
class HttpLiveView::SnapshotOutput final : public Output {
 public:
  explicit SnapshotOutput(HttpLiveView& view) : view_(view) {}
  ~SnapshotOutput() override {
    view_.pictures_.end();
    view_.run_ = nullptr;
  }

  std::vector<std::string> file_names() const override { return {"snapshot_#.png"}; }
  void begin(OutputContext& run) override {
    view_.pictures_.begin(run.scene(), run.cameras());
    view_.run_ = &run;
  }
  void frame(const Frame& /*frame*/, const Solution& /*solution*/) override {}

 private:
  HttpLiveView& view_;
};

std::string HttpLiveView::address() const {
  const bool brackets = rules_.host.find(':') != std::string::npos;
  const std::string host = brackets ? "[" + rules_.host + "]" : rules_.host;
  const std::string token = rules_.token.empty() ? "" : "?token=" + rules_.token;
  return fmt::format("http://{}:{}/{}", host, server_.port(), token);
}

std::unique_ptr<Output> HttpLiveView::output() { return std::make_unique<SnapshotOutput>(*this); }

void HttpLiveView::begin(std::optional<int> frames) {
  tracking_ = true;
  state_.say("");
  state_.begin(run_->scene(), frames);
}

void HttpLiveView::frame(const Frame& frame, const Solution& solution, double error) {
  if (!frame.views.empty()) last_frame_ = frame.index;
  pictures_.show(frame, solution);
  state_.add(run_->scene(), solution, error);
  write_wanted_snapshot();
}

void HttpLiveView::wait_while_paused(const std::function<bool()>& interrupted) {
  if (!tracking_) return;
  controls_.wait_while_paused([&] {
    state_.set_paused(true);
    write_wanted_snapshot();
    return !interrupted();
  });
  state_.set_paused(controls_.paused());
}

void HttpLiveView::write_wanted_snapshot() {
  if (!last_frame_ || !controls_.take_snapshot()) return;
  const std::string name = fmt::format("snapshot_{:06}.png", *last_frame_);
  const bool written = pictures_.write(run_->file(name));
  state_.say(written ? fmt::format("{} will be with the results when the run ends", name)
                     : fmt::format("{} could not be written", name));
}

}  // namespace

std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& options) {
  return std::make_unique<HttpLiveView>(options);
}

}  // namespace hypotrack
