// Lists of the images of RGB-D recordings.

#include "image_list.hpp"

#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(image_list, "csv") {
  const auto images = rgbd::read_image_list(scratch_file("rgb.txt", bytes));
  const auto partners = rgbd::associate(images, images, 0.02);
  for (std::size_t i = 0; i < partners.size(); ++i)
    require(partners[i] == i, "an image is its own partner");
}

}  // namespace hypotrack::fuzz
