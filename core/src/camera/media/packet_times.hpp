#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "camera/media/ffmpeg.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A picture that players show.
struct ShownPicture {
  std::int64_t time = 0;  ///< of its presentation, in units of the stream
  bool cut = false;       ///< its data are not whole
};

/// The pictures of a video, read from its packets without decoding.
struct PacketTimes {
  std::vector<ShownPicture> shown;  ///< by time, which grows
  bool numbered = false;            ///< there are no times at all: these are numbers
  bool presented = true;            ///< the packets say when; false: frames keep their order only
  std::size_t repeated = 0;         ///< pictures that an edit list shows once more
  std::string problem_of_end;       ///< note for the user if data are missing at the end
};

/// Finds the packets of H.264 that hold the second field of a picture, which files store as packets
/// of their own.
class SecondFields {
 public:
  explicit SecondFields(const Demuxer& video);
  /// Takes the next packet in order of decoding. Returns whether it completes a picture.
  bool take(const AVPacket& packet);

 private:
  Ffmpeg<AVCodecContext> codec_;
  Ffmpeg<AVCodecParserContext> parser_;  ///< null for other codecs
  int open_ = 0;                         ///< parity of a field that lacks its second
};

/// Returns whether a container has a time for each frame, and not a rate for all.
bool has_clock(const Demuxer& video);

/// Reads all packets but the ones that an edit list or the codec hides.
PacketTimes read_packet_times(Demuxer& video);

}  // namespace internal
}  // namespace hypotrack
