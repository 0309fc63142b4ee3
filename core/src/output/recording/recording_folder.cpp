#include "output/recording/recording_folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

RecordingFolder::RecordingFolder(const std::filesystem::path& folder) : given_(folder) {
  std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  name_ = whole.filename().string();
  part_name_ = ".part." + name_;
  std::error_code error;
  if (std::filesystem::exists(whole, error) &&
      !(std::filesystem::is_directory(whole) && std::filesystem::is_empty(whole)))
    throw OutputError(fmt::format(
        "{}: exists already; name a new folder with --out, or remove this one", whole.string()));
  std::filesystem::create_directories(whole.parent_path(), error);
  if (error)
    throw OutputError(fmt::format("{}: the folder cannot be made: {}; name another with --out",
                                  whole.string(), error.message()));
  parent_.emplace(whole.parent_path());
  parent_->write_with([this] { make_part(); });
}

void RecordingFolder::make_part() {
  const std::filesystem::path part = parent_->path() / part_name_;
  const auto refuse_used = [this] {
    throw OutputError(
        fmt::format("{}: another program is writing into it; name another folder with --out, or "
                    "wait for its end",
                    (parent_->path() / name_).string()));
  };
  std::error_code error;
  if (std::filesystem::is_directory(part, error) && !OpenFolder(part).lock()) refuse_used();
  std::filesystem::remove_all(part, error);
  std::filesystem::create_directory(part, error);
  if (error)
    throw OutputError(fmt::format("{}: the folder cannot be made: {}; name another with --out",
                                  (parent_->path() / name_).string(), error.message()));
  part_.emplace(part);
  if (!part_->lock() || part_->moved()) refuse_used();
}

RecordingFolder::~RecordingFolder() {
  if (done_ || !part_ || !part_->exists()) return;
  std::error_code ignored;
  std::filesystem::remove_all(part_->place(), ignored);
}

std::filesystem::path RecordingFolder::place() const {
  return parent_->moved() ? parent_->place() / name_ : given_;
}

void RecordingFolder::finish() {
  parent_->write_with([this] {
    part_->expect_exists();
    const std::filesystem::path final = parent_->path() / name_;
    std::error_code error;
    std::filesystem::remove(final, error);  // an empty folder of that name
    std::filesystem::rename(part_->place(), final, error);
    if (error)
      throw OutputError(
          fmt::format("{}: the folder cannot be made: {}", final.string(), error.message()));
  });
  done_ = true;
}

}  // namespace hypotrack::internal
