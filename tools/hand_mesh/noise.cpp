#include "noise.hpp"

#include <cmath>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

uint32_t mix(uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352dU;
  h ^= h >> 15;
  h *= 0x846ca68bU;
  return h ^ (h >> 16);
}

uint32_t hash(int x, int y, int z, uint32_t seed) {
  uint32_t h = seed * 0x9e3779b9U + 0x85ebca6bU;
  h = mix(h ^ static_cast<uint32_t>(x) * 0xc2b2ae35U);
  h = mix(h ^ static_cast<uint32_t>(y) * 0x27d4eb2fU);
  return mix(h ^ static_cast<uint32_t>(z) * 0x165667b1U);
}

double unit(uint32_t h) { return h * (1.0 / 4294967295.0); }

/// Dot product with one of the twelve edge directions of a cube.
double gradient_dot(uint32_t h, double x, double y, double z) {
  const uint32_t k = h & 15;
  const double u = k < 8 ? x : y;
  const double v = k < 4 ? y : (k == 12 || k == 14 ? x : z);
  return ((k & 1) ? -u : u) + ((k & 2) ? -v : v);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double mix(double a, double b, double t) { return a + t * (b - a); }

}  // namespace

double hash_unit(int x, int y, int z, uint32_t seed) { return unit(hash(x, y, z, seed)); }

double noise(const Vector3d& p, uint32_t seed) {
  const Vector3d base = p.array().floor();
  const Vector3d f = p - base;
  const int x = static_cast<int>(base.x()), y = static_cast<int>(base.y()),
            z = static_cast<int>(base.z());
  double corner[8];
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
    corner[c] =
        gradient_dot(hash(x + dx, y + dy, z + dz, seed), f.x() - dx, f.y() - dy, f.z() - dz);
  }
  const double u = fade(f.x()), v = fade(f.y()), w = fade(f.z());
  const double low = mix(mix(corner[0], corner[1], u), mix(corner[2], corner[3], u), v);
  const double high = mix(mix(corner[4], corner[5], u), mix(corner[6], corner[7], u), v);
  return mix(low, high, w);
}

double fractal_noise(const Vector3d& p, int octaves, uint32_t seed) {
  double sum = 0, strength = 1;
  Vector3d q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += strength * noise(q, seed + i);
    strength *= 0.5;
    q *= 2.03;
  }
  return sum;
}

Cellular cellular_noise(const Vector3d& p, uint32_t seed) {
  const Vector3d base = p.array().floor();
  const int x = static_cast<int>(base.x()), y = static_cast<int>(base.y()),
            z = static_cast<int>(base.z());
  Cellular result{1e9, 1e9, 0};
  for (int k = 0; k < 27; ++k) {
    const int cx = x + k % 3 - 1, cy = y + k / 3 % 3 - 1, cz = z + k / 9 - 1;
    const uint32_t h = hash(cx, cy, cz, seed);
    const Vector3d site(cx + unit(h), cy + unit(mix(h + 1)), cz + unit(mix(h + 2)));
    const double squared = (site - p).squaredNorm();
    if (squared < result.nearest) {
      result.second = result.nearest;
      result.nearest = squared;
      result.random = unit(mix(h + 3));
    } else if (squared < result.second) {
      result.second = squared;
    }
  }
  result.nearest = std::sqrt(result.nearest);
  result.second = std::sqrt(result.second);
  return result;
}

}  // namespace hypotrack::hand_mesh
