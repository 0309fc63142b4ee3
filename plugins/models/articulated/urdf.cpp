#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "description.hpp"
#include "hypotrack/error.hpp"
#include "urdf_text.hpp"

namespace hypotrack::articulated {
namespace {

/// Converts a model of urdfdom; every message begins with the file.
class Converter {
 public:
  Converter(const urdf::ModelInterface& model, const std::filesystem::path& file)
      : model_(model), file_(file) {}

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
    Eigen::Isometry3d out(Eigen::Translation3d(vector(from.position, where, "origin")));
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
      joint.lower = finite(from.limits->lower, where, "lower limit");
      joint.upper = finite(from.limits->upper, where, "upper limit");
    }
    if (from.mimic)
      joint.mimic = Mimic{from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    return joint;
  }

  /// Returns the path of a file that the URDF file names.
  std::filesystem::path path_of(const std::string& name, const std::string& where) const {
    constexpr std::string_view kFile = "file://";
    if (name.empty()) fail(where, "it names a file without a name");
    if (name.starts_with(kFile)) return name.substr(kFile.size());
    if (name.find("://") != std::string::npos)
      fail(where, fmt::format("ROS looks up '{}' in its packages, hypotrack does not: write the "
                              "path from the folder of the URDF file to that file",
                              name));
    return file_.parent_path() / name;
  }

  double length(double number, const std::string& where, std::string_view what) const {
    if (!(number > 0) || !std::isfinite(number))
      fail(where, fmt::format("its {} is {} m, expected more than 0", what, number));
    return number;
  }

  void set_shape(const urdf::Geometry& geometry, Visual& visual) const {
    switch (geometry.type) {
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
        for (const double edge : {size.x, size.y, size.z}) length(edge, visual.name, "size");
        visual.kind = ShapeKind::box;
        visual.size = {size.x, size.y, size.z};
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
    }
    const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
    visual.kind = ShapeKind::mesh;
    visual.size = vector(mesh.scale, visual.name, "scale");
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
};

}  // namespace

Description read_urdf(const std::filesystem::path& file) {
  return Converter(*parse_urdf(file), file).convert();
}

}  // namespace hypotrack::articulated
