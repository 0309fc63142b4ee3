#include "lab/live/live_view.hpp"

#include <fmt/format.h>

#include "lab/live/access.hpp"
#include "lab/live/live_server.hpp"
#include "lab/live/live_state.hpp"
#include "lab/live/view_pictures.hpp"

namespace hypotrack::internal {
namespace {

AccessRules checked(const LiveViewOptions& options) {
  AccessRules rules{
      .host = options.host, .token = options.token, .token_source = options.token_source};
  check(rules);
  return rules;
}

class HttpLiveView final : public LiveView {
 public:
  HttpLiveView(const LiveViewOptions& options, RunControls& controls)
      : rules_(checked(options)), server_(rules_, options.port, {state_, pictures_, controls}) {
    state_.say("the scene is being opened");
  }
  ~HttpLiveView() override {
    state_.end();
    pictures_.close();
  }

  std::string address() const override;
  void open(const Scene& scene, const std::vector<Camera>& cameras) override {
    scene_ = &scene;
    pictures_.begin(scene, cameras);
  }
  void begin(std::optional<int> frames) override {
    state_.say("");
    state_.begin(*scene_, frames);
  }
  void frame(const LiveFrame& frame) override {
    if (frame.views) pictures_.show(frame.views);
    state_.add(*scene_, frame);
  }
  void set_status(const LiveStatus& status) override { state_.set_paused(status.paused); }
  void say(const std::string& text) override { state_.say(text); }
  void end() override { pictures_.end(); }

 private:
  AccessRules rules_;
  const Scene* scene_ = nullptr;
  LiveState state_;
  ViewPictures pictures_{[this](const std::string& text) { state_.say(text); }};
  LiveServer server_;
};

std::string HttpLiveView::address() const {
  const bool brackets = rules_.host.find(':') != std::string::npos;
  const std::string host = brackets ? "[" + rules_.host + "]" : rules_.host;
  const std::string token = rules_.token.empty() ? "" : "?token=" + rules_.token;
  return fmt::format("http://{}:{}/{}", host, server_.port(), token);
}

}  // namespace

std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& options, RunControls& controls) {
  return std::make_unique<HttpLiveView>(options, controls);
}

}  // namespace hypotrack::internal
