#include "lab/study/run_folder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "base/numbers.hpp"
#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr const char* kFailureFile = "failure.json";

Json settings_of(const Plan& plan, const Cell& cell) {
  auto settings = Json::object();
  for (std::size_t axis = 0; axis < plan.study.axes.size(); ++axis) {
    const Choice& choice = plan.choice_of(cell, axis);
    auto& value = settings[plan.study.axes[axis].name];
    const auto integer = detail::parse_integer(choice.label);
    const auto number = detail::parse_number(choice.label);
    if (choice.is_number && integer)
      value = *integer;
    else if (choice.is_number && number)
      value = *number;
    else
      value = choice.label;
  }
  return settings;
}

void write_json(const std::filesystem::path& file, const Json& json) {
  constexpr auto kReplace = Json::error_handler_t::replace;
  TextFile(file).write(json.dump(2, ' ', false, kReplace) + "\n");
}

void write_cell(const std::filesystem::path& folder, const Plan& plan, const PlannedRun& run) {
  const Cell& cell = plan.cells[run.cell];
  Json json;
  json["scene"] = plan.scene_of(cell).name;
  json["settings"] = settings_of(plan, cell);
  json["seed"] = run.seed;
  write_json(folder / "cell.json", json);
}

std::string without(std::string text, const std::string& piece, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(piece, at)) != std::string::npos; at += by.size())
    text.replace(at, piece.size(), by);
  return text;
}

}  // namespace

RunFolder::RunFolder(FileLock lock, std::filesystem::path working, std::filesystem::path final)
    : lock_(std::move(lock)), working_(std::move(working)), final_(std::move(final)) {
  std::error_code error;
  std::filesystem::remove_all(working_, error);  // of a process that was killed
  std::filesystem::create_directories(working_, error);
  if (error)
    throw OutputError(
        fmt::format("{}: the folder cannot be made: {}", working_.string(), error.message()));
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : lock_(std::move(other.lock_)),
      working_(std::exchange(other.working_, {})),
      final_(std::move(other.final_)) {}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!working_.empty()) std::filesystem::remove_all(working_, ignored);
}

void RunFolder::rename() {
  std::error_code error;
  std::filesystem::remove_all(final_, error);  // a failed run that was repeated
  std::filesystem::rename(working_, final_, error);
  if (error)
    throw OutputError(fmt::format("{}: cannot be moved to {}: {}", working_.string(),
                                  final_.string(), error.message()));
}

bool RunFolder::holds_a_complete_run() const {
  std::ifstream in(working_ / "summary.json", std::ios::binary);
  const Json summary = Json::parse(in, nullptr, false);
  const auto complete = summary.is_object() ? summary.find("complete") : summary.end();
  return complete != summary.end() && complete->is_boolean() && complete->get<bool>();
}

void RunFolder::put_into_place() {
  std::filesystem::remove(log());
  rename();
}

void RunFolder::finish(const Plan& plan, const PlannedRun& run, const RunCost& cost) {
  write_cell(working_, plan, run);
  Json timing;
  timing["seconds"] = cost.seconds;
  timing["threads"] = cost.threads;
  if (cost.gpu) timing["gpu"] = *cost.gpu;
  write_json(working_ / "timing.json", timing);
  put_into_place();
}

void RunFolder::fail(const Plan& plan, const PlannedRun& run, const RunFailure& failure) {
  for (const auto& entry : std::filesystem::directory_iterator(working_))
    if (entry.path() != log()) std::filesystem::remove_all(entry.path());
  write_cell(working_, plan, run);
  Json json;
  json["message"] = without(failure.message, working_.string(), "the run's folder");
  json["exit_code"] = failure.exit_code;
  write_json(working_ / kFailureFile, json);
  rename();
}

std::string repair_advice(const std::filesystem::path& file) {
  return fmt::format("remove the folder {} and the run will be made again",
                     file.parent_path().string());
}

std::optional<RunFailure> read_failure(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kFailureFile;
  if (!std::filesystem::exists(file)) return std::nullopt;
  const Json json = read_json_object(file, repair_advice(file));
  RunFailure failure;
  if (json.contains("message")) failure.message = text_in(json, "message", file);
  if (json.contains("exit_code"))
    failure.exit_code = static_cast<int>(integer_in(json, "exit_code", file));
  return failure;
}

}  // namespace hypotrack::study::internal
