#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drawn_tiles.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::contract {

/// An objective prepared with an observation, and hypotheses drawn for it.
struct Setting {
  std::string name;
  Observation observation;
  std::unique_ptr<Objective> objective;
  std::vector<NamedHypothesis> hypotheses;

  /// Prepares again: settings move, and a prepared objective points to the observation inside.
  void prepare() { objective->prepare(observation); }
  /// Returns hypothesis `i` as the objective takes it.
  RenderedHypothesis drawn(std::size_t i) const;
  /// Returns the cost of hypothesis `i`. Throws a Violation if the objective's is none.
  double cost(std::size_t i) const { return cost_by(*objective, i); }
  /// Returns the costs of all hypotheses, in their order.
  std::vector<double> costs() const { return costs_by(*objective); }
  double cost_by(const Objective& other, std::size_t i) const;
  /// Returns the costs by another object of the plugin.
  std::vector<double> costs_by(const Objective& other) const;
  /// Returns the names of hypothesis and observation, for messages.
  std::string at(std::size_t i) const { return hypotheses[i].name + ", " + name; }
};

}  // namespace hypotrack::contract
