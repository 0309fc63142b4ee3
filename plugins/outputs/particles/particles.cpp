#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "swarm_panels.hpp"

namespace hypotrack::particles {
namespace {

enum class Format { png, jpg };
[[maybe_unused]] std::span<const std::string_view> enum_names(Format) {
  static constexpr std::array<std::string_view, 2> kNames = {"png", "jpg"};
  return kNames;
}

class Particles final : public Output {
 public:
  struct Params {
    std::optional<int> every;
    std::vector<double> frames;
    Format format = Format::png;
    void visit(ParamVisitor& v) {
      v("every", every, {.help = "draws frame 0 and every N-th after it", .min = 1, .max = 1e9});
      v("frames", frames, {.help = "numbers of the frames to draw, in place of every"});
      v("format", format, {.help = "format of the pictures"});
    }
  };
  Particles(const Params& params, const PluginContext& context);

 private:
  std::vector<std::string> do_file_names() const override { return {"particles_#." + extension()}; }
  void do_begin(OutputContext& run) override {
    run_ = &run;
    run.renderer();  // frames are drawn in another thread
  }
  bool do_wants_search(const Frame& frame) const override {
    if (params_.every) return frame.index % *params_.every == 0;
    return std::ranges::find(params_.frames, frame.index) != params_.frames.end();
  }
  void do_search(const Frame& frame, const Solution& solution, const SearchRecord& record) override;
  void do_frame(const Frame& /*frame*/, const Solution& /*solution*/) override {}

  std::string extension() const {
    return std::string(enum_names(params_.format)[static_cast<std::size_t>(params_.format)]);
  }
  void write(const std::string& name, const cv::Mat& picture);

  Params params_;
  OutputContext* run_ = nullptr;
};

Particles::Particles(const Params& params, const PluginContext& context) : params_(params) {
  const ConfigNode& config = context.config();
  if (params.every.has_value() == !params.frames.empty())
    throw ConfigError(
        fmt::format("{}: particles has {}; expected one of every (a number) and frames (a list)",
                    config.where(), params.every ? "every and frames" : "no frames to draw"));
  for (const double frame : params.frames)
    if (!(frame >= 0 && frame == std::floor(frame)))
      throw ConfigError(fmt::format("{}: frames has {}; expected numbers of frames, from 0",
                                    config.where_key("frames"), frame));
}

void Particles::do_search(const Frame& frame, const Solution& solution,
                          const SearchRecord& record) {
  if (record.observation.views.empty()) return;  // nothing was found
  Renderer& renderer = run_->renderer();
  Figure figure(fmt::format("frame {}   {}   cost {:.4g}   {} evaluations", frame.index,
                            to_string(solution.status), solution.cost, solution.evaluations));
  for (std::size_t view = 0; view < record.observation.views.size(); ++view)
    figure.add_row(
        fmt::format("view {}. Yellow: high, or near; grey: not covered, or not seen by both "
                    "views",
                    view + 1),
        map_panels(renderer, record, view));
  SwarmRow swarm = swarm_row(renderer, run_->scene(), record);
  figure.add_row(std::move(swarm.label), std::move(swarm.panels));
  write(fmt::format("particles_{:06}.{}", frame.index, extension()), figure.draw());
}

void Particles::write(const std::string& name, const cv::Mat& picture) {
  const std::filesystem::path file = run_->file(name);
  const std::vector<unsigned char> bytes = encode_image("." + extension(), picture);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) return;
  const std::string why = why_not_written(file);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // half a picture
  throw OutputError(
      fmt::format("{}: the picture cannot be written{}; check that there is space, or name another "
                  "folder with --out",
                  file.string(), why.empty() ? "" : ": " + why));
}

}  // namespace
}  // namespace hypotrack::particles

HYPOTRACK_PLUGIN(hypotrack::particles::Particles,
                 "how a frame was searched: the objective's maps and the swarm, particles_#.png",
                 "")
