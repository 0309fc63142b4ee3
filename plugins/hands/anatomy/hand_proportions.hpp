#pragma once

#include <span>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Sets how the shape parameters of a hand correlate among people, by their names: `scale`,
/// `thumb`, `index`, `middle`, `ring`, `little`, `width`. Others are independent.
///
/// People with long fingers have five of them: if one is longer than the palm suggests, the others
/// are likely to be, too. So a fit that stretches all fingers alike is far more plausible than one
/// that stretches the middle finger and shortens its neighbours.
void correlate_as_people(std::span<ShapeParameter> parameters);

}  // namespace hypotrack
