// A start that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>
#include <limits>
#include <stdexcept>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  gives_nothing,
  too_short,
  not_a_number,
  beyond_the_bounds,
  long_quaternion,
  throws_a_stranger,
  changes_with_the_frame,
  remembers,
  never_the_same,
};
constexpr std::array<std::string_view, 10> kFaults = {"none",
                                                      "gives_nothing",
                                                      "too_short",
                                                      "not_a_number",
                                                      "beyond_the_bounds",
                                                      "long_quaternion",
                                                      "throws_a_stranger",
                                                      "changes_with_the_frame",
                                                      "remembers",
                                                      "never_the_same"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

class Broken final : public Starter {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit Broken(const Params& params) : fault_(params.fault), number_(++objects_) {}

 private:
  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    if (has(Fault::gives_nothing)) return std::nullopt;
    if (has(Fault::throws_a_stranger) && context.frame && !context.frame->truth)
      throw std::out_of_range("truth");
    Eigen::VectorXd state = context.scene.rest_state();
    if (has(Fault::not_a_number)) state[2] = std::numeric_limits<double>::quiet_NaN();
    if (has(Fault::beyond_the_bounds)) state[state.size() - 1] = 10;
    if (has(Fault::long_quaternion)) state[3] = 2;
    if (has(Fault::changes_with_the_frame) && context.frame) state[0] += 0.1;
    if (has(Fault::remembers)) state[0] += 0.1 * ++calls_;
    if (has(Fault::never_the_same)) state[0] += 0.1 * number_;
    if (has(Fault::too_short)) state.conservativeResize(state.size() - 1);
    return state;
  }

  bool has(Fault fault) const { return fault_ == fault; }

  static inline std::atomic<int> objects_ = 0;
  Fault fault_;
  int number_;
  int calls_ = 0;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
