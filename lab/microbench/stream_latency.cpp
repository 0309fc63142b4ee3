// Measures how long solutions take to a reader of the output `stream` on this machine:
//
//   bench_stream_latency SCENE FRAMES [KEY=VALUE ...]
//
// Waiting: from the pictures (Frame::taken, or when the source gave them) to the tracker. Tracking:
// to the solution. Delivery: to the reader, which has the whole line then.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/local/stream_protocol.hpp>
#include <chrono>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

using Clock = std::chrono::steady_clock;

/// A run without files.
class BareRun final : public OutputContext {
 public:
  BareRun(const Scene& scene, const Source& source) : scene_(scene), source_(source) {}
  const Scene& scene() const override { return scene_; }
  const std::vector<Camera>& cameras() const override { return source_.cameras(); }
  double frame_rate() const override { return source_.frame_rate(); }
  bool fixed_lag() const override { return false; }
  std::filesystem::path file(const std::string& name) override { throw OutputError(name); }
  Renderer& renderer() override { throw DeviceError("this run has no renderer"); }

 private:
  const Scene& scene_;
  const Source& source_;
};

/// Times of one frame.
struct Times {
  Clock::time_point taken, given, solved;
};

/// Reads the first line and says so, then notes when each further line is there.
class Reader {
 public:
  explicit Reader(const std::string& socket) : stream_(Endpoint(socket)) {
    std::getline(stream_, line_);
    thread_ = std::thread([this] {
      while (std::getline(stream_, line_)) times_.push_back(Clock::now());
    });
  }
  std::vector<Clock::time_point> times() {
    thread_.join();
    return times_;
  }

 private:
  using Protocol = boost::asio::local::stream_protocol;
  using Endpoint = Protocol::endpoint;
  Protocol::iostream stream_;
  std::string line_;
  std::vector<Clock::time_point> times_;
  std::thread thread_;
};

void print(const char* what, std::vector<double> milliseconds) {
  std::ranges::sort(milliseconds);
  const auto quantile = [&](double share) {
    return milliseconds[static_cast<std::size_t>(share *
                                                 static_cast<double>(milliseconds.size() - 1))];
  };
  fmt::print("{:<10} median {:8.3f} ms   95 % {:8.3f} ms\n", what, quantile(0.5), quantile(0.95));
}

void report(const std::vector<Times>& sent, const std::vector<Clock::time_point>& received) {
  std::vector<double> waiting, tracking, delivery, all;
  const auto milliseconds = [](Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  };
  for (std::size_t i = 0; i < sent.size(); ++i) {
    waiting.push_back(milliseconds(sent[i].given - sent[i].taken));
    tracking.push_back(milliseconds(sent[i].solved - sent[i].given));
    delivery.push_back(milliseconds(received[i] - sent[i].solved));
    all.push_back(milliseconds(received[i] - sent[i].taken));
  }
  fmt::print("{} frames\n", sent.size());
  print("waiting", waiting);
  print("tracking", tracking);
  print("delivery", delivery);
  print("all", all);
}

void measure(const std::string& file, int frames, const std::vector<std::string>& set) {
  Session session(file, {.set = set, .plugin_path = {}});
  PluginLoader plugins;
  const auto source =
      plugins.make<Source>(ConfigNode::load_scene(file, set).get("source"), &session.scene());
  Tracker tracker = session.tracker(source->cameras());
  const std::string socket = fmt::format("/tmp/bench_stream_latency_{}", getpid());
  const auto output = plugins.make<Output>(
      ConfigNode::parse("{type: stream, socket: " + socket + "}", "bench"), &session.scene());
  BareRun run(session.scene(), *source);
  output->begin(run);
  Reader reader(socket);
  std::vector<Times> times;
  while (static_cast<int>(times.size()) < frames) {
    const std::optional<Frame> frame = source->next();
    if (!frame) break;
    const auto given = Clock::now();
    const Solution solution = tracker.track(*frame);
    times.push_back({frame->taken.value_or(given), given, Clock::now()});
    output->online(*frame, solution);
  }
  output->finish(true);
  const auto received = reader.times();
  if (received.size() != times.size()) throw OutputError("lines were dropped; nothing is measured");
  report(times, received);
}

}  // namespace
}  // namespace hypotrack

int main(int argc, char** argv) try {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_stream_latency SCENE FRAMES [KEY=VALUE ...]\n");
    return 2;
  }
  hypotrack::measure(argv[1], std::stoi(argv[2]), {argv + 3, argv + argc});
  return 0;
} catch (const std::exception& e) {
  fmt::print(stderr, "bench_stream_latency: {}\n", e.what());
  return 1;
}
