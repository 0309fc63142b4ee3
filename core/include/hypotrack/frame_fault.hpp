#pragma once

#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// What is wrong with a frame's pictures or time, as seen before its search. A frame with wrong
/// pictures is not searched: its status is `missing`.
enum class FrameFault {
  none,
  frozen,        ///< a view repeats its picture while another one moves
  same_picture,  ///< the first two views show one picture
  exchanged,     ///< the first two views match the cameras the other way round
  black,         ///< a view is black, or its depth is nowhere measured
  saturated,     ///< a view is white
  brightness,    ///< a view is suddenly brighter or darker; the frame is searched
  time_back,     ///< the time does not follow the one before; the frame is searched
  time_gap,      ///< no frame came for long; the frame is searched
};
HYPOTRACK_API std::string_view to_string(FrameFault fault);

}  // namespace hypotrack
