#include "run/crew/job.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 5> kKinds = {"ready", "absent", "ended", "overdue", "lost"};

Json parse(const std::string& line) {
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object())
    throw DataError(fmt::format("a worker's line is no JSON object: '{}'", line));
  return json;
}

}  // namespace

std::string line_of(const Job& job, double time_limit_s) {
  Json json = {{"key", job.key},          {"scene", job.scene.string()},
               {"set", job.set},          {"out", job.out.string()},
               {"log", job.log.string()}, {"time_limit_s", time_limit_s}};
  if (job.frames) json["frames"] = *job.frames;
  if (job.check) json["check"] = true;
  try {
    return json.dump();
  } catch (const Json::type_error&) {
    throw ConfigError(
        fmt::format("{}: the name of the scene, or of a file of its run, is no UTF-8; rename it",
                    job.scene.string()));
  }
}

Job parse_job(const std::string& line, double& time_limit_s) {
  const Json json = parse(line);
  try {
    Job job{.key = json.at("key"), .scene = std::string(json.at("scene"))};
    job.set = json.at("set").get<std::vector<std::string>>();
    job.out = std::string(json.at("out"));
    job.log = std::string(json.at("log"));
    if (json.contains("frames")) job.frames = json.at("frames").get<int>();
    job.check = json.value("check", false);
    time_limit_s = json.at("time_limit_s");
    return job;
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("a job's line: {}", error.what()));
  }
}

std::string line_of(const WorkerAnswer& answer) {
  const Json json = {{"kind", kKinds[static_cast<std::size_t>(answer.kind)]},
                     {"text", answer.text},
                     {"key", answer.key},
                     {"code", answer.code}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

WorkerAnswer parse_answer(const std::string& line) {
  const Json json = parse(line);
  const std::string kind = json.value("kind", "");
  for (std::size_t i = 0; i < kKinds.size(); ++i)
    if (kind == kKinds[i])
      return {static_cast<WorkerAnswer::Kind>(i), json.value("text", ""),
              json.value("key", std::size_t{0}), json.value("code", 0)};
  throw DataError(fmt::format("a worker's answer has the kind '{}'", kind));
}

std::optional<std::string> LineBuffer::next() {
  const std::size_t end = text_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = text_.substr(0, end);
  text_.erase(0, end + 1);
  return line;
}

}  // namespace hypotrack::internal
