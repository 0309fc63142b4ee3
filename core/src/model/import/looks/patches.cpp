#include "model/import/looks/patches.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "model/import/srgb.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kSheetSide = 2048;         // pixels; an atlas would shrink larger ones
constexpr double kMostPixels = 4 << 20;  // of all patches together
constexpr int kLargestPatch = 512;       // pixels along a side

/// Returns the largest difference between the corners, in a channel.
int spread(const PaintedTriangle& triangle) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [low, high] =
        std::minmax({triangle.colors[0][c], triangle.colors[1][c], triangle.colors[2][c]});
    largest = std::max(largest, high - low);
  }
  return largest;
}

/// Returns the size of a patch that has the pixels of its picture. Colours that go in light bend on
/// the screen; pixels between corners that differ much follow the bend.
cv::Size size_of(const PaintedTriangle& triangle, bool linear) {
  constexpr int kMuch = 16, kBent = 17;
  const int least = linear && spread(triangle) > kMuch ? kBent : 2;
  if (!triangle.picture) return {least, least};
  const Eigen::Array2f pixels(static_cast<float>(triangle.picture->image().cols),
                              static_cast<float>(triangle.picture->image().rows));
  const auto side = [&](int corner) {
    const Eigen::Array2f edge = (triangle.uv.col(corner) - triangle.uv.col(0)).array() * pixels;
    const float length = std::min(edge.matrix().norm(), static_cast<float>(kLargestPatch));
    return std::clamp(static_cast<int>(std::ceil(length)) + 1, least, kLargestPatch);
  };
  return {side(1), side(2)};
}

std::vector<cv::Size> sizes_of(const std::vector<PaintedTriangle>& triangles, bool linear) {
  std::vector<cv::Size> sizes;
  double pixels = 0;
  for (const PaintedTriangle& triangle : triangles) {
    sizes.push_back(size_of(triangle, linear));
    pixels += sizes.back().area();
  }
  if (pixels <= kMostPixels) return sizes;
  const double factor = std::sqrt(kMostPixels / pixels);
  for (cv::Size& size : sizes)
    size = {std::max(2, static_cast<int>(factor * size.width)),
            std::max(2, static_cast<int>(factor * size.height))};
  return sizes;
}

/// Places patches in rows, the highest first, on sheets that are about square.
std::vector<PatchPlace> places_of(const std::vector<cv::Size>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) {
    // Classes of size keep neighbours together: filters of renderers mix patches side by side.
    return std::bit_width(static_cast<unsigned>(sizes[i].height - 1));
  });
  double area = 0;
  int widest = 0;
  for (const cv::Size& size : sizes) {
    area += size.area();
    widest = std::max(widest, size.width);
  }
  const int width = std::clamp(static_cast<int>(std::ceil(std::sqrt(area))), widest, kSheetSide);
  std::vector<PatchPlace> places(sizes.size());
  std::size_t sheet = 0;
  int left = 0, top = 0, row = 0;
  for (const std::size_t i : order) {
    if (left + sizes[i].width > width) {
      left = 0;
      top += row;
      row = 0;
    }
    if (top + sizes[i].height > kSheetSide) {
      ++sheet;
      left = top = row = 0;
    }
    places[i] = {sheet, {left, top, sizes[i].width, sizes[i].height}};
    left += sizes[i].width;
    row = std::max(row, sizes[i].height);
  }
  return places;
}

/// Returns the pixel of a triangle at shares of its corners, which may lie beside it.
cv::Vec3b pixel(const PaintedTriangle& triangle, const Eigen::Vector3f& shares, bool linear) {
  const std::array<float, 256>& light = srgb::light_of_bytes();
  const Eigen::Vector3f texel =
      triangle.picture ? triangle.picture->at(triangle.uv * shares) : Eigen::Vector3f::Zero();
  cv::Vec3b bgr;
  for (std::size_t c = 0; c < 3; ++c) {
    float color = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint8_t byte = triangle.colors[k][c];
      color += shares[static_cast<Eigen::Index>(k)] *
               (linear ? light[byte] : static_cast<float>(byte) / 255);
    }
    color = std::clamp(color, 0.0f, 1.0f);
    if (triangle.picture) {
      const float of_picture = srgb::linear(texel[static_cast<Eigen::Index>(2 - c)] / 255);
      color = srgb::encoded(of_picture * (linear ? color : srgb::linear(color)));
    } else if (linear) {
      color = srgb::encoded(color);
    }
    bgr[static_cast<int>(2 - c)] = srgb::byte(color);
  }
  return bgr;
}

}  // namespace

UvCorners Patches::corners(std::size_t triangle) const {
  const PatchPlace& place = places[triangle];
  const cv::Mat3b& sheet = sheets[place.sheet];
  const auto at = [&](int x, int y) {
    return Eigen::Vector2f((static_cast<float>(x) + 0.5f) / static_cast<float>(sheet.cols),
                           1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(sheet.rows));
  };
  const cv::Rect& box = place.pixels;
  UvCorners out;
  out << at(box.x, box.y), at(box.x + box.width - 1, box.y), at(box.x, box.y + box.height - 1);
  return out;
}

Patches paint(const std::vector<PaintedTriangle>& triangles, bool linear) {
  Patches out;
  out.places = places_of(sizes_of(triangles, linear));
  std::vector<cv::Size> sheets;
  for (const PatchPlace& place : out.places) {
    sheets.resize(std::max(sheets.size(), place.sheet + 1), cv::Size(0, 0));
    cv::Size& size = sheets[place.sheet];
    size = {std::max(size.width, place.pixels.br().x), std::max(size.height, place.pixels.br().y)};
  }
  for (const cv::Size& size : sheets) out.sheets.emplace_back(size, cv::Vec3b(0, 0, 0));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    cv::Mat3b patch = out.sheets[out.places[i].sheet](out.places[i].pixels);
    for (int y = 0; y < patch.rows; ++y) {
      for (int x = 0; x < patch.cols; ++x) {
        const float along = static_cast<float>(x) / static_cast<float>(patch.cols - 1);
        const float down = static_cast<float>(y) / static_cast<float>(patch.rows - 1);
        patch(y, x) = pixel(triangles[i], {1 - along - down, along, down}, linear);
      }
    }
  }
  return out;
}

}  // namespace hypotrack::internal
