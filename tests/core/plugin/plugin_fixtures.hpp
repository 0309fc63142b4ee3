#pragma once

#include <gmock/gmock.h>

#include <string>

#include "expect_error.hpp"
#include "scoped_variable.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A folder of tests/bad_plugins.
inline std::filesystem::path fixtures(const std::string& group) {
  return build_dir() / "tests" / "plugin_fixtures" / group;
}

inline std::filesystem::path fixture(const std::string& group, const std::string& name) {
  return fixtures(group) / ("libhypotrack_optimizer_" + name + ".so");
}

}  // namespace hypotrack::test
