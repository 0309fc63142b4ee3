// An objective that scores as stereo_color does and draws what it sees of one frame.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "distinctiveness.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "stereo_color.hpp"

namespace {

using namespace hypotrack;

cv::Mat depth_of(const DepthTile& tile) {
  cv::Mat depth(tile.height, tile.width, CV_32F, cv::Scalar(0));
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      depth.at<float>(y, x) = tile.inverse_depth[y * tile.stride + x];
  return depth;
}

/// Draws inverse depths from dark (far) to bright (near) in colours; white where nothing is drawn.
cv::Mat depth_picture(const cv::Mat& inverse_depth) {
  const cv::Mat covered = inverse_depth > 0;
  double low = 0, high = 0;
  cv::minMaxLoc(inverse_depth, &low, &high, nullptr, nullptr, covered);
  cv::Mat bytes, colors, out(inverse_depth.size(), CV_8UC3, cv::Scalar::all(255));
  inverse_depth.convertTo(bytes, CV_8U, 255 / (high - low), -255 * low / (high - low));
  cv::applyColorMap(bytes, colors, cv::COLORMAP_VIRIDIS);
  colors.copyTo(out, covered);
  return out;
}

cv::Mat distinctiveness_picture(const TileView& view) {
  cv::Mat grey;
  cv::cvtColor(view.color, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F, 1 / 255.0);
  const std::vector<float> values(grey.begin<float>(), grey.end<float>());
  const std::vector<std::uint8_t> valid(view.valid.begin<std::uint8_t>(),
                                        view.valid.end<std::uint8_t>());
  const auto curvatures = stereo_color::principal_curvatures(values, valid, grey.cols, grey.rows);
  std::vector<float> weights =
      stereo_color::distinctiveness(curvatures, valid, stereo_color::Params{}.w_t);
  cv::Mat out;
  cv::Mat(grey.rows, grey.cols, CV_32F, weights.data()).convertTo(out, CV_8U, 255);
  return out;
}

/// Draws the colour difference of each covered pixel of the left tile from the right tile's pixel
/// that shows the same surface point: black where they agree, white where nothing is drawn.
cv::Mat difference_picture(const Observation& frame, const cv::Mat& left, const cv::Mat& right) {
  const StereoMap map = stereo_map(frame, 0, 1);
  cv::Mat out(left.size(), CV_8UC3, cv::Scalar::all(255));
  for (int y = 0; y < left.rows; ++y) {
    for (int x = 0; x < left.cols; ++x) {
      const float w = left.at<float>(y, x);
      if (w == 0) continue;
      float p[3];
      for (int i = 0; i < 3; ++i)
        p[i] = map.a[i][0] * static_cast<float>(x) + map.a[i][1] * static_cast<float>(y) +
               map.a[i][2] + map.b[i] * w;
      const cv::Point there(cvRound(p[0] / p[2]), cvRound(p[1] / p[2]));
      const bool inside = cv::Rect(0, 0, right.cols, right.rows).contains(there);
      if (!inside || std::abs(1 / w - 1 / right.at<float>(there)) > 0.02f) {
        out.at<cv::Vec3b>(y, x) = {200, 160, 60};  // only one view sees it
        continue;
      }
      cv::Vec3b difference;
      cv::absdiff(frame.views[0].color.at<cv::Vec3b>(y, x),
                  frame.views[1].color.at<cv::Vec3b>(there), difference);
      const double gain = 4;
      for (int c = 0; c < 3; ++c)
        out.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(gain * difference[c]);
    }
  }
  return out;
}

class Pictures : public Objective {
  static constexpr int kPoor = 10;  // evaluation that shows a poor hypothesis

 public:
  struct Params {
    std::filesystem::path folder;
    int frame = 20;
    int generation = 64;
    void visit(ParamVisitor& v) {
      v("folder", folder, {.help = "folder for the pictures"});
      v("frame", frame, {.help = "frame to draw", .min = 0});
      v("generation", generation, {.help = "evaluations in a generation of the search", .min = 1});
    }
  };

  explicit Pictures(const Params& params) : params_(params), scored_(stereo_color::Params{}) {}
  ~Pictures() override = default;

 private:
  ImageUse do_image_use() const override { return scored_.image_use(); }

  void do_prepare(const Observation& observation) override {
    if (seen_.frame == params_.frame && observation.frame != seen_.frame && !best_.empty()) write();
    seen_ = observation;
    for (TileView& view : seen_.views) view.color = view.color.clone();
    generations_.clear();
    best_.clear();
    poor_.clear();
    scored_.prepare(observation);
  }

  double do_cost(const RenderedHypothesis& hypothesis) const override {
    const double cost = scored_.cost(hypothesis);
    if (seen_.frame == params_.frame) record(hypothesis, cost);
    return cost;
  }

  void record(const RenderedHypothesis& hypothesis, double cost) const {
    if (generations_.empty() || evaluations_ == params_.generation) {
      generations_.emplace_back();
      evaluations_ = 0;
    }
    ++evaluations_;
    const cv::Mat left = depth_of(hypothesis.views[0]);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(cv::Mat(left > 0), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    for (auto& outline : outlines) generations_.back().push_back(std::move(outline));
    const std::vector<cv::Mat> depths = {left, depth_of(hypothesis.views[1])};
    if (generations_.size() == 1 && evaluations_ == kPoor) poor_ = depths;
    if (best_.empty() || cost < best_cost_) {
      best_ = depths;
      best_cost_ = cost;
    }
  }

  cv::Mat swarm_picture(std::size_t generation) const {
    cv::Mat out = seen_.views[0].color.clone();
    const cv::Mat below = out.clone();
    const std::size_t count = std::min<std::size_t>(generations_[generation].size(), 40);
    for (std::size_t i = 0; i < count; ++i)
      cv::polylines(out, generations_[generation][i], true, {90, 220, 40});
    cv::addWeighted(out, 0.6, below, 0.4, 0, out);
    return out;
  }

  void write() const {
    std::filesystem::create_directories(params_.folder);
    const auto save = [&](const char* name, const cv::Mat& picture) {
      cv::imwrite((params_.folder / (std::string(name) + ".webp")).string(), picture,
                  {cv::IMWRITE_WEBP_QUALITY, 85});
    };
    save("tile_left", seen_.views[0].color);
    save("tile_right", seen_.views[1].color);
    save("distinctiveness", distinctiveness_picture(seen_.views[0]));
    save("depth", depth_picture(best_[0]));
    save("differences_poor", difference_picture(seen_, poor_[0], poor_[1]));
    save("differences_best", difference_picture(seen_, best_[0], best_[1]));
    save("swarm_first", swarm_picture(0));
    save("swarm_last", swarm_picture(generations_.size() - 1));
  }

  Params params_;
  stereo_color::StereoColor scored_;
  Observation seen_;
  mutable std::vector<std::vector<std::vector<cv::Point>>> generations_;  // outlines
  mutable int evaluations_ = 0;
  mutable std::vector<cv::Mat> best_;  // inverse depth of both views
  mutable std::vector<cv::Mat> poor_;  // that of one hypothesis of the first generation
  mutable double best_cost_ = 0;
};

}  // namespace

HYPOTRACK_PLUGIN(Pictures, "scores as stereo_color does and draws one frame", "")
