#include "model/import/imported_meshes.hpp"

#include <atomic>
#include <cstdint>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <tuple>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kMostMeshes = 16;  //: a scene has one or two

/// A file as it is now.
using Version = std::tuple<std::string, std::uintmax_t, std::filesystem::file_time_type>;
using Key = std::tuple<Version, Version, double>;

Version version_of(const std::filesystem::path& file) {
  if (file.empty()) return {};
  std::error_code size_error, time_error, path_error;
  return {std::filesystem::absolute(file, path_error).string(),
          std::filesystem::file_size(file, size_error),
          std::filesystem::last_write_time(file, time_error)};
}

std::atomic<bool> keeps = false;
std::mutex mutex;
std::map<Key, std::shared_future<ImportedMesh>> meshes;  // guarded by the mutex

}  // namespace

void keep_imported_meshes() { keeps = true; }

ImportedMesh kept_mesh(const std::filesystem::path& file, const MeshImportOptions& options,
                       const std::function<ImportedMesh()>& import) {
  if (!keeps) return import();
  const Key key{version_of(file), version_of(options.texture), options.scale};
  std::promise<ImportedMesh> promise;
  {
    std::unique_lock lock(mutex);
    if (const auto known = meshes.find(key); known != meshes.end()) {
      const std::shared_future<ImportedMesh> mesh = known->second;
      lock.unlock();
      return mesh.get();
    }
    if (meshes.size() >= kMostMeshes) meshes.clear();
    meshes.emplace(key, promise.get_future().share());
  }
  try {
    ImportedMesh mesh = import();
    promise.set_value(mesh);
    return mesh;
  } catch (...) {
    promise.set_exception(std::current_exception());
    const std::lock_guard lock(mutex);
    meshes.erase(key);
    throw;
  }
}

}  // namespace hypotrack::internal
