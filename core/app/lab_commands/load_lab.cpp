#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "base/installation.hpp"
#include "lab_commands/lab_commands.hpp"

namespace hypotrack::app {
namespace {

Lab without(std::string why, std::string fix) {
  return {.absence = {.why = std::move(why), .fix = std::move(fix)},
          .commands = &absent_lab_commands()};
}

Lab load() {
  if (const std::string why = HYPOTRACK_WHY_NO_LAB; !why.empty())
    return without(why,
                   "sudo apt-get install libboost-dev libjs-three libjs-vega libcpp-httplib-dev, "
                   "then build again with -DHYPOTRACK_LAB=ON");
  const std::filesystem::path file =
      detail::prefix_folder() / HYPOTRACK_LIBDIR / "hypotrack" / "libhypotrack_lab_commands.so";
  const std::string fix = "install the package hypotrack-lab";
  if (!std::filesystem::exists(file)) return without(file.string() + " is not installed", fix);
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* function = module ? dlsym(module, kGetLabCommands) : nullptr;
  if (!function) {
    const char* error = dlerror();
    return without(
        fmt::format("{} cannot be loaded: {}", file.string(), error ? error : "unknown reason"),
        fix + " of the program's version");
  }
  return {.commands = &reinterpret_cast<GetLabCommands>(function)()};
}

}  // namespace

const Lab& lab() {
  static const Lab loaded = load();
  return loaded;
}

}  // namespace hypotrack::app
