#include <algorithm>
#include <cmath>
#include <future>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"
#include "subject.hpp"
#include "test_models.hpp"

namespace hypotrack::contract {
namespace {

constexpr double kTurn = 6.3;              // radians, for joints that turn without end
constexpr double kVertexTolerance = 1e-5;  // metres; vertices are single precision

/// A posed model: vertices and landmarks, metres.
struct Posed {
  Eigen::Matrix3Xd vertices;
  Eigen::Matrix3Xd landmarks;
};

Posed pose(const Model& model, const Eigen::VectorXd& parameters) {
  const std::span<const double> values(parameters.data(),
                                       static_cast<std::size_t>(parameters.size()));
  return {posed_vertices(model, values).cast<double>(), posed_landmarks(model, values)};
}

Eigen::VectorXd rest(const Model& model) {
  Eigen::VectorXd parameters(model.dimension());
  for (int i = 0; i < model.dimension(); ++i) parameters[i] = model.data().parameters[i].rest;
  return parameters;
}

double distance(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return a.cols() == 0 ? 0 : (a - b).colwise().norm().maxCoeff();
}

double distance(const Posed& a, const Posed& b) {
  return std::max(distance(a.vertices, b.vertices), distance(a.landmarks, b.landmarks));
}

void check_size(const Model& model) {
  const Eigen::Matrix3Xd vertices = pose(model, rest(model)).vertices;
  const double size = (vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff()).norm();
  require(size > 0.002 && size < 10,
          "it is " + std::to_string(size) +
              " metres across, expected between 0.002 and 10: is its file in another unit?");
}

/// Returns the rest state, the corners of all bounds, and random states.
std::vector<Eigen::VectorXd> typical_states(const Model& model) {
  std::vector<Eigen::VectorXd> states(3, rest(model));
  for (int i = 0; i < model.dimension(); ++i) {
    const Parameter& parameter = model.data().parameters[i];
    if (!is_joint(parameter.kind)) continue;
    states[1][i] = std::max(parameter.lower, -kTurn);
    states[2][i] = std::min(parameter.upper, kTurn);
  }
  const Scene scene({{"it", std::shared_ptr<const Model>(&model, [](const Model*) {})}});
  std::mt19937_64 random(1);
  for (int i = 0; i < 10; ++i) states.push_back(test::random_state(scene, random));
  return states;
}

void check_finite(const Model& model) {
  for (const Eigen::VectorXd& state : typical_states(model)) {
    const Posed posed = pose(model, state);
    require(posed.vertices.allFinite() && posed.landmarks.allFinite(),
            "a state within the bounds gives vertices or landmarks that are not finite");
    // So far beyond the model's size, something is multiplied that should not be.
    const Eigen::Vector3d position = state.head<3>();
    require((posed.vertices.colwise() - position).colwise().norm().maxCoeff() < 20,
            "a state within the bounds moves vertices by more than 20 metres");
  }
}

void check_translation(const Model& model) {
  for (const Eigen::VectorXd& state : typical_states(model)) {
    const Eigen::Vector3d shift(0.1, -0.2, 0.3);
    Eigen::VectorXd moved = state;
    moved.head<3>() += shift;
    Posed expected = pose(model, state);
    expected.vertices.colwise() += shift;
    expected.landmarks.colwise() += shift;
    const double error = distance(pose(model, moved), expected);
    require(error < kVertexTolerance, "moving its position leaves vertices or landmarks " +
                                          std::to_string(error) + " metres from where they belong");
  }
}

void check_rotation(const Model& model) {
  for (const Eigen::VectorXd& state : typical_states(model)) {
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
    const Eigen::Quaterniond before(state[3], state[4], state[5], state[6]);
    const Eigen::Quaterniond after = turn * before;
    Eigen::VectorXd turned = state;
    turned.segment<4>(3) << after.w(), after.x(), after.y(), after.z();
    const Eigen::Vector3d center = state.head<3>();
    Posed expected = pose(model, state);
    for (Eigen::Matrix3Xd* points : {&expected.vertices, &expected.landmarks}) {
      *points = (turn.toRotationMatrix() * (points->colwise() - center)).colwise() + center;
    }
    const double error = distance(pose(model, turned), expected);
    require(error < kVertexTolerance, "turning it leaves vertices or landmarks " +
                                          std::to_string(error) + " metres from where they belong");
  }
}

void check_joints_matter(const Model& model) {
  const Posed resting = pose(model, rest(model));
  for (int i = 0; i < model.dimension(); ++i) {
    const Parameter& parameter = model.data().parameters[i];
    if (!is_joint(parameter.kind) || parameter.lower == parameter.upper) continue;
    Eigen::VectorXd state = rest(model);
    const bool up = parameter.upper - parameter.rest > parameter.rest - parameter.lower;
    const bool endless = std::isinf(parameter.upper);
    state[i] = endless ? parameter.rest + 1 : up ? parameter.upper : parameter.lower;
    require(distance(pose(model, state), resting) > kVertexTolerance,
            "the joint '" + parameter.name + "' moves nothing");
  }
}

void check_self_posing(const Model& model) {
  if (!model.poses_itself()) throw Skipped("its skeleton poses it");
  const auto states = typical_states(model);
  std::vector<Posed> expected;
  for (const auto& state : states) expected.push_back(pose(model, state));
  std::vector<std::future<double>> threads;
  for (int t = 0; t < 4; ++t) {
    threads.push_back(std::async(std::launch::async, [&] {
      double error = 0;
      for (int round = 0; round < 20; ++round) {
        for (std::size_t i = 0; i < states.size(); ++i) {
          error = std::max(error, distance(pose(model, states[i]), expected[i]));
        }
      }
      return error;
    }));
  }
  for (auto& thread : threads) {
    require(thread.get() == 0, "four threads posing at once differ from one");
  }
}

template <class Matrix>
bool same(const Matrix& a, const Matrix& b) {
  return a.cols() == b.cols() && a == b;
}

std::vector<double> values_of(const std::vector<ShapeParameter>& shape) {
  std::vector<double> values;
  for (const ShapeParameter& p : shape) values.push_back(p.value);
  return values;
}

void check_shape_parameters(const std::vector<ShapeParameter>& shape) {
  std::set<std::string> names;
  for (const ShapeParameter& p : shape) {
    require(!p.name.empty() && names.insert(p.name).second,
            "a shape parameter has no name or that of another: '" + p.name + "'");
    require(p.lower < p.upper && p.lower <= p.neutral && p.neutral <= p.upper &&
                p.lower <= p.value && p.value <= p.upper && p.deviation > 0 &&
                std::isfinite(p.lower + p.upper + p.deviation),
            "the shape parameter '" + p.name +
                "' must have finite bounds, values within them and a positive deviation");
  }
}

void check_shapes(const Model& model) {
  const std::vector<ShapeParameter> shape = model.shape_parameters();
  if (shape.empty()) throw Skipped("it has one shape only");
  check_shape_parameters(shape);
  const ModelData& own = model.data();
  const Posed as_it_is = pose(model, rest(model));
  const auto built = [&](const std::vector<double>& values) {
    ModelData data = model.shaped(values);
    validate(data, "its shape");
    require(same(data.mesh.triangles, own.mesh.triangles) &&
                same(data.mesh.bone_indices, own.mesh.bone_indices) &&
                data.bones.size() == own.bones.size() &&
                data.parameters.size() == own.parameters.size() &&
                data.landmarks.size() == own.landmarks.size(),
            "another shape has other triangles, bones, parameters or landmarks");
    const Model other(std::move(data));
    return pose(other, rest(other));
  };
  if (!model.poses_itself())
    require(distance(built(values_of(shape)), as_it_is) < kVertexTolerance,
            "built with the values that it has it is not what it is");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    for (const double bound : {shape[i].lower, shape[i].upper}) {
      if (bound == shape[i].value) continue;
      std::vector<double> values = values_of(shape);
      values[i] = bound;
      require(distance(built(values), as_it_is) > kVertexTolerance,
              "the shape parameter '" + shape[i].name + "' changes nothing");
    }
  }
}

}  // namespace

void check_model(Report& report, const Subject& subject) {
  // Making the model validates its data: mesh, skeleton, weights, bounds, names.
  if (!check_parameters<Model>(report, subject)) return;
  const auto model = subject.make<Model>();
  const ModelData& data = model->data();
  report.row("it has landmarks", [&] {
    require(!data.landmarks.empty(), "there are none, expected at least one for error metrics");
  });
  report.row("it is in metres", [&] { check_size(*model); });
  report.row("every state within the bounds can be posed", [&] { check_finite(*model); });
  report.row("its position moves it rigidly", [&] { check_translation(*model); });
  report.row("its rotation turns it rigidly about its origin", [&] { check_rotation(*model); });
  report.row("every joint moves something", [&] { check_joints_matter(*model); });
  report.row("its shape parameters build it", [&] { check_shapes(*model); });
  report.row("its directions are perpendicular unit vectors", [&] {
    if (model->directions().empty()) throw Skipped("it names none");
  });
  report.row("it poses itself the same from several threads", [&] { check_self_posing(*model); });
  report.row("a second object is the same", [&] {
    const auto second = subject.make<Model>();
    require(second->dimension() == model->dimension() &&
                second->data().mesh.vertices == data.mesh.vertices &&
                second->data().mesh.triangles == data.mesh.triangles,
            "its mesh or its parameters differ");
  });
}

}  // namespace hypotrack::contract
