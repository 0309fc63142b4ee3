#include <optional>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

class Jsonl final : public Output {
 public:
  struct Params {
    bool online = false;
    void visit(ParamVisitor& v) {
      v("online", online,
        {.help = "write solutions before fixed-lag smoothing, as soon as they are there"});
    }
  };
  explicit Jsonl(const Params& params) : params_(params) {}

 private:
  std::vector<std::string> do_file_names() const override { return {"track.jsonl"}; }
  void do_begin(OutputContext& run) override {
    scene_ = &run.scene();
    file_.emplace(run.file("track.jsonl"));
  }
  void do_online(const Frame& frame, const Solution& solution) override {
    if (params_.online) write(frame, solution);
  }
  void do_frame(const Frame& frame, const Solution& solution) override {
    if (!params_.online) write(frame, solution);
  }

  void write(const Frame& frame, const Solution& solution) {
    file_->write(solution_json(*scene_, solution, frame.stamp) + "\n");
  }

  Params params_;
  const Scene* scene_ = nullptr;
  std::optional<TextFile> file_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Jsonl, "solutions as JSON, a line per frame: track.jsonl", "")
