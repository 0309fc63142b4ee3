#include "session/checked_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "hypotrack/error.hpp"
#include "plugin/plugin_call.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::internal {

CheckedSource::CheckedSource(std::unique_ptr<Source> source, const Scene& scene, std::string plugin,
                             std::string who)
    : source_(std::move(source)),
      plugin_(std::move(plugin)),
      who_(std::move(who)),
      parameters_(scene.dimension()),
      landmarks_(static_cast<Eigen::Index>(scene.landmark_names().size())),
      explains_(detail::comes_with_hypotrack(source_.get())),
      clock_(source_->frame_rate(), source_->live()) {
  if (source_->cameras().empty())
    throw DataError(fmt::format(
        "{} has no camera, expected one at least; this is a bug in the source", plugin_));
  for (const Camera& camera : source_->cameras())
    if (camera.fx == 0 && camera.fy == 0)
      throw DataError(
          fmt::format("{} has cameras without a calibration, with which nothing can be "
                      "tracked; expected "
                      "`calibration: {{file: ...}}`, which `hypotrack calibrate` writes",
                      plugin_));
  const double rate = source_->frame_rate();
  if (!(std::isfinite(rate) && rate > 0))
    throw DataError(fmt::format(
        "{} says that it has {} frames per second, expected a number above 0; this is a "
        "bug in the source",
        plugin_, rate));
}

std::optional<Frame> CheckedSource::ask() {
  const detail::ThreadFrame unknown(std::nullopt);  // it may read ahead of the tracker
  const std::string place =
      last_index_ < 0 ? "before the first frame" : fmt::format("after frame {}", last_index_);
  return detail::call_plugin(place + ": " + who_, explains_, "", [&] { return source_->next(); });
}

std::optional<Frame> CheckedSource::next() {
  std::optional<Frame> frame = ask();
  ended_ = !frame;
  if (!frame) return frame;
  ++frames_;
  check_order(*frame);
  if (!frame->views.empty()) check_pictures(*frame);
  if (frame->views.empty() && frame->problem.empty())
    frame->problem =
        fmt::format("{} gives no views and no reason; this is a bug in the source", plugin_);
  clock_.take(*frame);
  if (frame->truth) {
    check_truth(*frame, "numbers in the true state", frame->truth->state.size(), parameters_);
    check_truth(*frame, "true landmarks", frame->truth->landmarks.cols(), landmarks_);
  }
  return frame;
}

void CheckedSource::check_order(const Frame& frame) {
  if (frame.index <= last_index_ || !std::isfinite(frame.time))
    throw DataError(
        fmt::format("{}: frame {} at {} s follows frame {}, expected numbers from 0 on that grow, "
                    "and a time; this is a bug in the source",
                    plugin_, frame.index, frame.time, last_index_));
  if (last_index_ >= 0 && frame.stamp.has_value() != stamped_)
    throw DataError(fmt::format(
        "{}: frame {} {} a stamp, the first {}; expected one in all frames or in none; "
        "this is a bug in the source",
        plugin_, frame.index, stamped_ ? "lacks" : "has", stamped_ ? "has one" : "none"));
  stamped_ = frame.stamp.has_value();
  last_index_ = frame.index;
}

void CheckedSource::check_pictures(const Frame& frame) const {
  try {
    check_views(frame, source_->cameras());
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}; this is a bug in the source", plugin_, e.what()));
  }
}

void CheckedSource::check_truth(const Frame& frame, const char* what, Eigen::Index found,
                                Eigen::Index expected) const {
  if (found == 0 || found == expected) return;  // 0: unknown
  throw DataError(
      fmt::format("{}, frame {}: there are {} {}, the scene has {}; this is a bug in the "
                  "source",
                  plugin_, frame.index, found, what, expected));
}

std::vector<std::string> CheckedSource::statistics() const {
  constexpr int kUsual = 1;  // frames too many in the headers of videos
  std::vector<std::string> lines = source_->statistics();
  const int announced = source_->frame_count().value_or(0);
  if (ended_ && lines.empty() && frames_ + kUsual < announced)
    lines.push_back(
        fmt::format("{}: ends after {} frames, it announced {}; are some of its data missing?",
                    plugin_, frames_, announced));
  return lines;
}

}  // namespace hypotrack::internal
