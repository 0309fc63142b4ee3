#include "cache_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "hypotrack/api/files.hpp"

namespace hypotrack::contour {
namespace {

constexpr std::uint32_t kVersion = 2;  // of the bytes and of how outlines are traced
constexpr char kMagic[16] = "hypotrack lines";

struct Header {
  char magic[16];
  std::uint32_t version;
  std::uint32_t views;
  std::uint64_t points;
  float centre[3];
  std::uint32_t unused;
  std::uint64_t hash;      ///< of mesh and settings
  std::uint64_t checksum;  ///< of the centre and all bytes behind the header
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 64);
static_assert(sizeof(ContourPoint) == 14 * sizeof(float));

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo, 1991) of 64 bits.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      value_ ^= static_cast<unsigned char>(byte);
      value_ *= 1099511628211u;
    }
  }
  template <class T>
  void add(std::span<const T> values) {
    add(bytes_of(values));
  }
  std::uint64_t value() const { return value_; }

  template <class T>
  static std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
  }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

template <class Matrix>
auto values_of(const Matrix& matrix) {
  return std::span(matrix.data(), static_cast<std::size_t>(matrix.size()));
}

std::uint64_t hash_of(const Mesh& mesh, const ViewSettings& settings) {
  Hash hash;
  const int numbers[] = {static_cast<int>(kVersion), settings.subdivisions, settings.points};
  hash.add(std::span<const int>(numbers));
  hash.add(values_of(mesh.vertices));
  hash.add(values_of(mesh.triangles));
  return hash.value();
}

std::filesystem::path default_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  std::filesystem::path cache = variable("XDG_CACHE_HOME");
  if (cache.empty() && !variable("HOME").empty()) cache = variable("HOME") / ".cache";
  return cache.empty() ? cache : cache / "hypotrack" / "contours";
}

std::uint64_t checksum(const Header& header, std::string_view body) {
  Hash hash;
  hash.add(std::span<const float>(header.centre));
  hash.add(body);
  return hash.value();
}

/// Reads values from the front of some bytes. The bytes must be there.
template <class T>
std::vector<T> take(std::string_view& bytes, std::size_t count) {
  std::vector<T> out(count);
  std::memcpy(static_cast<void*>(out.data()), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return out;
}

}  // namespace

CacheFile::CacheFile(const std::filesystem::path& folder, const Mesh& mesh,
                     const ViewSettings& settings)
    : subdivisions_(settings.subdivisions), hash_(hash_of(mesh, settings)) {
  const std::filesystem::path in = folder.empty() ? default_folder() : folder;
  if (!in.empty()) path_ = in / fmt::format("{:016x}.contours", hash_);
}

std::optional<ContourViews> CacheFile::read(std::string& problem) const {
  const std::optional<std::string> bytes = path_.empty() ? std::nullopt : read_whole(path_);
  if (!bytes) return std::nullopt;
  const auto refuse = [&](std::string_view what) {
    problem = fmt::format("{}: {}; the outlines are drawn anew", path_.string(), what);
    return std::nullopt;
  };
  Header header{};
  if (bytes->size() < sizeof header) return refuse("ends within its header");
  std::memcpy(&header, bytes->data(), sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
    return refuse("is no file of outlines");
  if (header.version != kVersion)
    return refuse(fmt::format("has version {}, expected {}", header.version, kVersion));
  if (header.hash != hash_) return refuse("holds another model");
  Eigen::Matrix3Xf directions = sphere_directions(subdivisions_);
  std::string_view body = std::string_view(*bytes).substr(sizeof header);
  const std::uint64_t indices = std::uint64_t{header.views} + 1;
  if (header.views != directions.cols() || header.points > body.size() ||
      body.size() != indices * sizeof(std::uint32_t) + header.points * sizeof(ContourPoint) ||
      header.checksum != checksum(header, body))
    return refuse("is damaged");
  auto first = take<std::uint32_t>(body, indices);
  if (!std::ranges::is_sorted(first) || first.front() != 0 || first.back() != header.points)
    return refuse("is damaged");
  return ContourViews(Eigen::Vector3f(header.centre), std::move(directions), std::move(first),
                      take<ContourPoint>(body, header.points));
}

std::string CacheFile::write(const ContourViews& views) const {
  if (path_.empty())
    return "the outlines of a model are drawn anew in every run: neither XDG_CACHE_HOME nor HOME "
           "is "
           "set; set one, or name a folder with `cache`";
  std::string body(Hash::bytes_of(views.first()));
  body += Hash::bytes_of(views.points());
  Header header{};
  std::ranges::copy(kMagic, header.magic);
  header.version = kVersion;
  header.views = static_cast<std::uint32_t>(views.directions().cols());
  header.points = views.points().size();
  Eigen::Vector3f::Map(header.centre) = views.centre();
  header.hash = hash_;
  header.checksum = checksum(header, body);
  std::error_code error;
  std::filesystem::create_directories(path_.parent_path(), error);
  std::filesystem::path own = path_;
  own += fmt::format(".{}.{:08x}", getpid(), std::random_device{}());
  std::ofstream out(own, std::ios::binary);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.write(body.data(), static_cast<std::streamsize>(body.size()));
  out.close();
  if (out) std::filesystem::rename(own, path_, error);
  if (out && !error) return {};
  std::string why = error ? error.message() : why_not_written(own);
  std::filesystem::remove(own, error);
  return fmt::format(
      "{}: cannot be written{}; the outlines of a model are drawn anew in every run. Name another "
      "folder with `cache`",
      path_.string(), why.empty() ? "" : " (" + why + ")");
}

}  // namespace hypotrack::contour
