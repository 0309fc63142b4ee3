// Pictures through the loader, which never throws.

#include <array>

#include "hypotrack/api/image_file.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(picture, "picture") {
  const std::filesystem::path file = scratch_file("picture", bytes);
  const ReadImage color = read_color(file, 12), mask = read_mask(file),
                  depth = read_depth(file, 1e-3);
  const std::array files{file};
  for (const std::string& note : {orientation_note(files), contents_note(files), mask_note(files),
                                  bits_note(files, std::nullopt)})
    require(note.empty() || note.starts_with(file.string()), "notes name the file");
  for (const ReadImage* image : {&color, &mask, &depth})
    require(image->image.empty() != image->problem.empty(), "an image or a problem");
  if (!color.problem.empty()) throw DataError(color.problem);
  require(color.image.type() == CV_8UC3, "colours are 8-bit BGR");
  require(mask.problem.empty() && mask.image.type() == CV_8UC1, "masks are 8-bit");
}

}  // namespace hypotrack::fuzz
