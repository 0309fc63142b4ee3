#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "base/installation.hpp"
#include "base/text_file.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "new_plugin/plugin_files.hpp"

namespace hypotrack::app {
namespace {

struct NewPluginOptions {
  PluginRequest request;
  std::optional<std::filesystem::path> out;
};

/// Fills a folder beside its place and moves it there, so that it is never seen incomplete.
class NewFolder {
 public:
  explicit NewFolder(std::filesystem::path place)
      : place_(std::move(place)), part_(place_.string() + ".part") {
    if (std::filesystem::exists(place_))
      throw OutputError(place_.string() +
                        ": exists already; give another folder by --out, or remove it");
    std::filesystem::remove_all(part_);
    std::error_code error;
    std::filesystem::create_directories(part_, error);
    if (error) throw OutputError(part_.string() + ": cannot be made: " + error.message());
  }
  ~NewFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(part_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& part() const { return part_; }
  void finish() { std::filesystem::rename(part_, place_); }

 private:
  std::filesystem::path place_, part_;
};

int write_plugin(const NewPluginOptions& options, const CommonOptions& common) {
  const auto files = plugin_files(options.request, files_of_guide());
  const std::filesystem::path out = options.out.value_or(options.request.name);
  NewFolder folder(out);
  for (const auto& [name, text] : files) write_whole(folder.part() / name, text);
  if (options.request.kind == "source") {
    PluginLoader plugins(common.plugin_path);
    const std::filesystem::path scene = folder.part() / "rendered.yaml";
    write_whole(scene, rendered_scene());
    write_example_recording(scene, plugins, folder.part() / "recording");
    std::filesystem::remove(scene);
  }
  folder.finish();
  const std::filesystem::path prefix = detail::prefix_folder();
  fmt::print(
      "{0} is the project of a plugin ({1}). Build, test and run it:\n\n"
      "cmake -S {0} -B {0}/build -DCMAKE_PREFIX_PATH={2} -DCMAKE_BUILD_TYPE=Release\n"
      "cmake --build {0}/build\n"
      "ctest --test-dir {0}/build --output-on-failure\n"
      "hypotrack --plugin-path {0}/build run {0}/scene.yaml --out {0}/result\n",
      out.string(), options.request.kind, prefix.string());
  return 0;
}

}  // namespace

void add_new_plugin_command(const Command& plugins, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<NewPluginOptions>();
  const Command command = plugins.add_command(
      "new", "Write the project of a plugin that builds, passes its tests and runs");
  command.add("kind", &options->request.kind, "Kind of plugin",
              {.required = true, .check = one_of(plugin_kinds())});
  command.add("name", &options->request.name, "Name of the plugin: my_plugin", {.required = true});
  command.add("--cuda", &options->request.cuda, "With a part for GPUs (objectives)");
  command.add("--out", &options->out, "New folder [default: the name]", {.check = file_name()});
  command.on_call([=, &common, &exit_code] { exit_code = write_plugin(*options, common); });
}

}  // namespace hypotrack::app
