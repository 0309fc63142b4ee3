#include "output/table_text.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "hypotrack/api/tables.hpp"

namespace hypotrack::internal {

std::string states_header(const Scene& scene) {
  std::string line = "frame,time";
  for (const Parameter& p : scene.parameters()) line += "," + p.name;
  return line + "\n";
}

}  // namespace hypotrack::internal

namespace hypotrack {

std::string landmarks_header(std::span<const std::string> landmark_names) {
  std::string line = "frame,time";
  for (const std::string& name : landmark_names) line += fmt::format(",{0}_x,{0}_y,{0}_z", name);
  return line + "\n";
}

std::string table_line(int frame, double time, const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::string line = fmt::format("{},{}", frame, time);
  for (const double value : values) line += fmt::format(",{}", value);
  return line + "\n";
}

std::string stamp_text(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return fmt::format("{}{}.{:09}", nanoseconds < 0 ? "-" : "", std::abs(nanoseconds / kSecond),
                     std::abs(nanoseconds % kSecond));
}

}  // namespace hypotrack

namespace hypotrack::internal {

std::string landmarks_line(int frame, double time, const Eigen::Matrix3Xd& landmarks,
                           const std::vector<bool>& absent) {
  if (absent.empty()) return table_line(frame, time, landmarks.reshaped());
  std::string line = fmt::format("{},{}", frame, time);
  for (Eigen::Index i = 0; i < landmarks.cols(); ++i)
    for (const double value : landmarks.col(i)) {
      if (absent[static_cast<std::size_t>(i)])
        line += fmt::format(",{}", kAbsent);
      else
        line += fmt::format(",{}", value);
    }
  return line + "\n";
}

}  // namespace hypotrack::internal
