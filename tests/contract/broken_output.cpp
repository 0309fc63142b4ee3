// An output that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>
#include <fstream>
#include <stdexcept>

#include "hypotrack/api/files.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  writes_into_a_folder,
  writes_what_it_does_not_name,
  forgets_a_file,
  does_not_ask,
  names_a_column_badly,
  writes_too_many_values,
  needs_pictures,
  needs_all_frames,
  never_the_same,
};
constexpr std::array<std::string_view, 10> kFaults = {"none",
                                                      "writes_into_a_folder",
                                                      "writes_what_it_does_not_name",
                                                      "forgets_a_file",
                                                      "does_not_ask",
                                                      "names_a_column_badly",
                                                      "writes_too_many_values",
                                                      "needs_pictures",
                                                      "needs_all_frames",
                                                      "never_the_same"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

class Broken final : public Output {
 public:
  struct Params {
    Fault fault = Fault::none;
    void visit(ParamVisitor& v) { v("fault", fault, {.help = "what is wrong with it"}); }
  };
  explicit Broken(const Params& params) : fault_(params.fault), number_(++objects_) {}

 private:
  std::vector<std::string> do_file_names() const override {
    return {has(Fault::writes_into_a_folder) ? "tables/numbers.txt" : "numbers.txt", "last_#.txt"};
  }
  void do_begin(OutputContext& run) override {
    run_ = &run;
    if (has(Fault::writes_into_a_folder)) return;
    file_.emplace(run.file(has(Fault::writes_what_it_does_not_name) ? "mine.txt" : "numbers.txt"));
    if (has(Fault::never_the_same)) file_->write(std::to_string(number_));
  }
  void do_frame(const Frame& frame, const Solution& solution) override {
    last_ = solution.frame;
    if (file_) file_->write(std::to_string(last_) + "\n");
    if (has(Fault::needs_pictures) && run_->fixed_lag() && frame.views.empty())
      throw std::out_of_range("views");
  }
  std::vector<std::string> do_columns() const override {
    return {has(Fault::names_a_column_badly) ? "last frame" : "last_frame"};
  }
  void do_values(const Frame&, const Solution& solution, std::span<double> values) override {
    values[0] = solution.frame;
    if (has(Fault::writes_too_many_values)) values.data()[1] = 1;
  }
  void do_finish(bool complete) override {
    if (has(Fault::needs_all_frames) && !complete) throw std::logic_error("there are more frames");
    const auto path = run_->file("last_" + std::to_string(last_) + ".txt");
    if (has(Fault::does_not_ask)) std::ofstream(path.parent_path() / "extra.txt") << "more";
    if (!has(Fault::forgets_a_file)) TextFile(path).write("last");
  }

  bool has(Fault fault) const { return fault_ == fault; }

  static inline std::atomic<int> objects_ = 0;
  Fault fault_;
  int number_;
  OutputContext* run_ = nullptr;
  std::optional<TextFile> file_;
  int last_ = 0;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
