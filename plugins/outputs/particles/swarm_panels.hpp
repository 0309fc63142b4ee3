#pragma once

#include <string>
#include <vector>

#include "figure.hpp"
#include "hypotrack/plugin/output.hpp"

namespace hypotrack::particles {

/// The montage of a search, and a line about it.
struct SwarmRow {
  std::string label;
  std::vector<Panel> panels;  ///< empty if the hypotheses are not known
};

/// Draws the outlines of hypotheses over the first view, for a few generations from first to last.
/// The search is the one that led to the record's answer.
SwarmRow swarm_row(Renderer& renderer, const Scene& scene, const SearchRecord& record);

}  // namespace hypotrack::particles
