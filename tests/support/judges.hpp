#pragma once

#include <memory>
#include <string>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::test {

/// Judges by the share of the surface that agrees between the views.
class AgreementOnly final : public Judge {
 protected:
  double do_log_odds(const Measures& measures) const override {
    return 10 * (measures[Measures::kAgreement] - 0.5);
  }
};

/// Gives every pose the same log odds.
class SameForAll final : public Judge {
 public:
  explicit SameForAll(double log_odds) : log_odds_(log_odds) {}

 protected:
  double do_log_odds(const Measures&) const override { return log_odds_; }

 private:
  double log_odds_;
};

/// Makes a judge as a scene does. `parameters`: YAML beside its type, `edges: 3, step: 1`.
inline std::unique_ptr<Judge> make_judge(const std::string& type,
                                         const std::string& parameters = "") {
  PluginLoader plugins;
  return plugins.make<Judge>(ConfigNode::parse(
      "{type: " + type + (parameters.empty() ? "" : ", ") + parameters + "}", "scene.yaml"));
}

}  // namespace hypotrack::test
