#include "network.hpp"

#include <fmt/format.h>

#include <opencv2/dnn/shape_utils.hpp>

#include "hypotrack/error.hpp"
#include "hypotrack/stop.hpp"

namespace hypotrack::hands {
namespace {

constexpr const char* kRemedy = "run scripts/get_hand_detector.sh";

[[noreturn]] void fail_damaged(const std::filesystem::path& file, const std::string& reason) {
  throw DataError(fmt::format("{}: the hand detector's network is damaged ({}); {}", file.string(),
                              reason, kRemedy));
}

/// Returns the first line of what OpenCV says.
std::string reason_of(const cv::Exception& error) {
  const std::string text = error.err.empty() ? error.what() : error.err;
  return text.substr(0, text.find('\n'));
}

}  // namespace

Network::Network(const std::filesystem::path& file, int side, std::vector<NetworkOutput> outputs)
    : file_(file), side_(side), outputs_(std::move(outputs)) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw DataError(
        fmt::format("{}: the hand detector needs this file; {}", file.string(), kRemedy));
  }
  try {
    net_ = cv::dnn::readNetFromONNX(file.string());
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    check_shapes();
  } catch (const cv::Exception& error) {
    fail_damaged(file, reason_of(error));
  }
}

void Network::check_shapes() {
  for (const NetworkOutput& output : outputs_) {
    const int layer = net_.getLayerId(output.name);
    if (layer < 0) fail_damaged(file_, "it has no output " + output.name);
    std::vector<cv::dnn::MatShape> in, out;
    net_.getLayerShapes(cv::dnn::MatShape{1, 3, side_, side_}, layer, in, out);
    if (out.size() != 1 || cv::dnn::total(out[0]) != static_cast<int>(output.size)) {
      fail_damaged(file_, "its output " + output.name + " has another size");
    }
  }
}

std::vector<std::vector<float>> Network::run(const cv::Mat& picture) {
  check_stop();
  std::vector<cv::String> names;
  for (const NetworkOutput& output : outputs_) names.push_back(output.name);
  std::vector<cv::Mat> blobs;
  try {
    net_.setInput(cv::dnn::blobFromImage(picture, 1 / 255.0, {}, {}, true));
    net_.forward(blobs, names);
  } catch (const cv::Exception& error) {
    fail_damaged(file_, reason_of(error));
  }
  std::vector<std::vector<float>> out;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (blobs[i].type() != CV_32F || blobs[i].total() != outputs_[i].size) {
      fail_damaged(file_, "its output " + outputs_[i].name + " has another size");
    }
    const float* values = blobs[i].ptr<float>();
    out.emplace_back(values, values + blobs[i].total());
  }
  return out;
}

}  // namespace hypotrack::hands
