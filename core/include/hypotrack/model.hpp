#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Triangles with up to four bone influences per vertex. Vertices are welded by position; texture
/// coordinates have their own index triple so that seams do not split the surface.
struct Mesh {
  Eigen::Matrix3Xf vertices;      ///< 3xV, model frame at the bind pose, metres
  Eigen::Matrix3Xi triangles;     ///< 3xT vertex indices, counter-clockwise from outside
  Eigen::Matrix4Xi bone_indices;  ///< 4xV, unused influences have weight 0 and index 0
  Eigen::Matrix4Xf bone_weights;  ///< 4xV, non-negative, each column sums to 1
  Eigen::Matrix2Xf uv;            ///< 2xU in [0, 1], v upwards (OpenGL); 2x0 without texture
  Eigen::Matrix3Xi uv_triangles;  ///< 3xT indices into uv; 3x0 without texture
  cv::Mat texture;                ///< 8-bit BGR, top row = v 1; empty: `color` everywhere
  Eigen::Vector3f color{0.70f, 0.55f, 0.47f};  ///< RGB in [0, 1] where there is no texture
};

struct Bone {
  std::string name;
  int parent = -1;  ///< index of an earlier bone, -1 at the root
  Eigen::Isometry3d parent_from_bone = Eigen::Isometry3d::Identity();  ///< at the bind pose
};

enum class ParameterKind { position, quaternion, angle };

/// One number of a model's state. Every model begins with its pose, world_from_model: position x y
/// z (metres), then a unit quaternion w x y z. Angles (radians) follow.
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::angle;
  double lower =
      0;  ///< anatomical or mechanical bounds; infinite for positions, -1 .. 1 for quaternions
  double upper = 0;
  double rest = 0;  ///< within the bounds; quaternion 1 0 0 0
};

/// A parameter turning a bone: parent_from_bone(bind) * AngleAxis(scale * (value - zero), axis).
/// Several rotations of one bone apply in the order of the list, each in the frame that the one
/// before it left.
struct BoneRotation {
  int bone = 0;
  int parameter = 0;  ///< index into ModelData::parameters, of kind angle
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector in the bone's frame
  double zero = 0;  ///< value at which the bone stands as in the bind pose
  double scale = 1;
};

/// A named point for error metrics: a joint of a hand, an anchor of a rigid object.
struct Landmark {
  std::string name;
  int bone = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the bone's frame, metres
};

/// One number that says how the individual is built that a model stands for: a size, the length of
/// a finger. It belongs to the model, not to the state.
struct ShapeParameter {
  std::string name;
  double value = 1;    ///< that the model is built with
  double neutral = 1;  ///< of the model as its files have it
  double lower = 1;    ///< bounds; `value` and `neutral` lie within
  double upper = 1;
  double deviation = 1;  ///< standard deviation among individuals, > 0; what is known beforehand
};

/// Everything that makes a model. A rigid object is a skeleton of one bone.
struct ModelData {
  Mesh mesh;
  std::vector<Bone> bones;
  std::vector<Parameter> parameters;
  std::vector<BoneRotation> rotations;
  std::vector<Landmark> landmarks;
};

/// Throws DataError, naming `where`, on data that breaks the contracts above: no faces, NaN,
/// indices out of range, weights that do not sum to 1, parents after children, a first seven
/// parameters that are no pose, bounds the wrong way round.
HYPOTRACK_API void validate(const ModelData& data, std::string_view where);

/// The parameters that move one part of a model together, as indices: the pose's seven first, then
/// the limbs. A limb is a chain of jointed bones up to where the skeleton forks into several
/// jointed ones: a finger, or an arm between the shoulder and the hand. A parameter that turns
/// bones of several limbs makes one of them; one that turns no bone is alone.
HYPOTRACK_API std::vector<std::vector<int>> parameter_groups(const ModelData& data);

/// A model is data. Core moves it: one kinematics and skinning for every model on the CPU, one on
/// the GPU.
class HYPOTRACK_API Model {
 public:
  /// Throws DataError where validate() does.
  explicit Model(ModelData data);
  virtual ~Model();
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const ModelData& data() const { return data_; }
  /// Number of parameters.
  int dimension() const { return static_cast<int>(data_.parameters.size()); }

  /// True for a model that a skeleton cannot express. Then `pose` is called instead of the
  /// skinning, hypotheses are posed on the CPU, one by one, and from several threads at once.
  virtual bool poses_itself() const { return false; }
  /// Vertices (3xV) and landmarks (3xL) in the world, metres, for one parameter vector.
  virtual void pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
                    Eigen::Matrix3Xd& landmarks) const;

  /// The numbers that build another individual of this kind; empty: there is only this one. A model
  /// plugin that has some reads them with ShapeSettings (shape.hpp), so that scenes can give what
  /// `hypotrack fit-shape` has found.
  virtual std::vector<ShapeParameter> shape_parameters() const { return {}; }
  /// What data() would be with other values of shape_parameters(), in their order and within their
  /// bounds. Bones, parameters, landmarks, triangles and weights stay; places and lengths change.
  /// Throws Error if there are none, or another number of values.
  virtual ModelData shaped(std::span<const double> values) const;

 private:
  ModelData data_;
};

/// The seven pose parameters that every model begins with: position_x/y/z and rotation_w/x/y/z.
HYPOTRACK_API std::vector<Parameter> pose_parameters();

/// The mirror image in the plane x = 0: geometry, winding, joints and axes; parameters keep their
/// names, meaning and bounds (a positive flexion still flexes).
HYPOTRACK_API ModelData mirrored(const ModelData& data);

/// A rigid model: one bone, seven parameters and the given landmarks (or, if empty, three anchors
/// on the axes of the bounding box: its centre and the ends of its two longest half-axes).
HYPOTRACK_API ModelData rigid_model(Mesh mesh, std::vector<Landmark> landmarks = {});

}  // namespace hypotrack
