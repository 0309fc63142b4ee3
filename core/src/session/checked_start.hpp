#pragma once

#include <memory>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/start.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Wraps a plugin's start: names it in what it throws and where it crashes. Errors of starts that
/// come with hypotrack stay as they are.
class CheckedStart final : public Start {
 public:
  /// `who`: plugin_label() of the start.
  CheckedStart(std::unique_ptr<Start> start, std::string who);

  bool looks() const override { return start_->looks(); }
  bool recognizes(std::size_t model) const override { return start_->recognizes(model); }
  std::optional<Eigen::VectorXd> state(const StartContext& context) override;
  void find(const StartContext& context, std::size_t model, const TakePose& take) override;
  std::optional<double> size(const StartContext& context, std::size_t model) override;

 private:
  std::unique_ptr<Start> start_;
  std::string who_;
  bool explains_;
};

}  // namespace internal
}  // namespace hypotrack
