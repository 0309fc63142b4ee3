#include "start_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/solution.hpp"

namespace hypotrack::app {
namespace {

/// Returns the name of a scene's starter, or the names of those it tries.
std::string name_of(const ConfigNode& from) {
  if (from.is_map()) return from.get("type").scalar();
  if (!from.is_list()) return from.scalar();
  std::string out;
  for (std::size_t i = 0; i < from.size(); ++i) out += (i == 0 ? "" : ", ") + name_of(from.at(i));
  return out;
}

}  // namespace

void check_picture_file(const std::filesystem::path& file) {
  if (file.extension() != ".png")
    throw ConfigError(
        fmt::format("--draw {}: pictures are written as PNG; expected a name that "
                    "ends in .png",
                    file.string()));
  expect_writable(file, "--draw");
}

void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
  const std::vector<unsigned char> bytes = encode_image(".png", picture);
  if (bytes.empty())
    throw OutputError(fmt::format("{}: the picture cannot be encoded as PNG", file.string()));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write_whole(file, text);
}

StartToDraw given_start(const OpenedScene& session, const Eigen::VectorXd& state,
                        const Frame& frame) {
  const InitSettings& init = session.init;
  std::string text = fmt::format("frame {}, start: {}", frame.index, name_of(init.from));
  if (init.pose.defined()) text += ", changed by init.pose";
  if (init.away > 0 || init.away_turn > 0 || init.away_angles > 0) text += ", displaced";
  return {.state = state, .caption = {text}};
}

StartToDraw found_start(const OpenedScene& session, SceneTracker& tracker, const Frame& frame) {
  const Solution solution = tracker.track(frame);
  StartToDraw out;
  std::string text = fmt::format("frame {}, start: {}; ", frame.index, name_of(session.init.from));
  for (std::size_t m = 0; m < solution.models.size(); ++m) {
    const Status status = solution.models[m];
    const bool found = status == Status::tracked || status == Status::uncertain;
    out.hidden.push_back(!found);
    text += fmt::format("{}{} {}", m == 0 ? "" : ", ", session.scene->items()[m].name,
                        found ? "found" : "not found");
    if (found && m < solution.probabilities.size())
      text +=
          fmt::format(" ({}, probability {:.2f})", to_string(status), solution.probabilities[m]);
  }
  if (std::ranges::find(out.hidden, false) != out.hidden.end()) out.state = solution.state;
  out.caption = {text};
  return out;
}

}  // namespace hypotrack::app
