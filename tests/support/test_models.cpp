#include "test_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kBlend = 0.006;  // half the length, in metres, over which two bones share the skin

struct Finger {
  const char* name;
  Eigen::Isometry3d hand_from_base;
  std::array<double, 3> lengths;  // metres
  double radius;
};

Finger straight_finger(const char* name, double x, double y, std::array<double, 3> lengths,
                       double radius) {
  Finger finger{name, Eigen::Isometry3d::Identity(), lengths, radius};
  finger.hand_from_base.translation() << x, y, 0;
  return finger;
}

Finger thumb() {
  Finger finger{"thumb", Eigen::Isometry3d::Identity(), {0.042, 0.030, 0.025}, 0.011};
  finger.hand_from_base.translation() << 0.022, 0.025, 0.006;
  finger.hand_from_base.rotate(Eigen::AngleAxisd(-45 * kPi / 180, Eigen::Vector3d::UnitZ()));
  finger.hand_from_base.rotate(Eigen::AngleAxisd(-60 * kPi / 180, Eigen::Vector3d::UnitY()));
  return finger;
}

double ramp(double y, double joint) {
  const double t = std::clamp((y - joint) / (2 * kBlend) + 0.5, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Collects closed capsules into one mesh.
class MeshBuilder {
 public:
  struct Capsule {
    Eigen::Isometry3d model_from_capsule;
    double start, end;          // along y, metres
    double radius_x, radius_z;  // metres
    int rings, segments;
    int bone;  // the first bone; with joints: the one before the first joint
    int first_joint_bone;
    std::vector<double> joints;  // y of the joints to the following bones
  };

  void add(const Capsule& c) {
    const int base = static_cast<int>(vertices_.size());
    add_vertex(c, {0, c.start, 0});
    for (int ring = 1; ring <= c.rings; ++ring) {
      const double u = kPi * ring / (c.rings + 1);
      const double y = c.start + (c.end - c.start) * (1 - std::cos(u)) / 2;
      const double width = std::pow(std::sin(u), 0.4);
      for (int s = 0; s < c.segments; ++s) {
        const double angle = 2 * kPi * s / c.segments;
        add_vertex(c,
                   {c.radius_x * width * std::cos(angle), y, c.radius_z * width * std::sin(angle)});
      }
    }
    add_vertex(c, {0, c.end, 0});
    connect(base, c.rings, c.segments);
  }

  Mesh finish() const {
    Mesh mesh;
    const auto count = static_cast<Eigen::Index>(vertices_.size());
    mesh.vertices.resize(3, count);
    mesh.bone_indices.resize(4, count);
    mesh.bone_weights.resize(4, count);
    for (Eigen::Index v = 0; v < count; ++v) {
      const auto i = static_cast<std::size_t>(v);
      mesh.vertices.col(v) = vertices_[i];
      mesh.bone_indices.col(v) = indices_[i];
      mesh.bone_weights.col(v) = weights_[i];
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles_[t];
    }
    return mesh;
  }

 private:
  void add_vertex(const Capsule& c, const Eigen::Vector3d& position) {
    vertices_.push_back((c.model_from_capsule * position).cast<float>());
    Eigen::Vector4d weights(1, 0, 0, 0);
    Eigen::Vector4i indices(c.bone, 0, 0, 0);
    for (std::size_t j = 0; j < c.joints.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      weights[k + 1] = weights[k] * ramp(position.y(), c.joints[j]);
      weights[k] -= weights[k + 1];
      indices[k + 1] = c.first_joint_bone + static_cast<int>(j);
    }
    weights_.push_back(weights.cast<float>());
    indices_.push_back(indices);
  }

  void connect(int base, int rings, int segments) {
    const auto at = [&](int ring, int s) {
      return base + 1 + (ring - 1) * segments + s % segments;
    };
    const int last = base + 1 + rings * segments;
    for (int s = 0; s < segments; ++s) {
      triangles_.push_back({base, at(1, s), at(1, s + 1)});
      for (int ring = 1; ring < rings; ++ring) {
        triangles_.push_back({at(ring, s), at(ring + 1, s), at(ring, s + 1)});
        triangles_.push_back({at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)});
      }
      triangles_.push_back({at(rings, s), last, at(rings, s + 1)});
    }
  }

  std::vector<Eigen::Vector3f> vertices_;
  std::vector<Eigen::Vector4i> indices_;
  std::vector<Eigen::Vector4f> weights_;
  std::vector<Eigen::Vector3i> triangles_;
};

// Four bones (three phalanges and the tip), four angles, four landmarks and the skin.
void add_finger(const Finger& finger, ModelData& hand, MeshBuilder& skin) {
  const std::string name = finger.name;
  const int first = static_cast<int>(hand.bones.size());
  const int angles = static_cast<int>(hand.parameters.size());
  hand.bones.push_back({name + "_1", 0, finger.hand_from_base});
  for (int i = 0; i < 3; ++i) {
    Eigen::Isometry3d joint = Eigen::Isometry3d::Identity();
    joint.translation().y() = finger.lengths[static_cast<std::size_t>(i)];
    const std::string bone = i < 2 ? name + "_" + std::to_string(i + 2) : name + "_tip";
    hand.bones.push_back({bone, first + i, joint});
  }
  hand.parameters.push_back({name + "_abduction", ParameterKind::angle, -0.3, 0.3, 0});
  hand.motions.push_back({first, angles, -Eigen::Vector3d::UnitZ(), 0, 1});
  for (int i = 0; i < 3; ++i) {
    const double limit = name == "thumb" ? 1.0 : 1.6;
    hand.parameters.push_back(
        {name + "_flexion_" + std::to_string(i + 1), ParameterKind::angle, -0.2, limit, 0.1});
    hand.motions.push_back({first + i, angles + 1 + i, Eigen::Vector3d::UnitX(), 0, 1});
  }
  for (int i = 0; i < 4; ++i) {
    hand.landmarks.push_back(
        {hand.bones[static_cast<std::size_t>(first + i)].name, first + i, Eigen::Vector3d::Zero()});
  }
  const auto [a, b, c] = finger.lengths;
  skin.add({finger.hand_from_base,
            -0.012,
            a + b + c,
            finger.radius,
            finger.radius,
            20,
            12,
            0,
            first,
            {0, a, a + b}});
}

}  // namespace

ModelData make_test_hand() {
  ModelData hand;
  hand.parameters = pose_parameters();
  hand.bones.push_back({"wrist", -1, Eigen::Isometry3d::Identity()});
  hand.landmarks.push_back({"wrist", 0, Eigen::Vector3d::Zero()});
  MeshBuilder skin;
  for (const Finger& finger :
       {thumb(), straight_finger("index", 0.028, 0.092, {0.043, 0.025, 0.022}, 0.009),
        straight_finger("middle", 0.007, 0.095, {0.047, 0.029, 0.024}, 0.009),
        straight_finger("ring", -0.014, 0.090, {0.043, 0.027, 0.023}, 0.0085),
        straight_finger("little", -0.033, 0.082, {0.033, 0.020, 0.020}, 0.0075)}) {
    add_finger(finger, hand, skin);
  }
  skin.add({Eigen::Isometry3d::Identity(), -0.01, 0.105, 0.044, 0.015, 18, 16, 0, 0, {}});
  hand.mesh = skin.finish();
  return hand;
}

ModelData make_test_box(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
    mesh.vertices.col(i) = corner.cwiseProduct(size).cast<float>();
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles << 0, 0, 1, 1, 0, 0, 2, 2, 0, 0, 4, 4,  //
      6, 4, 3, 7, 1, 5, 7, 6, 3, 2, 5, 7,                //
      2, 6, 7, 5, 5, 4, 3, 7, 1, 3, 7, 6;
  return rigid_model(std::move(mesh));
}

ModelData make_test_cabinet() {
  using Eigen::Vector3d;
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const auto at = [](double x, double y, double z) {
    Eigen::Isometry3d pose(Eigen::Translation3d(x, y, z));
    return pose.rotate(Eigen::AngleAxisd(0.4, Vector3d(1, -2, 2) / 3));
  };
  ModelData cabinet;
  cabinet.bones = {{"body", -1, at(0, 0, 0)},          {"drawer", 0, at(0, -0.02, 0.01)},
                   {"door", 0, at(0.02, 0.02, -0.03)}, {"knob", 2, at(0.02, 0, -0.01)},
                   {"latch", 2, at(-0.02, 0.01, 0)},   {"shelf", 0, at(0, 0.02, 0.02)}};
  cabinet.parameters = pose_parameters();
  cabinet.parameters.push_back({"drawer", ParameterKind::length, -0.01, 0.08, 0});
  cabinet.parameters.push_back({"door", ParameterKind::angle, 0, 1.5, 0.2});
  cabinet.parameters.push_back({"knob", ParameterKind::angle, -kEndless, kEndless, 0});
  const MotionKind slides = MotionKind::translation;
  const Vector3d axis = Vector3d(2, 1, -2) / 3;
  cabinet.motions = {{1, 7, axis, 0.01, 1, slides},
                     {2, 8, Vector3d::UnitY()},
                     {3, 9, Vector3d::UnitZ()},
                     {4, 8, axis, 0.1, -2},
                     {4, 8, Vector3d::UnitX(), 0.1, 0.02, slides},
                     {5, 7, Vector3d::UnitZ(), 0, -0.5, slides}};
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(cabinet);
  const Mesh box = make_test_box({0.05, 0.03, 0.04}).mesh;
  const auto count = static_cast<Eigen::Index>(cabinet.bones.size());
  const Eigen::Index corners = box.vertices.cols(), faces = box.triangles.cols();
  Mesh& mesh = cabinet.mesh;
  mesh.vertices.resize(3, count * corners);
  mesh.triangles.resize(3, count * faces);
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, count * corners);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, count * corners);
  mesh.bone_weights.row(0).setOnes();
  for (Eigen::Index b = 0; b < count; ++b) {
    mesh.vertices.middleCols(b * corners, corners) =
        bind[static_cast<std::size_t>(b)].cast<float>() * box.vertices;
    mesh.triangles.middleCols(b * faces, faces) =
        box.triangles.array() + static_cast<int>(b * corners);
    mesh.bone_indices.row(0).segment(b * corners, corners).setConstant(static_cast<int>(b));
    cabinet.landmarks.push_back({cabinet.bones[static_cast<std::size_t>(b)].name,
                                 static_cast<int>(b), Vector3d(0.02, 0.01, 0.02)});
  }
  return cabinet;
}

ModelData make_test_ball(double radius) {
  constexpr int kRings = 32, kSides = 64;
  Mesh mesh;
  mesh.vertices.resize(3, (kRings + 1) * kSides);
  mesh.triangles.resize(3, 2 * kRings * kSides);
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = kPi * ring / kRings;
    for (int side = 0; side < kSides; ++side) {
      const double turn = 2 * kPi * side / kSides;
      const Eigen::Vector3d out(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                std::cos(polar));
      mesh.vertices.col(ring * kSides + side) = (radius * out).cast<float>();
    }
  }
  int face = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      const int a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
      mesh.triangles.col(face++) << a, a + kSides, b;
      mesh.triangles.col(face++) << b, a + kSides, b + kSides;
    }
  }
  return rigid_model(std::move(mesh));
}

Scene make_hand_and_box() {
  return Scene({{"hand", std::make_shared<Model>(make_test_hand())},
                {"box", std::make_shared<Model>(make_test_box())}});
}

Eigen::VectorXd random_state(const Scene& scene, std::mt19937_64& random,
                             const Eigen::Vector3d& center, double radius) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd state(scene.dimension());
  for (int i = 0; i < scene.dimension(); ++i) {
    const Parameter& parameter = scene.parameters()[static_cast<std::size_t>(i)];
    constexpr double kTurn = 2 * kPi;
    const double lower = std::max(parameter.lower, -kTurn),
                 upper = std::min(parameter.upper, kTurn);
    state[i] = parameter.kind == ParameterKind::quaternion ? normal(random)
                                                           : lower + (upper - lower) * unit(random);
  }
  for (const Scene::Item& item : scene.items()) {
    for (int k = 0; k < 3; ++k) {
      state[item.offset + k] = center[k] + radius * (2 * unit(random) - 1);
    }
  }
  scene.normalize(state);
  return state;
}

}  // namespace hypotrack::test
