#pragma once

#include <optional>

#include "hand_model.hpp"
#include "hand_pairs.hpp"

namespace hypotrack::hands {

/// Returns a detected hand's size as a factor on a model's, from the distances within its palm.
/// Returns nothing if these disagree.
std::optional<double> relative_size(const Model& model, const HandModel& hand,
                                    const HandPair& pair);

}  // namespace hypotrack::hands
