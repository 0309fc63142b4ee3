#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>

namespace hypotrack::internal {

/// The header of a PGM or PPM file (netpbm.sourceforge.net/doc/ppm.html).
struct Netpbm {
  char kind = 0;  ///< the digit behind P: 2 and 3 are text, 5 and 6 bytes; 2 and 5 are grey
  std::uint64_t width = 0, height = 0;
  int largest = 0;               ///< the value of white
  std::string_view pixels = {};  ///< what follows the header

  /// Returns whether bytes of pixels lack; false for text.
  bool is_cut_off() const;
};

/// Reads the header of a PGM or PPM file; nothing if there is none.
std::optional<Netpbm> netpbm_of(std::string_view bytes);

/// Decodes a file of bytes: 8 bits where white is 255, or 16 bits as stored. Returns an empty image
/// if pixels lack. OpenCV takes values of text alone as shares of the largest.
cv::Mat decode_netpbm(const Netpbm& header);

}  // namespace hypotrack::internal
