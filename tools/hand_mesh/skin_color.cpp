#include "skin_color.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field.hpp"
#include "noise.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Places moved about by noise, so that drawn lines look grown.
Vector2d wandering(const Vector3d& p, double strength, double size, uint32_t seed) {
  const Vector3d q = p / size;
  return {p.x() + strength * noise(q, seed), p.y() + strength * noise(q, seed + 1)};
}

}  // namespace

SkinColor::SkinColor(const std::vector<SkeletonBone>& skeleton)
    : palm_lines_(palm_lines()), veins_(dorsal_veins()), creases_(skeleton) {
  for (int d = 0; d < kDigits; ++d) {
    const SkeletonBone& bone = skeleton[bone_index(d, 3)];
    const double half = 0.5 * digit_measures()[d].dip_breadth;
    nails_.push_back({bone.hand_from_bone.inverse(), (d == kThumb ? 0.80 : 0.72) * half,
                      0.42 * bone.length, 0.95 * bone.length});
    pulps_.push_back(bone.hand_from_bone * Vector3d(0.8, 0.6 * bone.length, half));
  }
}

/// Blood under the skin: tips, knuckles, the eminences, and blotches.
double SkinColor::redness(const SkinPoint& point) const {
  const Vector3d& p = point.position;
  double red = 0.45 * fractal_noise(p / 13.0, 3, 11) + 0.5 * fractal_noise(p / 3.3, 3, 14);
  double tip = 0;
  for (const Vector3d& pulp : pulps_)
    tip = std::max(tip, std::exp(-(p - pulp).squaredNorm() / 130));
  red += 0.75 * tip * (0.4 + 0.6 * point.palmar) + 0.75 * creases_.knuckle(p);
  const double thenar = std::exp(-(p - Vector3d(26, 36, 24)).squaredNorm() / 420);
  const double hypothenar = std::exp(-(p - Vector3d(-27, 40, 22)).squaredNorm() / 480);
  return red + point.palmar * 0.5 * (thenar + hypothenar);
}

/// Darkening by what lies deeper than the skin around: lines, furrows, pores, ridges.
double SkinColor::relief(const SkinPoint& point) const {
  const Vector3d& p = point.position;
  const double palmar = point.palmar, dorsal = 1 - palmar;
  double lines = 0;
  if (palmar > 0.3 && p.y() < 112) {
    const Vector2d place =
        wandering(p, 1.1, 7.0, 41) + 0.35 * (wandering(p, 1.0, 1.6, 43) - p.head<2>());
    for (const SkinCurve& line : palm_lines_) lines = std::max(lines, line(place));
    lines *= smooth_step(0.3, 0.75, palmar);
  }
  lines = std::max(lines, creases_(p, palmar));
  // Furrows between the fields of the back's skin; shallow folds of the palm's.
  const Vector3d warped =
      p + 0.5 * Vector3d(noise(p / 1.9, 51), noise(p / 1.9, 52), noise(p / 1.9, 53));
  const Cellular fields = cellular_noise(warped / 1.25, 54);
  const double furrow = 1 - smooth_step(0.0, 0.16, fields.second - fields.nearest);
  const Cellular folds = cellular_noise(warped / 3.1, 55);
  const double fold = 1 - smooth_step(0.0, 0.09, folds.second - folds.nearest);
  const double grain = fractal_noise(p / 0.75, 2, 57);
  // Papillary ridges, half a millimetre apart, running around the pulps.
  const double course =
      (p - pulps_[0]).norm() + (p - pulps_[2]).norm() * 0.7 + 3.0 * noise(p / 6.0, 61);
  const double ridge = std::sin(course * 2 * std::numbers::pi / 0.62);
  return 0.80 * lines + dorsal * (0.26 * furrow + 0.16 * fold) +
         palmar * (0.10 * fold + 0.12 * furrow + 0.05 * ridge) + 0.10 * grain;
}

Vector3d SkinColor::skin(const SkinPoint& point) const {
  const Vector3d& p = point.position;
  const double dorsal = 1 - point.palmar;
  const Vector3d palm_tone(0.855, 0.640, 0.555), back_tone(0.745, 0.545, 0.440);
  Vector3d color = point.palmar * palm_tone + dorsal * back_tone;
  const double red = redness(point);
  color += red * Vector3d(0.015, -0.062, -0.055);
  // Pigment: broad patches and, on the back, freckles.
  const double tan = fractal_noise(p / 17.0, 3, 21) + 0.9 * fractal_noise(p / 1.9, 2, 24);
  color *= 1 - (0.05 + 0.035 * dorsal) * tan;
  const Cellular spots = cellular_noise(p / 4.6, 27);
  const double freckle =
      spots.random > 0.72
          ? 1 - smooth_step(0.05, 0.08 + 0.16 * (spots.random - 0.72), spots.nearest)
          : 0.0;
  color -= freckle * (0.25 + 0.75 * dorsal) * Vector3d(0.15, 0.15, 0.13);
  // Pale flecks of the palm.
  const double pale = smooth_step(-0.1, 0.75, fractal_noise(p / 2.6, 3, 29));
  color += point.palmar * pale * Vector3d(0.04, 0.066, 0.062);
  if (dorsal > 0.4) {
    const Vector2d place = wandering(p, 3.0, 14.0, 71);
    double vein = 0;
    for (const SkinCurve& v : veins_) vein = std::max(vein, v(place));
    color -= smooth_step(0.55, 0.95, dorsal) * vein * Vector3d(0.095, 0.04, 0.018);
  }
  // Furrows are warmer than their surroundings: light has passed through skin.
  const double depth = std::clamp(relief(point), -0.3, 1.1);
  return color.cwiseProduct(Vector3d::Ones() - depth * Vector3d(0.33, 0.45, 0.46));
}

/// The nail's place is seen along z of the last bone: rounded at the cuticle, white at the free
/// edge.
void SkinColor::add_nails(const SkinPoint& point, Vector3d& color) const {
  for (const Nail& nail : nails_) {
    const Vector3d local = nail.bone_from_hand * point.position;
    if (local.z() > -0.6 || local.y() < nail.start - 4 || local.y() > nail.end + 4) continue;
    const double half = 0.5 * (nail.end - nail.start);
    const double x = std::abs(local.x()) / nail.half_width;
    const double y = (local.y() - nail.start - half) / half;
    const double inside = 1 - std::pow(std::pow(x, 3.2) + std::pow(std::abs(y), 3.2), 1 / 3.2);
    const double on_top = 1 - smooth_step(-1.8, -0.6, local.z());
    const double plate = on_top * smooth_step(-0.015, 0.035, inside);
    const double fold = std::exp(-std::pow((inside + 0.03) / 0.05, 2));
    const double lunula = 1 - smooth_step(0.75, 0.95, std::hypot(x / 0.62, (y + 0.95) / 0.42));
    const double edge =
        smooth_step(0.72, 0.80, y - 0.06 * x * x + 0.03 * noise(point.position, 83));
    const double streak = noise(Vector3d(local.x() / 0.45, local.y() / 9, 0), 81) +
                          0.8 * noise(point.position / 1.3, 82);
    Vector3d nail_color(0.865, 0.655, 0.605);
    nail_color += lunula * Vector3d(0.04, 0.10, 0.10) + edge * Vector3d(0.04, 0.17, 0.17);
    nail_color *= (1 + 0.05 * streak) * (1.05 - 0.22 * x * x);
    color = (1 - plate) * color + plate * nail_color;
    color -=
        0.8 * fold * (1 - 0.6 * edge) * on_top * color.cwiseProduct(Vector3d(0.22, 0.34, 0.34));
  }
}

Vector3d SkinColor::operator()(const SkinPoint& point) const {
  Vector3d color = skin(point);
  add_nails(point, color);
  // Light that deep places miss, warmer where it passed through skin.
  const double shade = 1 - 0.45 * (1 - point.openness);
  color = color.cwiseProduct(Vector3d(std::pow(shade, 0.8), shade, shade));
  return color.cwiseMax(0.0).cwiseMin(1.0);
}

}  // namespace hypotrack::hand_mesh
