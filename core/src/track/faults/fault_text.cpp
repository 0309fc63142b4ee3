#include <fmt/format.h>

#include <array>

#include "track/faults/picture_checks.hpp"

namespace hypotrack {
namespace {

std::string name_of_view(int view) {
  static constexpr std::array<const char*, 4> kOrdinals{"first", "second", "third", "fourth"};
  const auto index = static_cast<std::size_t>(view);
  return index < kOrdinals.size() ? fmt::format("the {} view", kOrdinals[index])
                                  : fmt::format("view {}", view);
}

}  // namespace

std::string_view to_string(FrameFault fault) {
  static constexpr std::array<std::string_view, 9> kNames{"none",       "frozen",    "same_picture",
                                                          "exchanged",  "black",     "saturated",
                                                          "brightness", "time_back", "time_gap"};
  return kNames[static_cast<std::size_t>(fault)];
}

}  // namespace hypotrack

namespace hypotrack::internal {

bool spoils_pictures(FrameFault fault) {
  return fault > FrameFault::none && fault < FrameFault::brightness;
}

std::string describe(FrameFault fault, int view) {
  constexpr const char* kSkipped = "such frames are not searched and count as missing";
  switch (fault) {
    case FrameFault::none:
      return {};
    case FrameFault::frozen:
      if (view < 0)
        return fmt::format(
            "all views repeat earlier pictures; {}. Check how the pictures are taken and stored",
            kSkipped);
      return fmt::format(
          "{} repeats an earlier picture while another view "
          "moves; {}. Check this camera and how "
          "its pictures are stored",
          name_of_view(view), kSkipped);
    case FrameFault::same_picture:
      return fmt::format(
          "the first two views show the same picture, and nothing "
          "can be told from that about "
          "depth; {}. Is the second view read from files or a "
          "device of its own (source)?",
          kSkipped);
    case FrameFault::exchanged:
      return fmt::format(
          "the first two views match the cameras better the other "
          "way round; {}. Exchange them "
          "(source), or the cameras if the calibration has them "
          "the wrong way round",
          kSkipped);
    case FrameFault::black:
      return fmt::format(
          "{} is black or without depth; {}. Check this camera, its lens and its exposure, and for "
          "16-bit pictures `bits` (source)",
          name_of_view(view), kSkipped);
    case FrameFault::saturated:
      return fmt::format("{} is white; {}. Shorten the exposure, or lower the gain",
                         name_of_view(view), kSkipped);
    case FrameFault::brightness:
      return fmt::format(
          "the brightness of {} jumps; models may be lost for "
          "some frames. Fix exposure, gain and "
          "white balance of the cameras",
          name_of_view(view));
    case FrameFault::time_back:
      return "its time is not after that of the frame before; one frame's time "
             "is added to that "
             "instead. Check the clock of the source";
    case FrameFault::time_gap:
      return "no frame came for a while; models that moved may be searched for. "
             "Are frames "
             "missing, "
             "or is the unit of the times wrong?";
  }
  return {};
}

}  // namespace hypotrack::internal
