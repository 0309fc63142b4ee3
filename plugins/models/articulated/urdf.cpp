#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "description.hpp"
#include "hypotrack/api/error.hpp"
#include "urdf_text.hpp"

namespace hypotrack::articulated {
namespace {

/// Converts a model of urdfdom; every message begins with the file.
class Converter {
 public:
  Converter(const urdf::ModelInterface& model, const std::filesystem::path& file, double scale)
      : model_(model), file_(file), scale_(scale) {}

  Description convert() const {
    Description out;
    for (const auto& [name, link] : model_.links_) {
      out.mechanism.links.push_back(name);
      for (std::size_t i = 0; i < link->visual_array.size(); ++i) {
        Visual visual =
            visual_of(*link->visual_array[i], fmt::format("link '{}', visual {}", name, i + 1));
        visual.link = out.mechanism.links.size() - 1;
        out.visuals.push_back(std::move(visual));
      }
    }
    for (const auto& [name, joint] : model_.joints_) out.mechanism.joints.push_back(of(*joint));
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw DataError(fmt::format("{}: {}: {}", file_.string(), where, what));
  }

  double finite(double number, const std::string& where, std::string_view what) const {
    if (!std::isfinite(number))
      fail(where, fmt::format("its {} is {}, expected a finite number", what, number));
    return number;
  }

  Eigen::Vector3d vector(const urdf::Vector3& v, const std::string& where,
                         std::string_view what) const {
    return {finite(v.x, where, what), finite(v.y, where, what), finite(v.z, where, what)};
  }

  Eigen::Isometry3d pose(const urdf::Pose& from, const std::string& where) const {
    Eigen::Isometry3d out(Eigen::Translation3d(scale_ * vector(from.position, where, "origin")));
    Eigen::Quaterniond q;
    from.rotation.getQuaternion(q.x(), q.y(), q.z(), q.w());
    if (!(q.norm() > 0.5)) fail(where, "its origin has a rotation that is not finite");
    return out.rotate(q.normalized());
  }

  JointKind kind_of(const urdf::Joint& joint, const std::string& where) const {
    switch (joint.type) {
      case urdf::Joint::FIXED:
        return JointKind::fixed;
      case urdf::Joint::REVOLUTE:
        return JointKind::revolute;
      case urdf::Joint::CONTINUOUS:
        return JointKind::continuous;
      case urdf::Joint::PRISMATIC:
        return JointKind::prismatic;
      default:
        fail(where,
             fmt::format("its type is {}, expected revolute, continuous, prismatic or fixed; write "
                         "it as several of these with links without a visual between them",
                         joint.type == urdf::Joint::PLANAR ? "planar" : "floating"));
    }
  }

  Joint of(const urdf::Joint& from) const {
    const std::string where = fmt::format("joint '{}'", from.name);
    Joint joint{.name = from.name, .kind = kind_of(from, where)};
    joint.parent = from.parent_link_name;
    joint.child = from.child_link_name;
    joint.parent_from_child = pose(from.parent_to_joint_origin_transform, where);
    if (joint.kind != JointKind::fixed) joint.axis = vector(from.axis, where, "axis");
    if (from.limits && joint.kind != JointKind::continuous) {
      joint.lower = unit(joint.kind) * finite(from.limits->lower, where, "lower limit");
      joint.upper = unit(joint.kind) * finite(from.limits->upper, where, "upper limit");
    }
    if (from.mimic) joint.mimic = mimic(*from.mimic, joint.kind);
    return joint;
  }

  /// Returns the factor on the values of joints: the scale if they slide.
  double unit(JointKind kind) const { return kind == JointKind::prismatic ? scale_ : 1; }

  Mimic mimic(const urdf::JointMimic& from, JointKind kind) const {
    const auto leader = model_.joints_.find(from.joint_name);
    const bool slides =
        leader != model_.joints_.end() && leader->second->type == urdf::Joint::PRISMATIC;
    return {from.joint_name, from.multiplier * unit(kind) / (slides ? scale_ : 1),
            from.offset * unit(kind)};
  }

  /// Returns the folder of a ROS package: one of its name that holds the URDF file, or lies beside
  /// such a folder. Throws `DataError` if there is none.
  std::filesystem::path package(const std::string& name, const std::string& where) const {
    for (std::filesystem::path above = std::filesystem::absolute(file_).parent_path();;
         above = above.parent_path()) {
      if (above.filename() == name) return above;
      if (std::error_code none; std::filesystem::is_directory(above / name, none))
        return above / name;
      if (above == above.root_path()) break;
    }
    fail(where, fmt::format("found no folder '{0}' for 'package://{0}' beside the URDF file or "
                            "above it; put the package there, or write a path relative to the file",
                            name));
  }

  /// Returns the path of a file that the URDF file names.
  std::filesystem::path path_of(const std::string& name, const std::string& where) const {
    constexpr std::string_view kFile = "file://", kPackage = "package://";
    if (name.empty()) fail(where, "it names a file without a name");
    if (name.find("$(") != name.npos || name.find("${") != name.npos)
      fail(where, fmt::format("found '{}', which is for xacro: write the URDF that `xacro` makes "
                              "of the file",
                              name));
    if (name.starts_with(kFile)) return name.substr(kFile.size());
    if (name.starts_with(kPackage)) {
      const std::size_t slash = name.find('/', kPackage.size());
      if (slash == std::string::npos || slash == kPackage.size())
        fail(where, fmt::format("found '{}', expected package://NAME/FILE", name));
      return package(name.substr(kPackage.size(), slash - kPackage.size()), where) /
             name.substr(std::min(name.find_first_not_of('/', slash), name.size()));
    }
    if (name.find("://") != std::string::npos)
      fail(where, fmt::format("found '{}', expected a path relative to the URDF file, "
                              "package://NAME/FILE or file://FILE",
                              name));
    return file_.parent_path() / name;
  }

  double length(double number, const std::string& where, std::string_view what) const {
    if (!(number > 0) || !std::isfinite(number))
      fail(where, fmt::format("its {} is {} m, expected more than 0", what, number));
    return scale_ * number;
  }

  void set_shape(const urdf::Geometry& geometry, Visual& visual) const {
    switch (geometry.type) {
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
        visual.kind = ShapeKind::box;
        visual.size = {length(size.x, visual.name, "size"), length(size.y, visual.name, "size"),
                       length(size.z, visual.name, "size")};
        return;
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        visual.kind = ShapeKind::cylinder;
        visual.size = {length(cylinder.radius, visual.name, "radius"),
                       length(cylinder.length, visual.name, "length"), 1};
        return;
      }
      case urdf::Geometry::SPHERE:
        visual.kind = ShapeKind::sphere;
        visual.size[0] =
            length(static_cast<const urdf::Sphere&>(geometry).radius, visual.name, "radius");
        return;
      case urdf::Geometry::MESH:
        break;
      default:  // of newer versions of urdfdom
        fail(visual.name,
             "its geometry is no box, cylinder, sphere or mesh; make a capsule of a "
             "cylinder and two spheres, in a <visual> each, or of a mesh");
    }
    const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
    visual.kind = ShapeKind::mesh;
    visual.size = scale_ * vector(mesh.scale, visual.name, "scale");
    if (visual.size.prod() == 0) fail(visual.name, "its scale has a 0, which leaves nothing");
    visual.mesh = path_of(mesh.filename, visual.name);
  }

  Visual visual_of(const urdf::Visual& from, const std::string& name) const {
    Visual visual{.name = name};
    visual.link_from_visual = pose(from.origin, name);
    if (!from.geometry) fail(name, "it has no geometry; give a box, cylinder, sphere or mesh");
    set_shape(*from.geometry, visual);
    if (!from.material) return visual;
    const urdf::Color& color = from.material->color;
    visual.color = Eigen::Vector3f(color.r, color.g, color.b).cwiseMax(0.0f).cwiseMin(1.0f);
    if (!from.material->texture_filename.empty())
      visual.texture = path_of(from.material->texture_filename, name);
    return visual;
  }

  const urdf::ModelInterface& model_;
  const std::filesystem::path& file_;
  double scale_;
};

}  // namespace

Description read_urdf(const std::filesystem::path& file, double scale) {
  std::vector<std::string> notes;
  const urdf::ModelInterfaceSharedPtr model = parse_urdf(file, notes);
  Description out = Converter(*model, file, scale).convert();
  out.notes = std::move(notes);
  return out;
}

}  // namespace hypotrack::articulated
