#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "contour_views.hpp"
#include "hypotrack/plugin/model.hpp"
#include "params.hpp"

namespace hypotrack::contour {

/// The file of a model's outlines. Its name is a hash of the mesh and of the settings. The bytes
/// are a header (magic, version, hash, counts, checksum) and the arrays of ContourViews in memory's
/// order. Programs may write it at the same time: each writes a file of its own and renames it.
class CacheFile {
 public:
  /// An empty folder is hypotrack/contours in XDG_CACHE_HOME or ~/.cache.
  CacheFile(const std::filesystem::path& folder, const Mesh& mesh, const ViewSettings& settings);

  const std::filesystem::path& path() const { return path_; }

  /// Returns the outlines; nothing if there is no such file, or if it is damaged or of another
  /// version or model. `problem` says what is wrong with a file that is there.
  std::optional<ContourViews> read(std::string& problem) const;
  /// Writes the file. Returns why that failed, or an empty text.
  std::string write(const ContourViews& views) const;

 private:
  int subdivisions_;
  std::uint64_t hash_;
  std::filesystem::path path_;  ///< empty: no folder is known
};

}  // namespace hypotrack::contour
