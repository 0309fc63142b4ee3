#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {

struct PersonParams {
  Eigen::Vector3d shirt{225, 222, 215};
  std::vector<double> skin;
  double distance = 900 * kMillimetre;
  Eigen::Vector2d offset{60 * kMillimetre, -50 * kMillimetre};
  bool chair = true;
  void visit(ParamVisitor& v) {
    v("shirt", shirt, {.help = "red, green, blue of the shirt", .min = 0, .max = 255});
    v("skin", skin,
      {.help = "red, green, blue of neck and face; default: of the skin at a hand's wrist",
       .min = 0,
       .max = 255});
    v("distance_mm", distance,
      {.help = "of the chest, along z",
       .min = 100,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("offset_mm", offset,
      {.help = "x and y of the middle between the shoulders",
       .min = -1e5,
       .max = 1e5,
       .unit = "mm",
       .to_si = kMillimetre});
    v("chair", chair, {.help = "a dark chair back behind the torso"});
  }
};

/// Makes a person who sits facing the first camera: torso, arms, neck, head, and a chair back where
/// wanted, as meshes for rigid_model(). `skin` (red, green, blue) is used where the parameters give
/// none. Throws ConfigError, naming `where`, unless `skin` of the parameters has no number or
/// three.
std::vector<Mesh> make_person(const PersonParams& params, const Eigen::Vector3d& skin,
                              const std::string& where);

}  // namespace hypotrack::synthetic
