#include "probes.hpp"

#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "probe_terms.hpp"

namespace hypotrack::test {
namespace {

float depth_at(const DepthTile& tile, int x, int y) {
  return tile.inverse_depth[y * tile.stride + x];
}

/// The sum of pixel(x, y, inverse depth) over what a hypothesis covers in all views.
template <class Pixel>
double sum_covered(const RenderedHypothesis& hypothesis, const Pixel& pixel) {
  double sum = 0;
  for (const DepthTile& tile : hypothesis.views) {
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        const float w = depth_at(tile, x, y);
        if (w > 0) sum += pixel(x, y, w);
      }
    }
  }
  return sum;
}

class CoveredProbe final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    return sum_covered(hypothesis,
                       [](int x, int y, float w) { return 1 + x * 0.002 + y * 0.003 + w * 0.25; });
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return covered_probe_on_device();
  }
};

class MarkProbe final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    return sum_covered(hypothesis, [](int x, int y, float w) {
      const PixelMark mark = mark_of_pixel(x, y, w);
      return mark.first + kSecondMark * mark.second;
    });
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return mark_probe_on_device();
  }
};

class EdgeProbe final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    int sum = 0;
    for (const DepthTile& tile : hypothesis.views) {
      for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x + 1 < tile.width; ++x) {
          sum += (depth_at(tile, x, y) > 0) != (depth_at(tile, x + 1, y) > 0) ? 1 : 0;
        }
      }
    }
    return sum;
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return edge_probe_on_device();
  }
};

class SeenProbe final : public Objective {
 public:
  explicit SeenProbe(bool uncovered) : uncovered_(uncovered) {}

 private:
  void do_prepare(const Observation& observation) override {
    rectified_ = observation.rectified;
    maps_[0] = stereo_map(observation, 0, 1);
    maps_[1] = stereo_map(observation, 1, 0);
  }
  double do_cost(const RenderedHypothesis& h) const override {
    return one_way(h.views[0], h.views[1], maps_[0]) + one_way(h.views[1], h.views[0], maps_[1]);
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return seen_probe_on_device(uncovered_);
  }

  double one_way(const DepthTile& here, const DepthTile& there, const StereoMap& map) const {
    double sum = 0;
    for (int y = 0; y < here.height; ++y) {
      for (int x = 0; x < here.width; ++x) {
        const float w = depth_at(here, x, y);
        sum += w > 0 ? covered(x, y, w, there, map) : uncovered_ ? 0.01 : 0;
      }
    }
    return sum;
  }
  double covered(int x, int y, float w, const DepthTile& there, const StereoMap& map) const {
    return rectified_ ? covered<true>(x, y, w, there, map) : covered<false>(x, y, w, there, map);
  }
  template <bool kRectified>
  static double covered(int x, int y, float w, const DepthTile& there, const StereoMap& map) {
    const auto m =
        scalar::map_pixel<kRectified, float>(map, static_cast<float>(x), static_cast<float>(y), w);
    if (!scalar::lands_inside<kRectified>(map, m)) return 0.5;
    const int column = static_cast<int>(std::nearbyint(m.u));
    const int row = kRectified ? y : static_cast<int>(std::nearbyint(m.v));
    if (!scalar::same_depth(m.inverse_depth, depth_at(there, column, row), kProbeTolerance)) {
      return 0.5;
    }
    return 1 + m.u * 0.002 + column * 0.001 + row * 0.0015;
  }

  bool uncovered_;
  bool rectified_ = false;
  StereoMap maps_[2]{};
};

}  // namespace

std::shared_ptr<Objective> mark_probe() { return std::make_shared<MarkProbe>(); }
std::shared_ptr<Objective> covered_probe() { return std::make_shared<CoveredProbe>(); }
std::shared_ptr<Objective> edge_probe() { return std::make_shared<EdgeProbe>(); }
std::shared_ptr<Objective> seen_probe(bool uncovered) {
  return std::make_shared<SeenProbe>(uncovered);
}

}  // namespace hypotrack::test
