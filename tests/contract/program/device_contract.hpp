#pragma once

#include "subject.hpp"

namespace hypotrack::contract {

/// Checks an objective's device capability; skipped if the objective has none or the machine no
/// GPU.
void check_on_device(Report& report, const Subject& subject);

}  // namespace hypotrack::contract
