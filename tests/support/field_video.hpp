#pragma once

#include <filesystem>

namespace hypotrack::test {

/// How a file stores the two fields of a picture.
enum class FieldPackets {
  timed,    ///< a packet each, each with a time
  untimed,  ///< a packet each; the second has no time
  joined,   ///< one packet
};

/// Writes an H.264 video of 64x64 pixels and 25 pictures per second, whose fields are coded one
/// after the other. Brightness of picture i: 40 + 8 i in its first field, 4 more in its second.
/// The file's ending chooses its container. Throws std::runtime_error.
void write_field_video(const std::filesystem::path& file, int pictures, FieldPackets packets);

}  // namespace hypotrack::test
