#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "base/installation.hpp"
#include "hypotrack/api/error.hpp"
#include "window/window.hpp"

namespace hypotrack {

ShowWindow load_window() {
  const std::filesystem::path file =
      detail::prefix_folder() / HYPOTRACK_LIBDIR / "hypotrack" / "libhypotrack_window.so";
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = module ? dlsym(module, kShowWindow) : nullptr;
  if (!function) {
    const char* why = dlerror();
    throw DeviceError(
        fmt::format("windows need {}, which cannot be loaded: {}; install OpenCV's "
                    "highgui (libopencv-highgui)",
                    file.string(), why ? why : "unknown reason"));
  }
  return reinterpret_cast<ShowWindow>(function);
}

}  // namespace hypotrack
