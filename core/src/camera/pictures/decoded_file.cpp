#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string_view>

#include "camera/pictures/netpbm.hpp"
#include "camera/pictures/orientation.hpp"
#include "camera/pictures/picture_header.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uintmax_t kLargestImageFile = std::uintmax_t{512} << 20;

/// Returns true if a JPEG or PNG lacks its end marker. Decoders fill truncated images with grey.
bool is_truncated(std::string_view all) {
  const std::string_view tail = all.substr(all.size() - std::min<std::size_t>(all.size(), 4096));
  if (all.starts_with("\xFF\xD8\xFF")) return tail.find("\xFF\xD9") == std::string_view::npos;
  if (all.starts_with("\x89PNG\r\n")) return tail.find("IEND") == std::string_view::npos;
  return false;
}

/// Decodes bytes of a picture; returns an empty image if they are damaged.
cv::Mat decode(FileBytes& bytes, const std::optional<Netpbm>& netpbm) {
  if (netpbm && (netpbm->kind == '5' || netpbm->kind == '6')) return decode_netpbm(*netpbm);
  if (netpbm) bytes.memory[bytes.size++] = '\n';  // OpenCV needs it behind a number
  const cv::Mat raw(1, static_cast<int>(bytes.size), CV_8UC1, bytes.memory.get());
  return decode_image(raw, cv::IMREAD_UNCHANGED);
}

}  // namespace

std::string read_picture_bytes(const std::filesystem::path& file, FileBytes& bytes) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return "is missing";
  if (!std::filesystem::is_regular_file(file, error)) return "is no file";
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestImageFile) return "is larger than 512 MiB";
  std::optional<FileBytes> all = read_bytes(file);
  if (!all) return "cannot be read; check its permissions";
  if (all->size == 0) return "is empty";
  if (is_truncated(all->view())) return "is cut off before its end";
  bytes = *std::move(all);
  if (std::string problem = problem_of_size(bytes.view()); !problem.empty()) return problem;
  const std::optional<Netpbm> netpbm = netpbm_of(bytes.view());
  return netpbm && netpbm->is_cut_off() ? "is cut off before its end" : "";
}

DecodedFile decode_upright(const std::filesystem::path& file) {
  DecodedFile read;
  FileBytes all;
  if (const std::string problem = read_picture_bytes(file, all); !problem.empty()) {
    read.problem = fmt::format("{}: {}", file.string(), problem);
    return read;
  }
  const std::optional<Netpbm> netpbm = netpbm_of(all.view());
  if (netpbm) read.white = netpbm->largest;
  const UnreadFormat unread = unread_format(all.view());
  try {
    if (!unread.misread) read.image = decode(all, netpbm);
    if (!read.image.empty()) turn_upright(read.image, all.view());
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) throw;
    read.image.release();  // OpenCV's message for absurd sizes names its own source lines
  }
  if (!read.image.empty()) return read;
  read.problem = unread.name.empty()
                     ? file.string() + ": is damaged or no image"
                     : fmt::format(
                           "{}: is a picture in {}, which is not read; convert it to PNG "
                           "or JPEG",
                           file.string(), unread.name);
  return read;
}

int file_orientation(const std::filesystem::path& file) {
  FileBytes bytes;
  return read_picture_bytes(file, bytes).empty() ? orientation_of(bytes.view()) : 0;
}

}  // namespace hypotrack::internal
