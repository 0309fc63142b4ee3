#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/output.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Wraps a plugin's output: names it and the frame in what it throws and where it crashes. Errors
/// of outputs that come with hypotrack stay as they are.
class CheckedOutput final : public Output {
 public:
  /// `who`: plugin_label() of the output.
  CheckedOutput(std::unique_ptr<Output> output, std::string who);

  std::vector<std::string> file_names() const override;
  void begin(OutputContext& run) override;
  bool wants_search(const Frame& frame) const override;
  void search(const Frame& frame, const Solution& solution, const SearchRecord& record) override;
  void online(const Frame& frame, const Solution& solution) override;
  void frame(const Frame& frame, const Solution& solution) override;
  std::vector<std::string> columns() const override;
  void values(const Frame& frame, const Solution& solution, std::span<double> values) override;
  void finish(bool complete) override;

 private:
  template <class Function>
  decltype(auto) call(Function&& function) const;
  template <class Function>
  decltype(auto) call(const Frame& frame, Function&& function) const;

  std::unique_ptr<Output> output_;
  std::string who_;
  bool explains_;
};

}  // namespace internal
}  // namespace hypotrack
