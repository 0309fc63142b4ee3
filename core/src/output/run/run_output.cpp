#include "output/run/run_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::internal {
namespace {

constexpr const char* kProtocol = "run.yaml";

std::vector<NamedOutput> with_metrics(MetricsOutput* metrics, std::vector<NamedOutput> outputs) {
  outputs.insert(outputs.begin(), NamedOutput{"metrics", std::unique_ptr<Output>(metrics)});
  return outputs;
}

/// The names of all files that a run may write. Those of the outputs that come with hypotrack are
/// always among them: an earlier run may have written them.
class ResultNames {
 public:
  /// Throws ConfigError if another output writes a file of the same name, PluginError if a name is
  /// none.
  void add(const std::string& owner, const Output& output) {
    for (const std::string& name : output.file_names()) {
      if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos)
        throw PluginError(fmt::format(
            "output '{}' wants to write '{}', expected the name of a file; this is a bug in the "
            "output",
            owner, name));
      const auto other = std::ranges::find_if(owners_, [&](const auto& known) {
        return name == known.first || is_result(name, known.first) || is_result(known.first, name);
      });
      if (other != owners_.end())
        throw ConfigError(
            other->second == owner
                ? fmt::format("output: {} is there twice, and both write {}; leave one of them "
                              "out. A run writes the tables by itself, and the overlay unless "
                              "output.overlay is false",
                              owner, name)
                : fmt::format("output: {} and {} both write {}; leave one of them out",
                              other->second, owner, name));
      owners_.emplace(name, owner);
      if (name != kSummaryFile && std::ranges::find(names_, name) == names_.end())
        names_.push_back(name);
    }
  }
  /// Returns the names; the last is that of the file which says that a run is finished.
  std::vector<std::string> all() const {
    std::vector<std::string> names = names_;
    names.emplace_back(kSummaryFile);
    return names;
  }

 private:
  std::vector<std::string> names_ = {kProtocol,    "track.csv",         "joints.csv",
                                     "online.csv", "online_joints.csv", "overlay.mp4"};
  std::map<std::string, std::string> owners_ = {{kProtocol, "the run"}};
};

/// Returns the names of the columns that each output adds to track.csv. Throws ConfigError if two
/// have the same name, PluginError if the table has it already or it is no name.
std::vector<std::vector<std::string>> own_columns(const std::vector<NamedOutput>& outputs) {
  constexpr std::array<std::string_view, 10> kTaken = {
      "frame",        "time",        "status", "cost",  "evaluations",
      "milliseconds", "probability", "stamp",  "fault", "hidden"};
  std::map<std::string, std::string> owners;
  std::vector<std::vector<std::string>> all;
  for (const auto& [owner, output] : outputs) {
    all.push_back(output->columns());
    for (const std::string& name : all.back()) {
      const bool is_name = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
        return c == '_' || (c < 128 && std::isalnum(c));
      });
      if (!is_name || std::ranges::find(kTaken, name) != kTaken.end())
        throw PluginError(fmt::format(
            "output '{}' wants to add the column '{}' to track.csv, {}; this is a bug in the "
            "output",
            owner, name,
            is_name ? "which the table has already; expected another name"
                    : "expected letters, digits and _"));
      const auto [other, is_new] = owners.emplace(name, owner);
      if (!is_new)
        throw ConfigError(fmt::format(
            "output: {} and {} both add the column '{}' to track.csv; leave one of them out",
            other->second, owner, name));
    }
  }
  return all;
}

std::vector<std::string> result_names(const std::vector<NamedOutput>& outputs) {
  ResultNames names;
  for (const auto& [owner, output] : outputs) names.add(owner, *output);
  return names.all();
}

}  // namespace

void check_outputs(const std::vector<NamedOutput>& outputs) {
  ResultNames names;
  names.add("metrics", MetricsOutput(0, ""));
  for (const auto& [owner, output] : outputs) names.add(owner, *output);
  own_columns(outputs);
}

/// The run as one of its outputs sees it.
class RunOutput::Context final : public OutputContext {
 public:
  Context(RunOutput& run, const NamedOutput& output)
      : run_(&run), name_(output.name), files_(output.output->file_names()) {}

  const Scene& scene() const override { return *run_->scene_; }
  const std::vector<Camera>& cameras() const override { return run_->cameras_; }
  double frame_rate() const override { return run_->options_.frame_rate; }
  bool fixed_lag() const override { return run_->options_.fixed_lag; }
  std::filesystem::path file(const std::string& name) override {
    if (std::ranges::none_of(files_, [&](const auto& file) { return is_result(name, file); }))
      throw PluginError(fmt::format(
          "output '{}' wants to write '{}', which is none of its file_names(); this is a bug in "
          "the output",
          name_, name));
    return run_->directory_.file(name);
  }
  Renderer& renderer() override {
    if (begins_) draws_ = true;
    return run_->renderer(draws_);
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> all;
    for (const auto& own : run_->columns_) all.insert(all.end(), own.begin(), own.end());
    return all;
  }
  std::vector<double> values(const Frame& frame, const Solution& solution) override {
    std::vector<double> all(columns().size(), std::numeric_limits<double>::quiet_NaN());
    std::span<double> rest = all;
    for (std::size_t i = 0; i < run_->outputs_.size(); ++i) {
      const std::size_t count = run_->columns_[i].size();
      if (count == 0) continue;
      run_->outputs_[i].output->values(frame, solution, rest.first(count));
      rest = rest.subspan(count);
    }
    return all;
  }

  /// Says that Output::begin() is over. Throws PluginError if the output is to draw and adds
  /// columns, which are written while other threads draw.
  void begun() {
    begins_ = false;
    if (draws_ && !run_->columns_[run_->contexts_.size() - 1].empty())
      throw PluginError(fmt::format(
          "output '{}' adds columns to track.csv and takes the renderer in begin(); expected one "
          "of them; this is a bug in the output",
          name_));
  }
  /// Returns true if the output took the renderer in Output::begin().
  bool draws() const { return draws_; }

 private:
  RunOutput* run_;
  std::string name_;
  std::vector<std::string> files_;
  bool begins_ = true;
  bool draws_ = false;
};

RunOutput::RunOutput(const Scene& scene, std::vector<Camera> cameras, Options options,
                     std::vector<NamedOutput> outputs)
    : scene_(&scene),
      cameras_(std::move(cameras)),
      options_(std::move(options)),
      metrics_(new MetricsOutput(options_.worst_frames, options_.backend, options_.notes,
                                 options_.term_times)),
      outputs_(with_metrics(metrics_, std::move(outputs))),
      columns_(own_columns(outputs_)),
      directory_(options_.directory, result_names(outputs_)) {
  directory_.folder().write_with([&] { begin(); });
}

void RunOutput::begin() {
  TextFile(directory_.file(kProtocol)).write(options_.resolved);
  try {
    for (const NamedOutput& output : outputs_) {
      contexts_.push_back(std::make_unique<Context>(*this, output));
      output.output->begin(*contexts_.back());
      contexts_.back()->begun();
    }
  } catch (...) {
    outputs_.clear();  // closes the files before they are removed
    throw;
  }
}

RunOutput::~RunOutput() { outputs_.clear(); }

Renderer& RunOutput::renderer(bool of_drawing_outputs) {
  std::unique_ptr<Renderer>& renderer = of_drawing_outputs ? drawing_renderer_ : renderer_;
  if (!renderer) renderer = std::make_unique<Renderer>(*scene_);
  return *renderer;
}

bool RunOutput::draws() const {
  return std::ranges::any_of(contexts_, [](const auto& context) { return context->draws(); });
}

bool RunOutput::is_meant(std::size_t output, Outputs which) const {
  return which == Outputs::all || contexts_[output]->draws() == (which == Outputs::drawing);
}

bool RunOutput::want_search(const Frame& frame) const {
  return !frame.views.empty() && std::ranges::any_of(outputs_, [&](const NamedOutput& output) {
    return output.output->wants_search(frame);
  });
}

template <class Function>
void RunOutput::for_outputs(Outputs which, const Function& function) {
  directory_.keep();
  const OpenFolder& folder = directory_.folder();
  folder.expect_exists();  // rather than track on for nothing
  folder.write_with([&] {
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      if (is_meant(i, which)) function(*outputs_[i].output);
  });
}

void RunOutput::add_search(const Frame& frame, const Solution& solution, const SearchRecord& record,
                           Outputs which) {
  for_outputs(which, [&](Output& output) {
    if (output.wants_search(frame)) output.search(frame, solution, record);
  });
}

void RunOutput::add_trace(int frame, const FrameTrace& trace) {
  directory_.folder().write_with([&] { metrics_->trace(frame, trace); });
}

void RunOutput::add_online(const Frame& frame, const Solution& solution, Outputs which) {
  for_outputs(which, [&](Output& output) { output.online(frame, solution); });
}

void RunOutput::add(const Frame& frame, const Solution& solution, Outputs which) {
  for_outputs(which, [&](Output& output) {
    if (!options_.fixed_lag) output.online(frame, solution);
    output.frame(frame, solution);
  });
  if (which != Outputs::drawing) ++frames_;
}

Summary RunOutput::finish(bool complete, const ClockTimes& clock) {
  metrics_->set_clock(clock);
  std::exception_ptr first_error;
  for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) {  // the summary last
    try {
      directory_.folder().write_with([&] { output->output->finish(complete); });
    } catch (...) {  // the others' files are to be whole
      if (!first_error) first_error = std::current_exception();
    }
  }
  if (first_error) std::rethrow_exception(first_error);
  directory_.folder().write_with([&] { directory_.finish(); });
  return metrics_->summary();
}

}  // namespace hypotrack::internal
