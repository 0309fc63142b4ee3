#pragma once

#include "subject.hpp"

namespace hypotrack::contract {

/// Rows for an objective's device capability; skipped where it has none or the machine no GPU.
void check_on_device(Report& report, const Subject& subject);

}  // namespace hypotrack::contract
