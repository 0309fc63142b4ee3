#include <fmt/format.h>

#include <array>
#include <map>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "rigging.hpp"

namespace hypotrack {
namespace {

/// A corner of a triangle: its vertex and its texture coordinate (-1 without texture).
struct Corner {
  int vertex = 0;
  int uv = -1;
};
using Triangle = std::array<Corner, 3>;

class Cutter {
 public:
  Cutter(const Mesh& mesh, float limit) : mesh_(mesh), limit_(limit) {
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
      vertices_.push_back(mesh.vertices.col(i));
      indices_.push_back(mesh.bone_indices.col(i));
      weights_.push_back(mesh.bone_weights.col(i));
    }
    for (Eigen::Index i = 0; i < mesh.uv.cols(); ++i) uvs_.push_back(mesh.uv.col(i));
  }

  Mesh run() {
    for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) clip(triangle(t));
    close_holes();
    return compact();
  }

 private:
  Triangle triangle(Eigen::Index t) const {
    Triangle corners;
    for (int k = 0; k < 3; ++k) {
      corners[static_cast<std::size_t>(k)] = {
          mesh_.triangles(k, t), mesh_.uv_triangles.cols() > 0 ? mesh_.uv_triangles(k, t) : -1};
    }
    return corners;
  }
  bool keeps(const Corner& corner) const {
    return vertices_[static_cast<std::size_t>(corner.vertex)].y() >= limit_;
  }

  /// Clips one triangle by the algorithm of Sutherland and Hodgman, then splits it into a fan.
  void clip(const Triangle& corners) {
    std::vector<Corner> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& here = corners[k];
      const Corner& next = corners[(k + 1) % 3];
      if (keeps(here)) polygon.push_back(here);
      if (keeps(here) != keeps(next)) {
        polygon.push_back(keeps(here) ? cut_edge(here, next) : cut_edge(next, here));
      }
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      triangles_.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
    if (polygon.size() < 3) return;
    // The cut edge runs from the corner where the surface leaves the plane to where it returns.
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corner& here = polygon[k];
      const Corner& next = polygon[(k + 1) % polygon.size()];
      if (is_new(here) && is_new(next)) rim_.emplace(next.vertex, here);
    }
  }

  bool is_new(const Corner& corner) const { return corner.vertex >= mesh_.vertices.cols(); }

  Corner cut_edge(const Corner& kept, const Corner& lost) {
    const Eigen::Vector3f a = vertices_[static_cast<std::size_t>(kept.vertex)];
    const Eigen::Vector3f b = vertices_[static_cast<std::size_t>(lost.vertex)];
    const float t = (a.y() - limit_) / (a.y() - b.y());
    const auto [vertex, fresh] =
        cuts_.emplace(std::pair(kept.vertex, lost.vertex), static_cast<int>(vertices_.size()));
    if (fresh) {
      Eigen::Vector3f p = a + t * (b - a);
      p.y() = limit_;
      vertices_.push_back(p);
      indices_.push_back(Eigen::Vector4i(indices_[static_cast<std::size_t>(kept.vertex)]));
      weights_.push_back(Eigen::Vector4f(weights_[static_cast<std::size_t>(kept.vertex)]));
    }
    Corner corner{vertex->second, -1};
    if (kept.uv >= 0) {
      const auto [uv, fresh_uv] =
          uv_cuts_.emplace(std::pair(kept.uv, lost.uv), static_cast<int>(uvs_.size()));
      if (fresh_uv) {
        const Eigen::Vector2f from = uvs_[static_cast<std::size_t>(kept.uv)];
        uvs_.push_back(from + t * (uvs_[static_cast<std::size_t>(lost.uv)] - from));
      }
      corner.uv = uv->second;
    }
    return corner;
  }

  /// Closes every loop of the rim by a fan about its mean.
  void close_holes() {
    while (!rim_.empty()) {
      std::vector<Corner> loop;
      for (auto entry = rim_.begin(); entry != rim_.end();) {
        loop.push_back(entry->second);
        const int next = entry->second.vertex;
        rim_.erase(entry);
        entry = rim_.find(next);
      }
      if (loop.size() < 3) continue;
      const Corner centre = mean(loop);
      for (std::size_t k = 0; k < loop.size(); ++k) {
        triangles_.push_back({centre, loop[k], loop[(k + 1) % loop.size()]});
      }
    }
  }

  Corner mean(const std::vector<Corner>& loop) {
    Eigen::Vector3f p = Eigen::Vector3f::Zero();
    for (const Corner& corner : loop) p += vertices_[static_cast<std::size_t>(corner.vertex)];
    const auto first = static_cast<std::size_t>(loop.front().vertex);
    vertices_.push_back(p / static_cast<float>(loop.size()));
    indices_.push_back(Eigen::Vector4i(indices_[first]));
    weights_.push_back(Eigen::Vector4f(weights_[first]));
    // The cap has the colour of one point of the rim, as the texture has no inside.
    return {static_cast<int>(vertices_.size()) - 1, loop.front().uv};
  }

  Mesh compact() const {
    Mesh out;
    out.texture = mesh_.texture;
    out.color = mesh_.color;
    std::vector<int> vertex(vertices_.size(), -1);
    std::vector<int> uv(uvs_.size(), -1);
    std::vector<std::size_t> used_vertices;
    std::vector<std::size_t> used_uvs;
    const auto use = [](std::vector<int>& index, std::vector<std::size_t>& used, int which) {
      const auto i = static_cast<std::size_t>(which);
      if (index[i] < 0) {
        index[i] = static_cast<int>(used.size());
        used.push_back(i);
      }
      return index[i];
    };
    const auto count = static_cast<Eigen::Index>(triangles_.size());
    out.triangles.resize(3, count);
    out.uv_triangles.resize(3, uvs_.empty() ? 0 : count);
    for (Eigen::Index t = 0; t < count; ++t) {
      for (int k = 0; k < 3; ++k) {
        const Corner& corner = triangles_[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
        out.triangles(k, t) = use(vertex, used_vertices, corner.vertex);
        if (!uvs_.empty()) out.uv_triangles(k, t) = use(uv, used_uvs, corner.uv);
      }
    }
    const auto size = static_cast<Eigen::Index>(used_vertices.size());
    out.vertices.resize(3, size);
    out.bone_indices.resize(4, size);
    out.bone_weights.resize(4, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const std::size_t from = used_vertices[static_cast<std::size_t>(i)];
      out.vertices.col(i) = vertices_[from];
      out.bone_indices.col(i) = indices_[from];
      out.bone_weights.col(i) = weights_[from];
    }
    out.uv.resize(2, static_cast<Eigen::Index>(used_uvs.size()));
    for (std::size_t i = 0; i < used_uvs.size(); ++i) {
      out.uv.col(static_cast<Eigen::Index>(i)) = uvs_[used_uvs[i]];
    }
    return out;
  }

  const Mesh& mesh_;
  float limit_;
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<Eigen::Vector4i> indices_;
  std::vector<Eigen::Vector4f> weights_;
  std::vector<Eigen::Vector2f> uvs_;
  std::vector<Triangle> triangles_;
  std::map<std::pair<int, int>, int> cuts_;
  std::map<std::pair<int, int>, int> uv_cuts_;
  std::map<int, Corner> rim_;  // from a vertex of the rim to the next, in the direction of the cap
};

}  // namespace

void cut_below(Mesh& mesh, double limit, const std::string& where) {
  Mesh cut = Cutter(mesh, static_cast<float>(limit)).run();
  if (cut.triangles.cols() == 0) {
    throw DataError(
        fmt::format("{}: cutting the arm {} mm proximal of the origin leaves nothing of "
                    "the hand",
                    where, -limit * 1e3));
  }
  mesh = std::move(cut);
}

}  // namespace hypotrack
