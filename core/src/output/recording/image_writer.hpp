#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Writes an image file. Throws OutputError, and leaves no half of a file then.
void write_picture(const std::filesystem::path& file, const cv::Mat& image,
                   const std::vector<int>& parameters);

/// Writes image files in other threads while the caller goes on. The files do not depend on the
/// threads' timing.
class ImageWriter {
 public:
  /// `threads`: beside the caller's; 0: as many as there are cores, less one.
  explicit ImageWriter(int threads);
  /// Finishes the files that are begun and drops waiting ones.
  ~ImageWriter();
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;

  /// Queues an image (any that the format of the file's name can hold); the image must not change
  /// afterwards. If many images wait, it writes this one itself. Throws OutputError if an earlier
  /// image could not be written; it writes nothing more then.
  void write(std::filesystem::path file, cv::Mat image);

  /// Waits until all files are complete. Throws like write().
  void wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
