#pragma once

#include <map>
#include <string>
#include <vector>

#include "mechanism.hpp"

namespace hypotrack::articulated {

/// The value of a joint as a function of a parameter: multiplier * value + offset.
struct Drive {
  int parameter = 0;  ///< index into the model's parameters
  double multiplier = 1;
  double offset = 0;
};

/// Makes parameters of the joints that mimic no other and expresses every movable joint by one of
/// them.
class Drives {
 public:
  /// Throws DataError, beginning with `where`, on limits the wrong way round or without room, and
  /// on joints that mimic an unknown or fixed joint, or each other in a circle.
  Drives(const std::vector<Joint>& joints, const std::string& where);

  /// Returns the pose's parameters and those of the joints.
  const std::vector<Parameter>& parameters() const { return parameters_; }
  Drive of(const Joint& joint) const;

 private:
  void add_parameter(const Joint& joint);
  void check_mimicked(const Joint& joint) const;
  [[noreturn]] void fail(const std::string& what) const;

  const std::string& where_;
  std::map<std::string, const Joint*> joints_;  // that move, by name
  std::map<std::string, int> index_;            // of their parameters
  std::vector<Parameter> parameters_;
};

}  // namespace hypotrack::articulated
