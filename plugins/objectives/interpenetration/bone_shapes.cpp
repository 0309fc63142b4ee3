#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "collision_plan.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "surface.hpp"

namespace hypotrack::interpenetration {
namespace {

using Points = Eigen::Matrix3Xd;

constexpr int kMostStrips = 5;
constexpr double kAddsOne = 0.15;  // 1.85 times the width of a capsule is room for two
constexpr Eigen::Index kLeastVertices = 4;
constexpr double kFilled = 0.95;     // share of its bounding box that makes a mesh a box
constexpr double kSticksOut = 0.85;  // least distance of an end's centre from the surface, as a
                                     // share of the radius

/// Returns for each bone the vertices of which it has the largest weight, at the bind pose.
std::vector<Points> points_of_bones(const ModelData& data) {
  std::vector<std::vector<Eigen::Index>> held(data.bones.size());
  for (Eigen::Index v = 0; v < data.mesh.vertices.cols(); ++v) {
    Eigen::Index k = 0;
    data.mesh.bone_weights.col(v).maxCoeff(&k);
    held[static_cast<std::size_t>(data.mesh.bone_indices(k, v))].push_back(v);
  }
  std::vector<Points> points;
  for (const auto& vertices : held) {
    points.push_back(data.mesh.vertices(Eigen::all, vertices).cast<double>());
  }
  return points;
}

void store(const Eigen::Vector3d& vector, float* out) {
  Eigen::Vector3f::Map(out) = vector.cast<float>();
}

/// Bounding box of points along the axes of a frame.
struct Block {
  Eigen::Vector3d low, high;
  double width() const { return high.y() - low.y(); }
};

/// Medial line of a block of a model: as far from the surface as possible.
struct Line {
  Eigen::Vector3d middle;
  Eigen::Vector3d half;  // from the middle to where the block ends
  double radius;         // median distance from the surface, without the ends
};

/// Returns the principal axes, largest variance first, as columns. `along` replaces the first if
/// given.
Eigen::Matrix3d spread_axes(const Points& points, const std::optional<Eigen::Vector3d>& along) {
  Points centred = points.colwise() - points.rowwise().mean();
  if (along) centred -= *along * (along->transpose() * centred);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centred * centred.transpose());
  Eigen::Matrix3d axes = solver.eigenvectors().rowwise().reverse();
  if (along) axes = (Eigen::Matrix3d() << *along, axes.col(0), axes.col(1)).finished();
  return axes;
}

/// Returns the direction from a bone's joint to the next; nothing unless exactly one bone follows.
std::optional<Eigen::Vector3d> direction_of(const ModelData& data, std::size_t bone,
                                            const std::vector<Eigen::Isometry3d>& bind) {
  constexpr double kShortest = 1e-3;  // metres
  std::optional<Eigen::Vector3d> direction;
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    if (data.bones[b].parent != static_cast<int>(bone)) continue;
    if (direction) return std::nullopt;
    direction = bind[b].translation() - bind[bone].translation();
  }
  if (direction && direction->norm() < kShortest) return std::nullopt;
  if (direction) direction->normalize();
  return direction;
}

/// Fills the part of a model that belongs to one bone with capsules. The frame's x axis is along
/// the capsules, its y axis is the wider one across.
class CapsuleFit {
 public:
  CapsuleFit(const Surface& surface, const Points& bone, const Eigen::Matrix3d& axes)
      : surface_(surface), axes_(axes), points_(axes.transpose() * bone) {}

  std::vector<Shape> shapes(const Eigen::Isometry3d& bone_from_model) const {
    const Block whole{points_.rowwise().minCoeff(), points_.rowwise().maxCoeff()};
    const double ratio = whole.width() / std::max(2 * middle_line(whole).radius, 1e-6);
    const int strips = std::clamp(static_cast<int>(ratio + kAddsOne), 1, kMostStrips);
    std::vector<Shape> out;
    for (int i = 0; i < strips; ++i) {
      const double from = whole.low.y() + whole.width() * i / strips;
      const double to = whole.low.y() + whole.width() * (i + 1) / strips;
      if (const auto block = between(from, to)) out.push_back(capsule(*block, bone_from_model));
    }
    return out;
  }

 private:
  double distance(const Eigen::Vector3d& point) const { return surface_.distance(axes_ * point); }

  /// Returns the block of the points between two y; none if they are too few.
  std::optional<Block> between(double from, double to) const {
    std::vector<Eigen::Index> inside;
    for (Eigen::Index i = 0; i < points_.cols(); ++i) {
      if (points_(1, i) >= from && points_(1, i) <= to) inside.push_back(i);
    }
    if (inside.size() < kLeastVertices) return std::nullopt;
    const Points points = points_(Eigen::all, inside);
    Block block{points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
    block.low.y() = from;
    block.high.y() = to;
    return block;
  }

  Shape capsule(const Block& block, const Eigen::Isometry3d& bone_from_model) const {
    const Line line = middle_line(block);
    const double begin = end_of(line, -1), end = end_of(line, 1);
    Shape shape{};
    store(bone_from_model * (axes_ * (line.middle + (begin + end) / 2 * line.half)), shape.center);
    store(bone_from_model.linear() * (axes_ * ((end - begin) / 2 * line.half)), shape.half);
    shape.radius = static_cast<float>(line.radius);
    return shape;
  }

  Line middle_line(const Block& block) const {
    const Eigen::Vector3d a = innermost(block, 0.25), b = innermost(block, 0.75);
    Line line{(a + b) / 2, b - a, 0};
    constexpr int kSamples = 11;
    std::vector<double> distances;
    for (int i = 0; i < kSamples; ++i) {
      distances.push_back(distance(a + (b - a) * i / (kSamples - 1)));
    }
    line.radius = upper_median(std::move(distances));
    return line;
  }

  /// Finds the point of a block's cross section that is farthest from the surface, by shrinking
  /// steps. Of equally far points, as in a palm, it prefers the middle.
  Eigen::Vector3d innermost(const Block& block, double along) const {
    constexpr int kRounds = 10;
    constexpr double kPull = 0.1;  // distance in metres that a move of a metre from the middle must
                                   // gain
    Eigen::Vector3d middle = (block.low + block.high) / 2;
    middle.x() = block.low.x() + along * (block.high.x() - block.low.x());
    const auto merit = [&](const Eigen::Vector3d& point) {
      return distance(point) - kPull * (point - middle).norm();
    };
    Eigen::Vector3d best = middle, step = (block.high - block.low) / 4;
    double highest = merit(best);
    for (int round = 0; round < kRounds; ++round, step *= 0.7) {
      const Eigen::Vector3d from = best;  // take the best of four moves, not the first
      for (const Eigen::Vector3d& move :
           {Eigen::Vector3d(0, step.y(), 0), Eigen::Vector3d(0, -step.y(), 0),
            Eigen::Vector3d(0, 0, step.z()), Eigen::Vector3d(0, 0, -step.z())}) {
        const Eigen::Vector3d moved = (from + move).cwiseMax(block.low).cwiseMin(block.high);
        const double there = merit(moved);
        if (there <= highest) continue;
        highest = there;
        best = moved;
      }
    }
    return best;
  }

  /// Returns where a capsule ends towards `side`, in half lines from the middle: the farthest place
  /// at which a sphere stays within the surface.
  double end_of(const Line& line, double side) const {
    constexpr int kSteps = 20;
    for (int i = kSteps; i > 0; --i) {
      const double t = side * i / kSteps;
      if (distance(line.middle + t * line.half) >= kSticksOut * line.radius) return t;
    }
    return 0;
  }

  const Surface& surface_;
  Eigen::Matrix3d axes_;  // columns
  Points points_;
};

Shape box_of(const Points& points, const Eigen::Isometry3d& bone_from_model) {
  const Points in_bone = bone_from_model * points;
  const Eigen::Vector3d low = in_bone.rowwise().minCoeff(), high = in_bone.rowwise().maxCoeff();
  Shape shape{};
  shape.is_box = 1;
  store((low + high) / 2, shape.center);
  store((high - low) / 2, shape.half);
  return shape;
}

bool fills(const Surface& surface, const Shape& box) {
  const double volume = 8.0 * box.half[0] * box.half[1] * box.half[2];
  return volume > 0 && surface.volume() >= kFilled * volume;
}

}  // namespace

std::vector<Shape> bone_shapes(const ModelData& data) {
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  const Surface surface(data.mesh);
  if (data.bones.size() == 1) {
    const Shape box = box_of(data.mesh.vertices.cast<double>(), bind[0].inverse());
    if (fills(surface, box)) return {box};
  }
  const std::vector<Points> points = points_of_bones(data);
  std::vector<Shape> shapes;
  for (std::size_t b = 0; b < points.size(); ++b) {
    if (points[b].cols() < kLeastVertices) continue;
    const Eigen::Matrix3d axes = spread_axes(points[b], direction_of(data, b, bind));
    for (Shape& shape : CapsuleFit(surface, points[b], axes).shapes(bind[b].inverse())) {
      shape.bone = static_cast<std::int32_t>(b);
      shapes.push_back(shape);
    }
  }
  return shapes;
}

}  // namespace hypotrack::interpenetration
