// A judge that judges a few poses and then throws, crashes or breaks its contract.
#include <array>
#include <atomic>
#include <csignal>
#include <limits>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace {

enum class How { kException, kInt, kNan, kSegfault };

std::span<const std::string_view> enum_names(How) {
  static constexpr std::array<std::string_view, 4> kNames = {"exception", "int", "nan", "segfault"};
  return kNames;
}

class Failing final : public hypotrack::Judge {
 public:
  struct Params {
    How how = How::kException;
    void visit(hypotrack::ParamVisitor& v) { v("how", how, {.help = "it fails"}); }
  };
  explicit Failing(const Params& params) : how_(params.how) {}

 protected:
  double do_log_odds(const hypotrack::Measures&) const override {
    constexpr int kThatWork = 3;
    if (++judged_ <= kThatWork) return 3;
    if (how_ == How::kException) throw std::runtime_error("the judge is broken");
    if (how_ == How::kInt) throw 42;
    if (how_ == How::kSegfault) raise(SIGSEGV);
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  How how_;
  mutable std::atomic<int> judged_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Failing, "fails in the middle of a run", "")
