#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hypotrack::hand_mesh {

/// Procedural noise over space, the same on every machine: hashes of lattice points, no state.

/// Gradient noise of feature size 1, about -1 .. 1 (Perlin, "Improving noise", SIGGRAPH 2002).
double noise(const Eigen::Vector3d& p, uint32_t seed);

/// Sum of `octaves` noises, each half as large and half as strong, about -1 .. 1.
double fractal_noise(const Eigen::Vector3d& p, int octaves, uint32_t seed);

/// Distances to the nearest and second nearest of points scattered one per unit cell, and a random
/// number in 0 .. 1 of the nearest (Worley, "A cellular texture basis function", SIGGRAPH 1996).
struct Cellular {
  double nearest;
  double second;
  double random;
};
Cellular cellular_noise(const Eigen::Vector3d& p, uint32_t seed);

/// A random number in 0 .. 1.
double hash_unit(int x, int y, int z, uint32_t seed);

}  // namespace hypotrack::hand_mesh
