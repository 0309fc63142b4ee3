#include "model/import/process.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/subprocess.hpp"
#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kLargestAnswer = std::size_t{2} << 30;

DataError unreadable(const std::filesystem::path& mesh, const std::string& why) {
  return DataError(fmt::format("{}: the mesh could not be read: {}", mesh.string(), why));
}

/// Throws if the reader did not end as it should.
void check_end(const Captured& captured, const MeshReader& reader,
               const std::filesystem::path& mesh) {
  if (captured.timed_out) {
    throw unreadable(mesh, fmt::format("the importer took longer than {} s; the file is damaged, "
                                       "or too large to be a model to track",
                                       reader.time_limit.count()));
  }
  if (captured.too_large) throw unreadable(mesh, "it holds more than 2 GiB of data");
  const Subprocess::End end = captured.end;
  if (end.signal == SIGXCPU) {
    throw unreadable(mesh, fmt::format("the importer took longer than {} s of processor time; the "
                                       "file is damaged, or too large to be a model to track",
                                       reader.time_limit.count()));
  }
  if (end.signal != 0) {
    throw unreadable(
        mesh,
        fmt::format(
            "the importer crashed ({}). It cannot read this file, which may be valid: open it in "
            "another program, such as Blender, and export it anew, as GLB without compression, or "
            "as "
            "OBJ if it has no bones",
            signal_name(end.signal)));
  }
  if (end.code != 0) {
    throw unreadable(mesh,
                     fmt::format("{} ended with exit code {}", reader.program.string(), end.code));
  }
}

}  // namespace

MeshReader default_mesh_reader(const std::filesystem::path& mesh) {
  // Beside libhypotrack.so, in the build tree and in an installation.
  Dl_info library{};
  std::filesystem::path folder;
  if (dladdr(reinterpret_cast<const void*>(&default_mesh_reader), &library) && library.dli_fname) {
    folder = std::filesystem::weakly_canonical(library.dli_fname).parent_path();
  }
  MeshReader reader{folder / "hypotrack" / "hypotrack_mesh_reader"};
  if (access(reader.program.c_str(), X_OK) != 0) {
    throw unreadable(mesh, fmt::format("the program that reads meshes, {}, is missing: build or "
                                       "install hypotrack again",
                                       reader.program.string()));
  }
  return reader;
}

std::string run_mesh_reader(const MeshReader& reader, const std::filesystem::path& mesh) {
  // An absolute path cannot be mistaken for an option.
  const std::string file = std::filesystem::absolute(mesh).string();
  const std::string seconds = std::to_string(std::max<long>(1, reader.time_limit.count()));
  Captured captured;
  try {
    captured = capture_output({reader.program, {file, seconds}}, {STDOUT_FILENO},
                              {reader.time_limit, kLargestAnswer});
  } catch (const std::system_error& error) {
    throw unreadable(mesh, fmt::format("{} does not start: {}", reader.program.string(),
                                       described(error.code().value())));
  }
  check_end(captured, reader, mesh);
  return std::move(captured.output);
}

}  // namespace hypotrack::internal
