#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

/// A triangle mesh with up to four bone influences per vertex. Vertices are welded by position.
/// Texture coordinates have their own indices, so that texture seams do not split the surface.
struct Mesh {
  Eigen::Matrix3Xf vertices;        ///< 3xV, model frame at the bind pose, metres
  Eigen::Matrix3Xi triangles;       ///< 3xT vertex indices, counter-clockwise from outside
  Eigen::Matrix4Xi bone_indices{};  ///< 4xV; unused influences have weight 0 and index 0
  Eigen::Matrix4Xf bone_weights{};  ///< 4xV, non-negative, each column sums to 1
  Eigen::Matrix2Xf uv{};            ///< 2xU in [0, 1], v upwards (OpenGL); 2x0 without texture
  Eigen::Matrix3Xi uv_triangles{};  ///< 3xT indices into uv; 3x0 without texture
  cv::Mat texture{};                ///< 8-bit BGR, top row at v = 1; empty = `color` everywhere
  Eigen::Vector3f color{0.70f, 0.55f, 0.47f};  ///< RGB in [0, 1] where there is no texture
};

/// A bone of a skeleton, relative to its parent.
struct Bone {
  std::string name;
  int parent = -1;  ///< index of an earlier bone; -1 for the root
  Eigen::Isometry3d parent_from_bone = Eigen::Isometry3d::Identity();  ///< at the bind pose
};

enum class ParameterKind { position, quaternion, angle, length };

/// Returns whether a parameter moves joints: an angle or a length.
inline bool is_joint(ParameterKind kind) {
  return kind == ParameterKind::angle || kind == ParameterKind::length;
}
/// Returns whether a parameter is in metres.
inline bool is_in_metres(ParameterKind kind) {
  return kind == ParameterKind::position || kind == ParameterKind::length;
}

/// Number of parameters of a model's pose: position and quaternion, which come first in its state.
inline constexpr int kPoseSize = 7;

/// One number of a model's state. Every model begins with its pose, world_from_model: position x y
/// z (metres) and a unit quaternion w x y z. Joints follow: angles (radians) and lengths (metres).
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::angle;
  double lower = 0;  ///< anatomical or mechanical bounds; infinite for positions and for joints
                     ///< that turn without end, -1 .. 1 for quaternions
  double upper = 0;
  double rest = 0;  ///< within the bounds; 1 0 0 0 for the quaternion
};

enum class MotionKind { rotation, translation };

/// The motion of a bone by a parameter: parent_from_bone(bind) * AngleAxis(scale * (value - zero),
/// axis), or a translation by that amount along the axis. Several motions of one bone apply in the
/// order of the list, each in the frame that the previous one produced. A parameter may move
/// several bones, each with a scale and zero of its own (joints that mimic another).
struct BoneMotion {
  int bone = 0;
  int parameter = 0;  ///< index into ModelData::parameters, of kind angle or length
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector in the bone's frame
  double zero = 0;                                  ///< value that gives the bind pose
  double scale = 1;  ///< of the amount: radians or metres per unit of the parameter
  MotionKind kind = MotionKind::rotation;
};

/// A named point for error metrics: a joint or an anchor of a rigid object.
struct Landmark {
  std::string name;
  int bone = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the bone's frame, metres
};

/// One number that describes the build of an individual, such as its size or a limb's length. It
/// belongs to the model, not to the state.
struct ShapeParameter {
  std::string name;
  double value = 1;    ///< of this model
  double neutral = 1;  ///< of the model as its files have it
  double lower = 1;    ///< bounds; `value` and `neutral` lie within
  double upper = 1;
  double deviation = 1;  ///< prior standard deviation among individuals, > 0
  /// Correlations among individuals with each parameter before it; empty: it is independent of
  /// them.
  std::vector<double> correlations = {};
};

/// A direction of a model at rest by which scenes may give its rotation (`{lid: up, front: away}`).
struct NamedDirection {
  std::string name;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector in the model's frame
};

/// All data of a model. A rigid object is a skeleton of one bone.
struct ModelData {
  Mesh mesh;
  std::vector<Bone> bones;
  std::vector<Parameter> parameters;
  std::vector<BoneMotion> motions;
  std::vector<Landmark> landmarks;
  /// Fewer triangles of nearly the same surface, without texture, for scoring hypotheses. Without
  /// triangles, and for models that pose themselves, `mesh` is scored.
  Mesh simplified = {};
};

/// Fills `simplified` of valid data with triangles at most `tolerance` (metres) from vertices of
/// the mesh. Leaves it empty if that takes more than half as many. Returns the largest distance.
HYPOTRACK_API double simplify(ModelData& data, double tolerance);

/// Throws DataError, naming `where`, if the data breaks a contract above. Examples are missing
/// faces, NaN, indices out of range and weights that do not sum to 1. Others are parents after
/// children, reversed bounds, and a model that does not begin with a pose.
HYPOTRACK_API void validate(const ModelData& data, std::string_view where);

/// Groups the parameters that move one part of a model together and returns their indices. The
/// first group is the pose's seven. Each other group is a limb, such as a leg or a door with its
/// handle. A limb is a chain of jointed bones up to where the skeleton forks into several
/// jointed ones. A parameter that moves bones of several limbs joins them. A parameter that moves
/// no bone is a group of its own.
HYPOTRACK_API std::vector<std::vector<int>> parameter_groups(const ModelData& data);

/// A model that can be tracked: data that core's kinematics and skinning pose on CPU and GPU.
class HYPOTRACK_API Model : public PluginObject {
 public:
  /// Throws DataError as validate() does.
  explicit Model(ModelData data);
  ~Model() override;

  const ModelData& data() const { return data_; }
  int dimension() const { return static_cast<int>(data_.parameters.size()); }

  /// Returns true for a model that a skeleton cannot express. Then `pose` replaces the skinning:
  /// hypotheses are posed on the CPU, one per call, from several threads at once. The answer never
  /// changes.
  bool poses_itself() const;
  /// Computes the world vertices (3xV) and landmarks (3xL), metres, for one parameter vector.
  /// Throws PluginError, naming the model, if their number is another than in data(), or one is not
  /// finite.
  void pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
            Eigen::Matrix3Xd& landmarks) const;

  /// Returns the shape parameters of this kind of model; empty if there is only one individual. A
  /// plugin reads their values with ShapeSettings (shape.hpp), so that scenes can use the results
  /// of `hypotrack fit-shape`. Throws PluginError if shape_correlations() refuses them.
  std::vector<ShapeParameter> shape_parameters() const;
  /// Returns data() for other values of shape_parameters(), in their order and within their bounds.
  /// Positions and lengths change. Bones, parameters, landmarks, triangles and weights stay. Throws
  /// Error if the model has no shape parameters or the number of values differs.
  ModelData shaped(std::span<const double> values) const;

  /// Returns directions that people can name, perpendicular to each other, under different names.
  /// A scene turns the model by two of them; empty: by angles only. Throws PluginError if they are
  /// not so.
  std::vector<NamedDirection> directions() const;
  /// Returns names of landmarks that people find in pictures, clearest first. `hypotrack
  /// start` asks for these before the others.
  std::vector<std::string> clear_landmarks() const;

 protected:
  // What plugins write: each function as the public one of its name says.
  virtual bool do_poses_itself() const { return false; }
  virtual void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                       Eigen::Matrix3Xd& landmarks) const;
  virtual std::vector<ShapeParameter> do_shape_parameters() const { return {}; }
  virtual ModelData do_shaped(std::span<const double> values) const;
  virtual std::vector<NamedDirection> do_directions() const { return {}; }
  virtual std::vector<std::string> do_clear_landmarks() const { return {}; }

 private:
  ModelData data_;
};

/// Returns the pose parameters that every model begins with: position_x/y/z and rotation_w/x/y/z.
HYPOTRACK_API std::vector<Parameter> pose_parameters();

/// Mirrors a model in the plane x = 0: geometry, winding, joints and axes. Parameters keep their
/// names, meaning and bounds, so that a positive flexion still flexes.
HYPOTRACK_API ModelData mirrored(const ModelData& data);

/// Returns the centre of the points' bounding box (`center`) and the ends of its two longest
/// half-axes (`end_x` ...), on bone 0. Of equally long axes, the earlier one comes first.
HYPOTRACK_API std::vector<Landmark> bounding_box_landmarks(const Eigen::Matrix3Xf& points);

/// Makes a rigid model of one bone and seven parameters. If `landmarks` is empty, it gets
/// bounding_box_landmarks().
HYPOTRACK_API ModelData rigid_model(Mesh mesh, std::vector<Landmark> landmarks = {});

}  // namespace hypotrack
