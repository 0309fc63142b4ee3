#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "base/open_folder.hpp"

namespace hypotrack::app {

/// A new folder of pairs: left_01.png, right_01.png and so on, which `hypotrack calibrate` reads.
class PairFolder {
 public:
  /// Makes the folder. Throws OutputError if it cannot, or if there is something in it.
  explicit PairFolder(std::filesystem::path folder);
  /// Removes an empty folder.
  ~PairFolder();
  PairFolder(const PairFolder&) = delete;
  PairFolder& operator=(const PairFolder&) = delete;

  /// Writes both pictures or none; returns the name of the left one. Throws OutputError.
  std::string write(const cv::Mat& left, const cv::Mat& right);
  /// Removes all pairs.
  void discard();
  /// Returns the pattern of the `left` or `right` pictures.
  std::string pattern(const std::string& side) const;
  bool empty() const { return pairs_ == 0; }
  /// Returns where the folder is, also after somebody has renamed it.
  std::filesystem::path path() const { return open_ ? open_->place() : folder_; }

 private:
  std::filesystem::path file(const std::string& side, int number) const;

  std::filesystem::path folder_;
  std::optional<OpenFolder> open_;
  int pairs_ = 0;
};

}  // namespace hypotrack::app
