// A judge that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  answers_nan,
  throws_a_stranger,
  remembers,
  never_the_same,
  depends_on_the_thread,
  prefers_wrong_poses,
  tracks_lost_models,
  is_more_than_sure,
};
constexpr std::array<std::string_view, 9> kFaults = {"none",
                                                     "answers_nan",
                                                     "throws_a_stranger",
                                                     "remembers",
                                                     "never_the_same",
                                                     "depends_on_the_thread",
                                                     "prefers_wrong_poses",
                                                     "tracks_lost_models",
                                                     "is_more_than_sure"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

JudgeThresholds thresholds_of(Fault fault) {
  JudgeThresholds out;
  if (fault == Fault::tracks_lost_models) out.first_above = out.uncertain_above / 2;
  if (fault == Fault::is_more_than_sure) out.certain_above = 1.5;
  return out;
}

class Broken final : public Judge {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit Broken(const Params& params)
      : Judge(thresholds_of(params.fault)), fault_(params.fault), number_(++objects_) {}

 protected:
  double do_log_odds(const Measures& measures) const override {
    double out = 10 * (measures[Measures::kAgreement] - 0.5);
    if (has(Fault::answers_nan) && measures.experienced && !(measures.likeness >= -1))
      out = measures.likeness;
    if (has(Fault::throws_a_stranger)) throw std::out_of_range("agreement");
    if (has(Fault::remembers)) out += ++calls_;
    if (has(Fault::never_the_same)) out += number_;
    if (has(Fault::depends_on_the_thread) && std::this_thread::get_id() != maker_) out += 1;
    if (has(Fault::prefers_wrong_poses)) out = -out;
    return out;
  }

 private:
  bool has(Fault fault) const { return fault_ == fault; }

  static inline std::atomic<int> objects_ = 0;
  Fault fault_;
  int number_;
  std::thread::id maker_ = std::this_thread::get_id();
  mutable std::atomic<int> calls_ = 0;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
