#include "hypotrack/plugin/source.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/scene.hpp"
#include "plugin/plugin_call.hpp"
#include "tile/frame_clock.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

/// Names a source in messages, without its library.
std::string name_of(const Source& source) {
  return source.label().empty() ? "the source" : source.short_label();
}

void check_truth(const std::string& source, const Frame& frame, const char* what,
                 Eigen::Index found, Eigen::Index expected) {
  if (found == 0 || found == expected) return;  // 0: unknown
  throw DataError(
      fmt::format("{}, frame {}: there are {} {}, the scene has {}; this is a bug in the "
                  "source",
                  source, frame.index, found, what, expected));
}

void check_pictures(const std::string& source, const Frame& frame,
                    const std::vector<Camera>& cameras) {
  try {
    internal::check_views(frame, cameras);
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}; this is a bug in the source", source, e.what()));
  }
}

}  // namespace

/// What a source remembers of the frames so far.
struct Source::Progress {
  /// How many numbers the ground truth of a scene has.
  struct TruthSize {
    Eigen::Index parameters = 0, landmarks = 0;
  };

  void check_order(const std::string& source, const Frame& frame);

  std::optional<TruthSize> truth;             ///< of the scene, if it is known
  std::optional<internal::FrameClock> clock;  ///< once there was a frame
  int last_index = -1;
  bool stamped = false;  ///< frames have Frame::stamp
  int frames = 0;        ///< so far
  bool ended = false;    ///< by itself
};

void Source::Progress::check_order(const std::string& source, const Frame& frame) {
  if (frame.index <= last_index || !std::isfinite(frame.time))
    throw DataError(
        fmt::format("{}: frame {} at {} s follows frame {}, expected numbers from 0 on that grow, "
                    "and a time; this is a bug in the source",
                    source, frame.index, frame.time, last_index));
  if (last_index >= 0 && frame.stamp.has_value() != stamped)
    throw DataError(
        fmt::format("{}: frame {} {} a stamp, the first {}; expected one in all frames or in none; "
                    "this is a bug in the source",
                    source, frame.index, stamped ? "lacks" : "has", stamped ? "has one" : "none"));
  stamped = frame.stamp.has_value();
  last_index = frame.index;
}

Source::Source() : progress_(std::make_unique<Progress>()) {}
Source::~Source() = default;

void Source::check_for(const Scene& scene) {
  const std::string name = name_of(*this);
  if (cameras().empty())
    throw DataError(
        fmt::format("{} has no camera, expected one at least; this is a bug in the source", name));
  for (const Camera& camera : cameras())
    if (camera.fx == 0 && camera.fy == 0)
      throw DataError(
          fmt::format("{} has cameras without a calibration, with which nothing can be "
                      "tracked; expected "
                      "`calibration: {{file: ...}}`, which `hypotrack calibrate` writes",
                      name));
  const double rate = frame_rate();
  if (!(std::isfinite(rate) && rate > 0))
    throw DataError(fmt::format(
        "{} says that it has {} frames per second, expected a number above 0; this is a "
        "bug in the source",
        name, rate));
  progress_->truth = Progress::TruthSize{scene.dimension(),
                                         static_cast<Eigen::Index>(scene.landmark_names().size())};
}

std::optional<Frame> Source::next() {
  Progress& so_far = *progress_;
  std::optional<Frame> frame = [&] {
    const detail::ThreadFrame unknown(std::nullopt);  // it may read ahead of the tracker
    if (label().empty()) return do_next();
    const std::string place = so_far.last_index < 0
                                  ? "before the first frame"
                                  : fmt::format("after frame {}", so_far.last_index);
    return detail::call_plugin(place + ": " + label(), explains(), "", [&] { return do_next(); });
  }();
  so_far.ended = !frame;
  if (!frame) return frame;
  ++so_far.frames;
  const std::string name = name_of(*this);
  so_far.check_order(name, *frame);
  if (!frame->views.empty()) check_pictures(name, *frame, cameras());
  if (frame->views.empty() && frame->problem.empty())
    frame->problem =
        fmt::format("{} gives no views and no reason; this is a bug in the source", name);
  if (!so_far.clock) so_far.clock.emplace(frame_rate(), live());
  so_far.clock->take(*frame);
  if (frame->truth && so_far.truth) {
    check_truth(name, *frame, "numbers in the true state", frame->truth->state.size(),
                so_far.truth->parameters);
    check_truth(name, *frame, "true landmarks", frame->truth->landmarks.cols(),
                so_far.truth->landmarks);
  }
  return frame;
}

std::vector<std::string> Source::statistics() const {
  constexpr int kUsual = 1;  // frames too many in the headers of videos
  std::vector<std::string> lines = do_statistics();
  if (label().empty()) return lines;  // the source around it says more
  const int announced = frame_count().value_or(0);
  if (progress_->ended && lines.empty() && progress_->frames + kUsual < announced)
    lines.push_back(
        fmt::format("{}: ends after {} frames, it announced {}; are some of its data missing?",
                    name_of(*this), progress_->frames, announced));
  return lines;
}

}  // namespace hypotrack
