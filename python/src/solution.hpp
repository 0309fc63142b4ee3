#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"

namespace hypotrack::python {

/// A solution with the scene that it is of, and what was told since the one before.
struct NamedSolution {
  Solution solution;
  std::shared_ptr<Scene> scene;
  std::vector<std::string> notes = {};
};

}  // namespace hypotrack::python
