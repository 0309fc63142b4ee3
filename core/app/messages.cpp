#include "messages.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <new>
#include <system_error>

#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::app {
namespace {

/// Returns how right the statuses were and how models were recovered, if known.
std::string status_text(const StatusMetrics& s) {
  std::string text;
  if (!std::isnan(s.false_tracked_share))
    text += fmt::format(
        "tracked: {:.2f} % of these frames are off by more than {:.0f} mm or show nothing\n",
        100 * s.false_tracked_share, kFalseErrorMm);
  if (!std::isnan(s.right_tracked_share))
    text += fmt::format("within {:.0f} mm: {:.1f} % of these frames are tracked\n", kRightErrorMm,
                        100 * s.right_tracked_share);
  if (s.returns > 0)
    text += fmt::format("{} returns: {:.0f} % recovered within 2 frames, {:.0f} % within 10\n",
                        s.returns, 100 * s.recovered_2_share, 100 * s.recovered_10_share);
  return text;
}

}  // namespace

std::string failure_text() {
  try {
    throw;
  } catch (const Error& e) {
    return with_advice(e.what());
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::system_error& e) {  // a full disk behind stdout
    return described(e);
  } catch (const std::exception& e) {
    return "unexpected error: " + with_advice(e.what());
  } catch (...) {
    return "unexpected error: a plugin threw something that is no std::exception";
  }
}

std::string summary_text(const Summary& s, const std::filesystem::path& out) {
  const Metrics& m = s.metrics;
  std::string text = fmt::format(
      "{} frames ({} tracked, {} uncertain, {} lost, {} absent, {} missing) at {:.1f} fps ({:.1f} "
      "by "
      "the clock), {:.0f} evaluations/s, {}\n",
      m.frames, m.status.tracked_frames, m.status.uncertain_frames, m.status.said_lost_frames,
      m.status.absent_frames, m.missing_frames, s.fps, clock_fps(s), s.evaluations_per_second,
      s.backend);
  if (m.evaluated_frames > 0)
    text += fmt::format(
        "joint error: mean {:.2f} mm, median {:.2f} mm, 95 % below {:.2f} mm, {:.1f} % of the "
        "frames below 10 mm\n",
        m.mean_error_mm, m.median_error_mm, m.p95_error_mm, 100 * m.success_curve[10]);
  text += status_text(m.status);
  if (s.mean_sigma) text += fmt::format("sigma: mean {:.2f} mm", 1000 * *s.mean_sigma);
  if (s.reliability.count() > 0)
    text += fmt::format(
        ", {:.0f} % of the landmarks within one, {:.0f} % within two, {:.0f} % within three",
        100 * s.reliability.within(1), 100 * s.reliability.within(2),
        100 * s.reliability.within(3));
  if (s.mean_sigma) text += fmt::format("\n");
  text += fmt::format("results in {}\n", out.string());
  return text;
}

std::string summary_in(const std::string& log) {
  const std::size_t last = log.rfind("results in ");
  const std::size_t first = log.rfind(" tracked, ", last);
  if (last == std::string::npos || first == std::string::npos) return {};
  const std::size_t begin = log.rfind('\n', first) + 1;  // npos + 1 is 0
  return log.substr(begin, log.find('\n', last) + 1 - begin);
}

}  // namespace hypotrack::app
