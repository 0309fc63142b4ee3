#include "drawn_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack::contract {
namespace {

constexpr int kSize = 64;
constexpr int kStride = 80;
constexpr double kBaseline = 0.12;
constexpr double kDistance = 0.5;

Eigen::VectorXd rest_in_front(const Scene& scene) {
  Eigen::VectorXd state = scene.rest_state();
  for (const Scene::Item& item : scene.items()) {
    state.segment<3>(item.offset) = Eigen::Vector3d(0, 0, kDistance);
  }
  return state;
}

cv::Mat noise_image(std::uint64_t seed, int shift) {
  cv::RNG random(seed);
  cv::Mat wide(kSize, 2 * kSize, CV_8UC3);
  random.fill(wide, cv::RNG::UNIFORM, 0, 256);
  return wide.colRange(shift, shift + kSize).clone();
}

/// Makes two cameras side by side, with tiles around the scene; `toe_in` turns the right one
/// (radians).
Observation make_pair(const Scene& scene, double toe_in) {
  Observation observation;
  observation.scene = &scene;
  observation.start = rest_in_front(scene);
  observation.rectified = toe_in == 0;
  for (int i = 0; i < 2; ++i) {
    TileView view;
    view.camera = {.width = kSize,
                   .height = kSize,
                   .fx = 150,
                   .fy = 150,
                   .cx = kSize / 2.0,
                   .cy = kSize / 2.0,
                   .camera_from_world = Eigen::Isometry3d::Identity()};
    if (i == 1) {
      const Eigen::AngleAxisd turn(toe_in, Eigen::Vector3d::UnitY());
      view.camera.camera_from_world = turn * Eigen::Translation3d(-kBaseline, 0, 0);
      const Eigen::Vector3d center =
          view.camera.camera_from_world * Eigen::Vector3d(0, 0, kDistance);
      view.camera.cx -= 150 * center.x() / center.z();
    }
    view.color = noise_image(1, 4 * i);
    view.valid = cv::Mat(kSize, kSize, CV_8UC1, cv::Scalar(255));
    observation.views.push_back(view);
  }
  return observation;
}

Observation with_masks(Observation observation) {
  for (TileView& view : observation.views) {
    view.mask = cv::Mat::zeros(kSize, kSize, CV_8UC1);
    view.mask(cv::Rect(16, 16, 32, 32)).setTo(255);
  }
  return observation;
}

Observation with_flat_colors(Observation observation, double level) {
  for (TileView& view : observation.views) view.color.setTo(cv::Scalar::all(level));
  return observation;
}

Observation without_valid_pixels(Observation observation) {
  for (TileView& view : observation.views) view.valid.setTo(0);
  return with_flat_colors(std::move(observation), 0);
}

/// Returns pixel x, y and inverse depth of every vertex.
Eigen::Matrix3Xd project_all(const TileCamera& camera, const Eigen::Matrix3Xd& vertices) {
  Eigen::Matrix3Xd pixels(3, vertices.cols());
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    const Eigen::Vector3d p = camera.camera_from_world * Eigen::Vector3d(vertices.col(i));
    pixels.col(i) << camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy,
        1 / p.z();
  }
  return pixels;
}

void draw_triangle(DrawnTiles& tiles, int view, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (std::min({a.z(), b.z(), c.z()}) <= 0 || area == 0) return;
  const auto from = [](double v) { return std::clamp(static_cast<int>(std::ceil(v)), 0, kSize); };
  const int x0 = from(std::min({a.x(), b.x(), c.x()}));
  const int x1 = from(std::max({a.x(), b.x(), c.x()}) + 1);
  const int y0 = from(std::min({a.y(), b.y(), c.y()}));
  const int y1 = from(std::max({a.y(), b.y(), c.y()}) + 1);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const double wb = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area;
      const double wc = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area;
      if (wb < 0 || wc < 0 || wb + wc > 1) continue;
      const double inverse_depth = (1 - wb - wc) * a.z() + wb * b.z() + wc * c.z();
      float& pixel = tiles.at(view, x, y);
      pixel = std::max(pixel, static_cast<float>(inverse_depth));
    }
  }
}

DrawnTiles draw(const Scene& scene, const Observation& observation, const Eigen::VectorXd& state) {
  DrawnTiles tiles(observation.views);
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xd vertices =
        posed_vertices(*item.model, scene.part(item, state)).cast<double>();
    const Eigen::Matrix3Xi& triangles = item.model->data().mesh.triangles;
    for (std::size_t view = 0; view < observation.views.size(); ++view) {
      const Eigen::Matrix3Xd pixels = project_all(observation.views[view].camera, vertices);
      for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        draw_triangle(tiles, static_cast<int>(view), pixels.col(triangles(0, t)),
                      pixels.col(triangles(1, t)), pixels.col(triangles(2, t)));
      }
    }
  }
  tiles.finish();
  return tiles;
}

/// Fills tiles by a function of view, x and y.
template <class Function>
DrawnTiles fill(const Observation& observation, const Function& inverse_depth) {
  DrawnTiles tiles(observation.views);
  for (int view = 0; view < static_cast<int>(observation.views.size()); ++view) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) tiles.at(view, x, y) = inverse_depth(view, x, y);
    }
  }
  tiles.finish();
  return tiles;
}

/// Returns the depth of the scene at rest in front of a wall, with holes as sensors leave them.
cv::Mat measured_depth(const DepthTile& drawn, int view) {
  cv::Mat depth(kSize, kSize, CV_32F);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float inverse = drawn.inverse_depth[y * drawn.stride + x];
      const bool hole = (x + 3 * y + view) % 11 == 0;
      depth.at<float>(y, x) = hole ? 0 : inverse > 0 ? 1 / inverse : 0.8f;
    }
  }
  return depth;
}

Observation with_depth(Observation observation) {
  const DrawnTiles drawn = draw(*observation.scene, observation, rest_in_front(*observation.scene));
  for (int i = 0; i < static_cast<int>(observation.views.size()); ++i) {
    observation.views[i].depth = measured_depth(drawn.tiles()[i], i);
  }
  return observation;
}

Observation without_colors(Observation observation) {
  for (TileView& view : observation.views) view.color.release();
  return observation;
}

Observation with_unmeasured_depth(Observation observation) {
  for (TileView& view : observation.views) view.depth = cv::Mat::zeros(kSize, kSize, CV_32F);
  return observation;
}

Observation with_depth_noise(Observation observation) {
  cv::RNG random(2);
  for (TileView& view : observation.views) {
    view.depth.create(kSize, kSize, CV_32F);
    random.fill(view.depth, cv::RNG::UNIFORM, -20, 20);
    cv::exp(view.depth, view.depth);
  }
  return observation;
}

}  // namespace

DrawnTiles::DrawnTiles(const std::vector<TileView>& views) {
  for (const TileView& view : views) {
    memory_.emplace_back(static_cast<std::size_t>(kStride) * view.camera.height, 0.0f);
    tiles_.push_back({.width = view.camera.width,
                      .height = view.camera.height,
                      .stride = kStride,
                      .inverse_depth = memory_.back().data()});
  }
}

float& DrawnTiles::at(int view, int x, int y) {
  return memory_[view][static_cast<std::size_t>(y) * kStride + x];
}

const std::vector<DepthTile>& DrawnTiles::finish() {
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    DepthTile& tile = tiles_[i];
    tile.x0 = tile.width;
    tile.y0 = tile.height;
    tile.x1 = tile.y1 = 0;
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        if (at(static_cast<int>(i), x, y) == 0) continue;
        tile.x0 = std::min(tile.x0, x);
        tile.x1 = std::max(tile.x1, x + 1);
        tile.y0 = std::min(tile.y0, y);
        tile.y1 = std::max(tile.y1, y + 1);
      }
    }
    if (tile.x1 == 0) tile.x0 = tile.y0 = 0;
  }
  return tiles_;
}

std::vector<NamedObservation> make_observations(const Scene& scene) {
  const Observation pair = make_pair(scene, 0);
  Observation single = pair;
  single.views.resize(1);
  single.rectified = false;
  const auto copied = [](Observation observation) {  // deep copy of the images
    for (TileView& view : observation.views) {
      view.color = view.color.clone();
      view.valid = view.valid.clone();
    }
    return observation;
  };
  return {
      {"a rectified pair", pair},
      {"a rectified pair with masks", with_masks(copied(pair))},
      {"a pair that is not rectified", make_pair(scene, 0.2)},
      {"a single view", single},
      {"a black pair", with_flat_colors(copied(pair), 0)},
      {"a white pair with masks", with_masks(with_flat_colors(copied(pair), 255))},
      {"a pair without valid pixels", without_valid_pixels(copied(pair))},
      {"a single view with depth", with_depth(single)},
      {"a single view with depth and no colour", without_colors(with_depth(single))},
      {"a pair with depth and masks", with_depth(with_masks(copied(pair)))},
      {"a pair that is not rectified, with depth", with_depth(make_pair(scene, 0.2))},
      {"a single view with no depth measured", with_unmeasured_depth(single)},
      {"a pair with depth that is noise", with_depth_noise(pair)},
  };
}

std::vector<NamedHypothesis> make_hypotheses(const Scene& scene, const Observation& observation) {
  std::vector<NamedHypothesis> hypotheses;
  const Eigen::VectorXd rest = rest_in_front(scene);
  const auto add_state = [&](const char* name, const Eigen::VectorXd& state) {
    hypotheses.push_back({name, state, draw(scene, observation, state), true});
  };
  const auto add = [&](const char* name, DrawnTiles tiles) {
    hypotheses.push_back({name, rest, std::move(tiles), false});
  };
  std::mt19937_64 random(3);
  add_state("the scene at rest", rest);
  for (int i = 0; i < 4; ++i) {
    Eigen::VectorXd state = test::random_state(scene, random, {0, 0, kDistance}, 0.05);
    scene.normalize(state);
    add_state("the scene in a random state", state);
  }
  add("nothing covered", fill(observation, [](int, int, int) { return 0.0f; }));
  add("only the last view covered", fill(observation, [&](int view, int, int) {
        return view + 1 == static_cast<int>(observation.views.size()) ? 2.0f : 0.0f;
      }));
  add("everything covered", fill(observation, [](int, int, int) { return 2.0f; }));
  std::uniform_real_distribution<float> exponent(-20, 20);
  add("depth that is noise", fill(observation, [&](int, int x, int) {
        return x % 5 == 0 ? 0.0f : std::pow(10.0f, exponent(random));
      }));
  return hypotheses;
}

}  // namespace hypotrack::contract
