// An output without files that fails at frame 3.
#include <array>
#include <csignal>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How { kException, kOutputError, kSegfault };

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 3> kNames = {"exception", "output_error",
                                                             "segfault"};
  return kNames;
}

class Failing : public hypotrack::Output {
 public:
  struct Params {
    How how = How::kException;
    void visit(hypotrack::ParamVisitor& v) { v("how", how, {.help = "it fails"}); }
  };
  explicit Failing(const Params& params) : params_(params) {}

 private:
  std::vector<std::string> do_file_names() const override { return {}; }
  void do_begin(hypotrack::OutputContext&) override {}
  void do_frame(const hypotrack::Frame& frame, const hypotrack::Solution&) override {
    if (frame.index != 3) return;
    if (params_.how == How::kException) throw std::runtime_error("the output is broken");
    if (params_.how == How::kOutputError) throw hypotrack::OutputError("no room");
    raise(SIGSEGV);
  }

  Params params_;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
