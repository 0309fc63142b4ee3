#pragma once

#include <string>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Makes the fingers of a hand longer or shorter, not thicker: every bone of a finger, from its
/// first joint on (the thumb: from the CMC), is stretched along itself with the flesh and the
/// landmarks on it. `factors` is empty (nothing changes), one number for all fingers, or five:
/// thumb, index, middle, ring, little. Throws ConfigError, naming `where`, on another count.
void scale_fingers(ModelData& hand, const std::vector<double>& factors, const std::string& where);

}  // namespace hypotrack
