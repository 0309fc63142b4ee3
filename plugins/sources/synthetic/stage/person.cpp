#include "stage/person.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <type_traits>

#include "hypotrack/api/error.hpp"

namespace hypotrack::synthetic {
namespace {

constexpr int kAround = 64;  // vertices of a section

/// A closed curve in space: |a|^power + |b|^power = 1 about a centre with half axes u and v.
struct Section {
  Eigen::Vector3d center, u, v;
  double power = 2;

  Eigen::Vector3d at(double turn) const {
    const double angle = 2 * std::numbers::pi * turn;
    const auto part = [&](double x) { return std::copysign(std::pow(std::abs(x), 2 / power), x); };
    return center + part(std::cos(angle)) * u + part(std::sin(angle)) * v;
  }
};

double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices.col(mesh.triangles(k, t)).cast<double>();
    };
    volume += corner(0).dot(corner(1).cross(corner(2)));
  }
  return volume;
}

/// Joins sections to a surface that is closed at both ends. The texture's columns go around it, its
/// rows from the first section to the last.
Mesh join(const std::vector<Section>& sections) {
  const auto count = static_cast<int>(sections.size());
  const int first_end = count * kAround, wide = kAround + 1;
  Mesh mesh;
  mesh.vertices.resize(3, first_end + 2);
  mesh.uv.resize(2, count * wide);
  for (int r = 0; r < count; ++r) {
    const Section& section = sections[static_cast<std::size_t>(r)];
    for (int s = 0; s <= kAround; ++s) {
      const double turn = static_cast<double>(s) / kAround;
      if (s < kAround) mesh.vertices.col(r * kAround + s) = section.at(turn).cast<float>();
      mesh.uv.col(r * wide + s) << static_cast<float>(turn),
          1 - static_cast<float>(r) / static_cast<float>(count - 1);
    }
  }
  mesh.vertices.col(first_end) = sections.front().center.cast<float>();
  mesh.vertices.col(first_end + 1) = sections.back().center.cast<float>();
  mesh.triangles.resize(3, 2 * count * kAround);
  mesh.uv_triangles.resize(3, 2 * count * kAround);
  int t = 0;
  for (int s = 0; s < kAround; ++s) {
    const int next = (s + 1) % kAround, last = (count - 1) * kAround, uv_last = (count - 1) * wide;
    for (int r = 0; r + 1 < count; ++r) {
      const int a = r * kAround + s, b = r * kAround + next, ua = r * wide + s, ub = ua + 1;
      mesh.triangles.col(t) << a, b, b + kAround;
      mesh.uv_triangles.col(t++) << ua, ub, ub + wide;
      mesh.triangles.col(t) << a, b + kAround, a + kAround;
      mesh.uv_triangles.col(t++) << ua, ub + wide, ua + wide;
    }
    mesh.triangles.col(t) << next, s, first_end;
    mesh.uv_triangles.col(t++) << s + 1, s, s;
    mesh.triangles.col(t) << last + s, last + next, first_end + 1;
    mesh.uv_triangles.col(t++) << uv_last + s, uv_last + s + 1, uv_last + s;
  }
  if (signed_volume(mesh) < 0) {
    mesh.triangles.row(1).swap(mesh.triangles.row(2));
    mesh.uv_triangles.row(1).swap(mesh.uv_triangles.row(2));
  }
  return mesh;
}

/// Puts `steps` sections for each of an outline, smoothly between them.
std::vector<Section> refined(const std::vector<Section>& sections, int steps) {
  std::vector<Section> all;
  const auto at = [&](std::ptrdiff_t i) -> const Section& {
    return sections[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(i, 0, std::ssize(sections) - 1))];
  };
  for (std::ptrdiff_t i = 0; i + 1 < std::ssize(sections); ++i) {
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const auto mix = [&](auto field) {  // Catmull-Rom
        const auto a = field(at(i - 1)), b = field(at(i)), c = field(at(i + 1)),
                   d = field(at(i + 2));
        using Value = std::decay_t<decltype(a)>;
        return Value(
            b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * b - a - 3 * c + d))));
      };
      all.push_back({mix([](const Section& s) { return s.center; }),
                     mix([](const Section& s) { return s.u; }),
                     mix([](const Section& s) { return s.v; }),
                     mix([](const Section& s) { return s.power; })});
    }
  }
  all.push_back(sections.back());
  return all;
}

/// Returns a section that is level: half axes along x and z, in millimetres.
Section level(double x, double y, double z, double half_x, double half_z, double power = 2) {
  return {Eigen::Vector3d(x, y, z) * kMillimetre, Eigen::Vector3d(half_x, 0, 0) * kMillimetre,
          Eigen::Vector3d(0, 0, half_z) * kMillimetre, power};
}

cv::Scalar bgr_of(const Eigen::Vector3d& rgb) { return {rgb.z(), rgb.y(), rgb.x()}; }

/// Returns noise that is stretched along the columns by `tall`, with a deviation of about 1.
cv::Mat soft_noise(cv::RNG& random, cv::Size size, int cell, int tall) {
  cv::Mat coarse(std::max(2, size.height / (cell * tall)), std::max(2, size.width / cell),
                 CV_32FC1),
      grown;
  random.fill(coarse, cv::RNG::NORMAL, 0.0, 1.0);
  cv::resize(coarse, grown, size, 0, 0, cv::INTER_CUBIC);
  return grown;
}

/// Makes an 8-bit texture of a colour whose brightness varies.
cv::Mat tinted(const cv::Mat& light, const cv::Scalar& color) {
  cv::Mat bgr, texture;
  cv::cvtColor(light, bgr, cv::COLOR_GRAY2BGR);
  bgr += color;
  bgr.convertTo(texture, CV_8UC3);
  return texture;
}

/// Makes plain cloth: soft folds and a faint weave.
cv::Mat make_cloth(cv::RNG& random, const cv::Scalar& color, double folds) {
  const cv::Size size(1024, 1024);
  cv::Mat weave(size, CV_32FC1);
  random.fill(weave, cv::RNG::NORMAL, 0.0, 1.2);
  cv::Mat light = soft_noise(random, size, 32, 4) + 0.5 * soft_noise(random, size, 64, 1);
  cv::GaussianBlur(light, light, {}, 6);
  return tinted(folds * light + weave, color);
}

cv::Mat make_skin(cv::RNG& random, const cv::Scalar& color, cv::Size size) {
  cv::Mat fine(size, CV_32FC1);
  random.fill(fine, cv::RNG::NORMAL, 0.0, 3.0);
  cv::GaussianBlur(fine, fine, {}, 0.8);
  return tinted(fine + 3 * soft_noise(random, size, 24, 1), color);
}

/// Colours an ellipse with soft edges; all lengths in pixels of the texture.
void blend(cv::Mat& texture, cv::Point2d center, cv::Size2d half, const cv::Scalar& color,
           double strength, double soft) {
  cv::Mat share = cv::Mat::zeros(texture.size(), CV_32FC1);
  cv::ellipse(share, cv::RotatedRect(center, cv::Size2d(2 * half.width, 2 * half.height), 0),
              cv::Scalar(strength), cv::FILLED, cv::LINE_8);
  cv::GaussianBlur(share, share, {}, soft);
  for (int y = 0; y < texture.rows; ++y) {
    for (int x = 0; x < texture.cols; ++x) {
      cv::Vec3b& pixel = texture.at<cv::Vec3b>(y, x);
      const double s = share.at<float>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<unsigned char>((1 - s) * pixel[c] + s * color[c]);
    }
  }
}

/// The head's texture: 1024 columns around it, from its left over the back to the front at 768, and
/// 512 rows from the crown to the chin.
constexpr int kFront = 768, kHeadWide = 1024, kHeadTall = 512;

/// Returns the row at which hair ends: on the forehead, at the ears, at the nape.
double hairline(int column) {
  const double from_front = std::abs(column - kFront) > kHeadWide / 2
                                ? kHeadWide - std::abs(column - kFront)
                                : std::abs(column - kFront);
  const double t = std::clamp((from_front - 95) / 70, 0.0, 1.0);
  return 150 + 12 * std::sin(0.05 * column) + 180 * t * t * (3 - 2 * t);
}

cv::Mat make_face(cv::RNG& random, const cv::Scalar& skin) {
  const cv::Scalar hair(28, 36, 48), dark(30, 34, 42), white(205, 212, 216);
  cv::Mat face = make_skin(random, skin, {kHeadWide, kHeadTall});
  const cv::Scalar red(0.75 * skin[0], 0.70 * skin[1], 0.98 * skin[2]);
  const cv::Scalar shade = 0.72 * skin;
  for (const int side : {-1, 1}) {
    const double eye = kFront + 58 * side;
    blend(face, {kFront + 95. * side, 300}, {40, 30}, red, 0.25, 14);  // cheek
    blend(face, {eye, 236}, {42, 22}, shade, 0.5, 8);
    blend(face, {eye, 208}, {38, 6}, hair, 0.85, 3);
    blend(face, {eye, 236}, {25, 9}, white, 0.9, 2);
    blend(face, {eye, 236}, {10, 10}, dark, 1, 1.5);
    blend(face, {eye, 228}, {28, 3}, dark, 0.7, 1.5);
    blend(face, {kFront + 14. * side, 314}, {9, 5}, dark, 0.7, 2.5);  // nostril
    blend(face, {kFront + 24. * side, 290}, {6, 28}, shade, 0.5, 5);
  }
  blend(face, {kFront, 366}, {46, 12}, cv::Scalar(70, 70, 150), 0.6, 4);
  blend(face, {kFront, 365}, {46, 2.5}, dark, 0.8, 1.5);
  blend(face, {kFront, 392}, {30, 6}, shade, 0.6, 6);
  blend(face, {kFront, 482}, {220, 26}, shade, 0.6, 14);  // below the chin
  cv::Mat strands = tinted(9 * soft_noise(random, face.size(), 4, 16), hair);
  for (int x = 0; x < face.cols; ++x) {
    const int end = static_cast<int>(hairline(x));
    strands(cv::Rect(x, 0, 1, end)).copyTo(face(cv::Rect(x, 0, 1, end)));
  }
  return face;
}

/// Makes an egg with a nose and with hair that stands out.
Mesh make_head(cv::RNG& random, const cv::Scalar& skin) {
  constexpr int kRings = 96;
  const Eigen::Vector3d center(0, -215, 110), half(83, 121, 99);
  std::vector<Section> rings;
  for (int r = 0; r <= kRings; ++r) {
    const double t = static_cast<double>(r) / kRings, around = std::numbers::pi * t;
    const double narrow = 1 - 0.22 * std::pow(std::max(0.0, t - 0.5) * 2, 1.5);
    const double radius = std::max(std::sin(around), 1e-3) * narrow;
    rings.push_back(level(center.x(), center.y() - half.y() * std::cos(around), center.z(),
                          half.x() * radius, half.z() * radius, 2.15));
  }
  Mesh head = join(rings);
  for (int r = 0; r <= kRings; ++r) {
    for (int s = 0; s < kAround; ++s) {
      auto vertex = head.vertices.col(r * kAround + s);
      const double row = static_cast<double>(r) / kRings * kHeadTall;
      const double column = static_cast<double>(s) / kAround * kHeadWide;
      if (row < hairline(static_cast<int>(column))) {
        const Eigen::Vector3f middle = (center * kMillimetre).cast<float>();
        vertex = middle + 1.07F * (vertex - middle);
      }
      const double across = (column - kFront) / 20, along = (row - 296) / (row < 296 ? 38 : 14);
      vertex.z() -=
          static_cast<float>(20 * kMillimetre * std::exp(-0.5 * (across * across + along * along)));
    }
  }
  head.texture = make_face(random, skin);
  return head;
}

Mesh make_torso(cv::RNG& random, const cv::Scalar& shirt) {
  const std::vector<Section> outline = {
      level(0, -66, 125, 62, 50),        level(0, -60, 124, 68, 54),
      level(0, -46, 122, 92, 62, 2.1),   level(0, -28, 120, 140, 76, 2.2),
      level(0, -8, 118, 180, 92, 2.3),   level(0, 20, 115, 200, 104, 2.4),
      level(0, 70, 113, 203, 112, 2.5),  level(0, 150, 113, 198, 113, 2.5),
      level(0, 300, 115, 180, 112, 2.4), level(0, 450, 112, 178, 116, 2.4),
      level(0, 620, 110, 185, 120, 2.4), level(0, 760, 110, 185, 120, 2.4)};
  Mesh torso = join(refined(outline, 6));
  torso.texture = make_cloth(random, shirt, 5.0);
  return torso;
}

/// Makes the upper arm and its elbow, which rests in front of the waist; `side` is -1 or 1.
Mesh make_arm(cv::RNG& random, const cv::Scalar& shirt, int side) {
  const auto ring = [&](double x, double y, double z, double half) {
    return level(side * x, y, z, half, 1.05 * half);
  };
  const std::vector<Section> outline = {
      ring(176, -22, 118, 6),  ring(182, -14, 118, 40), ring(192, 14, 118, 60),
      ring(202, 70, 120, 62),  ring(211, 160, 122, 57), ring(221, 270, 115, 52),
      ring(226, 350, 95, 52),  ring(222, 420, 60, 52),  ring(222, 520, 10, 46),
      ring(196, 620, -40, 40), ring(190, 660, -60, 38)};
  Mesh arm = join(refined(outline, 6));
  arm.texture = make_cloth(random, shirt, 6.0);
  return arm;
}

Mesh make_neck(cv::RNG& random, const cv::Scalar& skin) {
  const std::vector<Section> outline = {level(0, -190, 122, 48, 52), level(0, -150, 122, 50, 52),
                                        level(0, -110, 122, 52, 53), level(0, -80, 122, 56, 54),
                                        level(0, -60, 122, 64, 56),  level(0, -40, 122, 70, 58)};
  Mesh neck = join(refined(outline, 4));
  neck.texture = make_skin(random, 0.93 * skin, {512, 256});
  return neck;
}

/// Makes a slab with rounded edges, which stands out to both sides of the torso.
Mesh make_chair(cv::RNG& random) {
  std::vector<Section> sections;
  const auto add = [&](double z, double half_x, double half_y) {
    sections.push_back({Eigen::Vector3d(60, 330, z) * kMillimetre,
                        Eigen::Vector3d(half_x, 0, 0) * kMillimetre,
                        Eigen::Vector3d(0, half_y, 0) * kMillimetre, 7});
  };
  constexpr int kRounds = 8;
  constexpr double kRound = 26, kHalfX = 330, kHalfY = 480, kNear = 262, kThick = 80;
  for (int i = 0; i <= kRounds; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kRounds;
    const double inset = kRound * (1 - std::sin(angle));
    add(kNear + kRound * (1 - std::cos(angle)), kHalfX - inset, kHalfY - inset);
  }
  add(kNear + kThick, kHalfX, kHalfY);
  Mesh chair = join(sections);
  chair.texture = make_cloth(random, cv::Scalar(34, 31, 30), 1.5);
  return chair;
}

}  // namespace

std::vector<Mesh> make_person(const PersonParams& params, const Eigen::Vector3d& skin,
                              const std::string& where) {
  if (!params.skin.empty() && params.skin.size() != 3) {
    throw ConfigError(
        fmt::format("{}: background.person.skin has {} numbers, expected three: red, green, blue",
                    where, params.skin.size()));
  }
  const cv::Scalar shirt = bgr_of(params.shirt);
  const cv::Scalar skin_bgr = params.skin.empty()
                                  ? bgr_of(skin)
                                  : cv::Scalar(params.skin[2], params.skin[1], params.skin[0]);
  cv::RNG random(40503);
  std::vector<Mesh> meshes = {make_torso(random, shirt), make_arm(random, shirt, -1),
                              make_arm(random, shirt, 1), make_neck(random, skin_bgr),
                              make_head(random, skin_bgr)};
  if (params.chair) meshes.push_back(make_chair(random));
  const Eigen::Vector3d place(params.offset.x(), params.offset.y(), params.distance);
  for (Mesh& mesh : meshes) mesh.vertices.colwise() += place.cast<float>();
  return meshes;
}

}  // namespace hypotrack::synthetic
