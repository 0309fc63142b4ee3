#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Writes PNG files from all cores while the caller goes on. What an image's file holds does not
/// depend on when and where it is compressed.
class HYPOTRACK_API ImageWriter {
 public:
  ImageWriter();
  /// Finishes the files that are begun and drops those that wait.
  ~ImageWriter();
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;

  /// Takes an image (any that PNG can hold; it must not change any more) and its file. With many
  /// images waiting, writes this one before it returns. Throws OutputError if an image so far could
  /// not be written; nothing more is written then.
  void write(std::filesystem::path file, cv::Mat image);

  /// Returns when all files are complete. Throws like write().
  void wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
