#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads numbers of either byte order; those beyond the end are 0.
class Numbers {
 public:
  Numbers(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  /// Returns the number of `size` bytes at an offset.
  std::uint32_t at(std::size_t offset, std::size_t size) const;

 private:
  std::string_view bytes_;
  bool big_endian_;
};

/// Calls a function with name and content of each part of a JPEG, PNG or WebP file until it returns
/// false. Names are four letters; those of JPEG's segments, which end at the first scan, are the
/// byte of the marker.
void for_each_part(std::string_view bytes,
                   const std::function<bool(std::string_view, std::string_view)>& take);

/// A directory of a TIFF file, or of what has its form.
struct TiffDirectory {
  Numbers numbers;          ///< of the file
  std::size_t place = 0;    ///< in the file
  std::size_t entries = 0;  ///< of 12 bytes
  bool is_inside = false;

  /// Returns the place of an entry of this tag; 0 without one.
  std::size_t entry(std::uint32_t tag) const;
  /// Returns an entry's first number, which may have two bytes; 0 without an entry.
  std::uint32_t value(std::uint32_t tag) const;
  /// Returns the place of the next directory; 0 after the last.
  std::size_t next() const;
};

/// Returns whether bytes begin as a TIFF file (TIFF 6.0, section 2), or as Exif does.
bool is_tiff(std::string_view bytes);

/// Returns the first directory of a TIFF file, or the one at `place`.
TiffDirectory tiff_directory(std::string_view bytes, std::size_t place = 0);

}  // namespace internal
}  // namespace hypotrack
