#include <fmt/format.h>

#include <map>
#include <utility>

#include "hypotrack/api/mesh_io.hpp"
#include "model/import/looks/looks.hpp"
#include "model/import/looks/patches.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Makes one texture of all pictures, colours and painted triangles of a file.
class Painter {
 public:
  Painter(const MeshFile& file, const Looks& looks, const std::vector<int>& kept)
      : file_(file),
        looks_(looks),
        kept_(kept),
        linear_(file.scene.linear_colors != 0),
        patch_of_(kept.size(), Look::kNone) {
    place_triangles();
  }

  void fill(Mesh& mesh, std::vector<std::string>& notes) {
    for (auto& [key, layer] : layers_) add_window(key, layer, notes);
    add_plain_parts();
    patches_ = paint(patched_, linear_);
    for (const cv::Mat3b& sheet : patches_.sheets) places_of_sheets_.push_back(add(sheet));
    if (alone()) {
      mesh.texture = *pictures_.front();
    } else {
      mesh.texture = atlas_.texture(file_.path.string());
    }
    set_uvs(corners(), mesh);
  }

 private:
  /// A picture as plain or as painted parts use it.
  struct Layer {
    Eigen::Array2f low = Eigen::Array2f::Zero(), high = Eigen::Array2f::Ones();  // of its plane
    PictureWindow window{};
    std::size_t place = 0;               // in the atlas
    std::vector<std::size_t> painted{};  // indices of kept triangles
    bool is_patched = false;             // its painted triangles are patches
  };
  using Key = std::pair<std::size_t, bool>;  // a picture, and whether parts are painted

  static Key key_of(const Look& look) { return {look.picture, look.painted}; }

  /// Moves the triangles near their pictures.
  void place_triangles() {
    constexpr float kMostRepetitions = 128;  // of a picture, either way
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const Look& look = looks_.of(kept_[i]);
      UvCorners uv = UvCorners::Constant(0.5f);
      if (look.picture != Look::kNone) {
        uv = looks_.pictures()[look.picture].near_picture(looks_.corners_of(kept_[i]));
        uv = uv.cwiseMax(-kMostRepetitions).cwiseMin(kMostRepetitions);
        Layer& layer = layers_[key_of(look)];
        layer.low = layer.low.min(uv.rowwise().minCoeff().array());
        layer.high = layer.high.max(uv.rowwise().maxCoeff().array());
        if (look.painted) layer.painted.push_back(i);
      } else if (look.painted) {
        add_patch(i, uv);
      }
      uv_.push_back(uv);
    }
  }

  PaintedTriangle painted(std::size_t kept, const UvCorners& uv) const {
    const int triangle = kept_[kept];
    const std::size_t picture = looks_.of(triangle).picture;
    return {
        {looks_.color_of(triangle, 0), looks_.color_of(triangle, 1), looks_.color_of(triangle, 2)},
        picture == Look::kNone ? nullptr : &looks_.pictures()[picture],
        uv};
  }

  void add_patch(std::size_t kept, const UvCorners& uv) {
    patch_of_[kept] = patched_.size();
    patched_.push_back(painted(kept, uv));
  }

  /// Adds the window of a layer to the atlas, painted over if it can be; otherwise its triangles
  /// are patches.
  void add_window(const Key& key, Layer& layer, std::vector<std::string>& notes) {
    const WrappedPicture& picture = looks_.pictures()[key.first];
    layer.window = picture.window(layer.low, layer.high);
    std::vector<PaintedTriangle> over;
    for (const std::size_t i : layer.painted)
      over.push_back(painted(i, layer.window.moved(uv_[i])));
    layer.is_patched = key.second && !paint_over(over, linear_, layer.window.pixels);
    if (layer.is_patched) {
      for (const std::size_t i : layer.painted) add_patch(i, uv_[i]);
      return;
    }
    layer.place = add(layer.window.pixels);
    constexpr double kVisible = 0.75;
    if (const double shrink = layer.window.shrink; shrink < kVisible)
      notes.push_back(
          fmt::format("a texture of {} x {} pixels goes on over {:.0f} times its size: "
                      "drawn {:.1f} times smaller",
                      picture.image().cols, picture.image().rows,
                      (layer.high - layer.low).maxCoeff(), 1 / shrink));
  }

  std::size_t add(const cv::Mat3b& picture) {
    pictures_.push_back(&picture);
    return atlas_.add(picture);
  }

  /// Adds the colours of the parts that have one colour.
  void add_plain_parts() {
    for (const auto& [part, count] : looks_.parts()) {
      const Look& look = looks_.of_part(part);
      if (look.picture == Look::kNone && !look.painted)
        places_of_parts_[part] = atlas_.add(look.color);
    }
  }

  /// Returns true if there is one picture, which is the texture.
  bool alone() const { return pictures_.size() == 1 && places_of_parts_.empty(); }

  std::vector<UvCorners> corners() const {
    std::vector<UvCorners> out;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const Look& look = looks_.of(kept_[i]);
      UvCorners uv = uv_[i];
      std::size_t place = 0;
      if (const std::size_t patch = patch_of_[i]; patch != Look::kNone) {
        uv = patches_.corners(patch);
        place = places_of_sheets_[patches_.places[patch].sheet];
      } else if (look.picture != Look::kNone) {
        const Layer& layer = layers_.at(key_of(look));
        uv = layer.window.moved(uv);
        place = layer.place;
      } else {
        place = places_of_parts_.at(looks_.part_of(kept_[i]));
      }
      out.push_back(alone() ? uv : UvCorners(atlas_.moved(place, uv)));
    }
    return out;
  }

  const MeshFile& file_;
  const Looks& looks_;
  const std::vector<int>& kept_;
  bool linear_;
  std::vector<UvCorners> uv_;  // by kept triangle, near its picture
  std::map<Key, Layer> layers_;
  std::vector<PaintedTriangle> patched_;
  std::vector<std::size_t> patch_of_;  // by kept triangle; Look::kNone: no patch
  Patches patches_;
  TextureAtlas atlas_;
  std::vector<const cv::Mat3b*> pictures_;  // in the atlas
  std::map<std::size_t, std::size_t> places_of_parts_;
  std::vector<std::size_t> places_of_sheets_;
};

}  // namespace

void fill_appearance(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
                     Mesh& mesh, std::vector<std::string>& notes) {
  const Looks looks(file, soup, kept, notes);
  mesh.color = looks.color_of_most();
  if (looks.are_one_color()) {
    mesh.uv.resize(2, 0);
    mesh.uv_triangles.resize(3, 0);
    return;
  }
  Painter(file, looks, kept).fill(mesh, notes);
}

}  // namespace hypotrack::internal
