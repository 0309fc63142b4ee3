// A source of plain pictures that keeps its contract except for a fault, named by a parameter.
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
namespace {

enum class Fault {
  none,
  bad_camera,
  no_cameras,
  no_frame_rate,
  endless_frame_rate,
  one_view_too_few,
  wrong_size,
  silent_gap,
  time_stands_still,
  truth_of_another_scene,
  landmarks_of_another_scene,
  draws_over_old_frames,
  never_the_same,
  ends_late,
  gives_nothing,
};
constexpr std::array<std::string_view, 15> kFaults = {"none",
                                                      "bad_camera",
                                                      "no_cameras",
                                                      "no_frame_rate",
                                                      "endless_frame_rate",
                                                      "one_view_too_few",
                                                      "wrong_size",
                                                      "silent_gap",
                                                      "time_stands_still",
                                                      "truth_of_another_scene",
                                                      "landmarks_of_another_scene",
                                                      "draws_over_old_frames",
                                                      "never_the_same",
                                                      "ends_late",
                                                      "gives_nothing"};
std::span<const std::string_view> enum_names(Fault) { return kFaults; }

class Broken final : public Source {
 public:
  struct Params {
    Fault fault = Fault::none;
    int frames = 0;
    void visit(ParamVisitor& v) {
      v("fault", fault, {.help = "what is wrong with it"});
      v("frames", frames, {.help = "how many", .min = 1, .max = 100, .required = true});
    }
  };
  explicit Broken(const Params& params) : params_(params), number_(++objects_) {
    Camera camera;
    camera.width = 40;
    camera.height = 30;
    camera.fx = camera.fy = 50;
    camera.cx = 20;
    camera.cy = 15;
    if (has(Fault::bad_camera)) camera.fx = std::nan("");
    if (!has(Fault::no_cameras)) cameras_ = {camera, camera};
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override {
    if (has(Fault::endless_frame_rate)) return std::numeric_limits<double>::infinity();
    return has(Fault::no_frame_rate) ? 0 : 25;
  }
  std::optional<int> do_frame_count() const override { return params_.frames; }

  std::optional<Frame> do_next() override {
    const int extra = has(Fault::ends_late) ? 1 : 0;
    if (next_ >= params_.frames + extra || has(Fault::gives_nothing)) return std::nullopt;
    Frame frame;
    frame.index = next_++;
    frame.time = has(Fault::time_stands_still) ? 0 : frame.index / 25.0;
    if (frame.index == 2) {  // a missing frame
      if (!has(Fault::silent_gap)) frame.problem = "the picture is missing";
      return frame;
    }
    const cv::Size size(has(Fault::wrong_size) ? 41 : 40, 30);
    const int level = 10 * frame.index + (has(Fault::never_the_same) ? number_ : 0);
    for (int i = 0; i < (has(Fault::one_view_too_few) ? 1 : 2); ++i) {
      cv::Mat image =
          has(Fault::draws_over_old_frames) && !canvas_.empty() ? canvas_ : cv::Mat(size, CV_8UC3);
      image.setTo(cv::Scalar::all(level));
      canvas_ = image;
      frame.views.push_back({.color = image, .mask = {}});
    }
    if (has(Fault::truth_of_another_scene)) {
      frame.truth = GroundTruth{.state = Eigen::VectorXd::Zero(5), .landmarks = {}};
    }
    if (has(Fault::landmarks_of_another_scene)) {
      frame.truth = GroundTruth{.state = {}, .landmarks = Eigen::Matrix3Xd::Zero(3, 2)};
    }
    return frame;
  }

  bool has(Fault fault) const { return params_.fault == fault; }

  static inline std::atomic<int> objects_ = 0;
  Params params_;
  int number_;
  int next_ = 0;
  std::vector<Camera> cameras_;
  cv::Mat canvas_;
};

}  // namespace
}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Broken, "breaks the contract as asked", "")
