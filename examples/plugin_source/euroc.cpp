// A source: pairs of time-stamped pictures in the folder layout of the EuRoC MAV dataset.
//
//   FOLDER/cam0/sensor.yaml    intrinsics, distortion, pose on the rig
//   FOLDER/cam0/data.csv       one line per picture: time in nanoseconds, file name
//   FOLDER/cam0/data/*.png     pictures
//   FOLDER/cam1/...            the same for the second camera
#include <charconv>
#include <cstdint>
#include <fstream>
#include <hypotrack/api/image_file.hpp>
#include <hypotrack/plugin/plugin.hpp>
#include <map>

namespace {

using Pictures = std::map<std::int64_t, std::filesystem::path>;  // by time in nanoseconds

std::vector<double> numbers(const hypotrack::ConfigNode& list, std::size_t expected) {
  std::vector<double> out;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string text = list.at(i).scalar();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      throw hypotrack::ConfigError(list.where() + ": '" + text + "' is no number");
    out.push_back(value);
  }
  if (out.size() != expected)
    throw hypotrack::ConfigError(list.where() + ": " + list.path() + " has " +
                                 std::to_string(out.size()) + " numbers; expected " +
                                 std::to_string(expected));
  return out;
}

/// Reads a camera and its pose on the rig, rig_from_camera.
hypotrack::Camera read_sensor(const std::filesystem::path& file, Eigen::Isometry3d& pose) {
  const auto sensor = hypotrack::ConfigNode::load(file);
  const auto size = numbers(sensor.get("resolution"), 2);
  const auto k = numbers(sensor.get("intrinsics"), 4);
  hypotrack::Camera camera;
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  camera.fx = k[0], camera.fy = k[1], camera.cx = k[2], camera.cy = k[3];
  camera.distortion_model = hypotrack::DistortionModel::brown;
  camera.distortion = numbers(sensor.get("distortion_coefficients"), 4);
  const auto t = numbers(sensor.get("T_BS").get("data"), 16);
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(t.data());
  return camera;
}

Pictures read_list(const std::filesystem::path& folder) {
  std::ifstream csv(folder / "data.csv");
  if (!csv) throw hypotrack::DataError((folder / "data.csv").string() + ": cannot be read");
  Pictures out;
  for (std::string line; std::getline(csv, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t comma = line.find(',');
    if (line.empty() || line[0] == '#' || comma == std::string::npos) continue;
    std::int64_t time = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + comma, time);
    if (error != std::errc() || end != line.data() + comma)
      throw hypotrack::DataError((folder / "data.csv").string() + ": '" + line +
                                 "' does not begin with a time in nanoseconds");
    out[time] = folder / "data" / line.substr(comma + 1);
  }
  if (out.empty())
    throw hypotrack::DataError((folder / "data.csv").string() + ": lists no picture");
  return out;
}

}  // namespace

class Euroc final : public hypotrack::Source {
 public:
  struct Params {
    std::filesystem::path folder;
    double apart = 0.005;
    void visit(hypotrack::ParamVisitor& v) {
      v("folder", folder, {.help = "folder with cam0 and cam1", .required = true});
      v("apart_ms", apart,
        {.help = "largest time between the two pictures of a pair",
         .min = 0,
         .max = 1000,
         .unit = "ms",
         .to_si = 1e-3});
    }
  };

  explicit Euroc(const Params& p) : left_(read_list(p.folder / "cam0")), apart_(p.apart) {
    right_ = read_list(p.folder / "cam1");
    Eigen::Isometry3d rig_from_left, rig_from_right;
    cameras_.push_back(read_sensor(p.folder / "cam0" / "sensor.yaml", rig_from_left));
    cameras_.push_back(read_sensor(p.folder / "cam1" / "sensor.yaml", rig_from_right));
    cameras_[1].camera_from_world = rig_from_right.inverse() * rig_from_left;
    next_ = left_.begin();
  }

 private:
  const std::vector<hypotrack::Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override {
    const double seconds = seconds_between(left_.begin()->first, left_.rbegin()->first);
    return seconds > 0 ? static_cast<double>(left_.size() - 1) / seconds : 1;
  }
  std::optional<int> do_frame_count() const override { return static_cast<int>(left_.size()); }

  std::optional<hypotrack::Frame> do_next() override {
    if (next_ == left_.end()) return std::nullopt;
    hypotrack::Frame frame;
    frame.index = index_++;
    frame.time = seconds_between(left_.begin()->first, next_->first);
    frame.stamp = next_->first;
    const auto [time, left] = *next_++;
    // A pair that lacks a picture is a frame with a problem, not an exception.
    const auto right = nearest(time);
    if (std::abs(seconds_between(time, right->first)) > apart_) {
      frame.problem = left.string() + ": the second camera has no picture of this time";
      return frame;
    }
    for (const auto& file : {left, right->second}) {
      const auto& camera = cameras_[frame.views.size()];
      auto [image, problem] = hypotrack::read_color(file);
      if (problem.empty()) problem = hypotrack::size_problem(file, image, camera);
      if (!problem.empty()) {
        frame.views.clear();
        frame.problem = problem;
        return frame;
      }
      frame.views.push_back({.color = image});
    }
    return frame;
  }

  static double seconds_between(std::int64_t from, std::int64_t to) {
    return 1e-9 * static_cast<double>(to - from);
  }
  Pictures::const_iterator nearest(std::int64_t time) const {
    auto after = right_.lower_bound(time);
    if (after == right_.begin()) return after;
    const auto before = std::prev(after);
    return after == right_.end() || time - before->first < after->first - time ? before : after;
  }

  Pictures left_, right_;
  double apart_;
  std::vector<hypotrack::Camera> cameras_;
  Pictures::const_iterator next_;
  int index_ = 0;
};

HYPOTRACK_PLUGIN(Euroc, "time-stamped pairs in the folder layout of the EuRoC MAV dataset", "")
