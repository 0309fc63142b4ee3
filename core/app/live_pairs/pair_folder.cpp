#include "live_pairs/pair_folder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "start_drawing.hpp"

namespace hypotrack::app {

PairFolder::PairFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directory(folder_, error);
  if (error || !std::filesystem::is_directory(folder_))
    throw OutputError(
        fmt::format("{}: the folder for the pairs cannot be made: {}; name another "
                    "with --pairs",
                    folder_.string(), error ? error.message() : "there is a file of that name"));
  if (!std::filesystem::is_empty(folder_, error))
    throw OutputError(
        fmt::format("{}: is not empty; name another folder for the pairs with --pairs, or remove "
                    "this one. Pairs in it are calibrated with --left '{}' --right '{}'",
                    folder_.string(), pattern("left"), pattern("right")));
  open_.emplace(folder_);
}

PairFolder::~PairFolder() {
  std::error_code ignored;
  if (pairs_ == 0 && open_ && open_->exists()) std::filesystem::remove(path(), ignored);
}

std::filesystem::path PairFolder::file(const std::string& side, int number) const {
  return open_->path() / fmt::format("{}_{:02}.png", side, number);
}

std::string PairFolder::write(const cv::Mat& left, const cv::Mat& right) {
  const std::filesystem::path first = file("left", pairs_ + 1);
  open_->write_with([&] {
    write_picture(first, left);
    try {
      write_picture(file("right", pairs_ + 1), right);
    } catch (const OutputError&) {
      std::error_code ignored;
      std::filesystem::remove(first, ignored);
      throw;
    }
  });
  ++pairs_;
  return first.filename().string();
}

void PairFolder::discard() {
  std::error_code ignored;
  for (; pairs_ > 0; --pairs_)
    for (const char* side : {"left", "right"}) std::filesystem::remove(file(side, pairs_), ignored);
}

std::string PairFolder::pattern(const std::string& side) const {
  return (path() / (side + "_*.png")).string();
}

}  // namespace hypotrack::app
