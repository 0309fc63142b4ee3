#include "viewing/preview_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "viewing/preview.hpp"
#include "viewing/view_drawing.hpp"

namespace hypotrack {
namespace {

cv::Scalar paper() { return {32, 32, 32}; }
cv::Scalar ink() { return {235, 235, 235}; }
cv::Scalar faint() { return {150, 150, 150}; }
cv::Scalar yellow() { return {60, 210, 255}; }
cv::Scalar red() { return {80, 80, 255}; }

cv::Scalar color_of(Status status) {
  switch (status) {
    case Status::tracked:
      return {110, 220, 110};
    case Status::uncertain:
      return yellow();
    case Status::lost:
      return red();
    case Status::absent:
    case Status::missing:
      return faint();
  }
  return faint();
}

/// Returns the height of a line of text in a window.
int line_height(int width) { return cvRound(std::clamp(width / 50.0, 18.0, 30.0)); }

/// Returns the height of the text: a line for the run, one for each model, one for messages.
int text_height(int width, std::size_t models) {
  return line_height(width) * (static_cast<int>(models) + 2) + line_height(width) / 2;
}

/// Writes lines of text and bars on a picture.
class Sheet {
 public:
  Sheet(cv::Mat& picture, int line) : picture_(picture), line_(line) {}

  /// Writes text that begins at `x`, smaller if it is wider than `width`. Returns where it ends.
  int write(int x, int y, std::string_view words, int width, const cv::Scalar& color) {
    const double font = 0.026 * line_;
    const std::string text(words);
    int base = 0;
    const int length = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font, 1, &base).width;
    const double fits = std::min(1.0, std::max(1, width) / std::max(1.0, 1.0 * length));
    cv::putText(picture_, text, {x, y + cvRound(0.72 * line_)}, cv::FONT_HERSHEY_SIMPLEX,
                font * fits, color, 1, cv::LINE_AA);
    return x + std::min(width, length);
  }

  /// Draws a bar of which a share from 0 to 1 is filled.
  void bar(int x, int y, int width, double share, const cv::Scalar& color) {
    const cv::Rect whole(x, y + line_ / 4, width, line_ / 2);
    const int filled = cvRound(std::clamp(share, 0.0, 1.0) * width);
    cv::rectangle(picture_, whole, {64, 64, 64}, cv::FILLED);
    if (filled > 0)
      cv::rectangle(picture_, cv::Rect(whole.tl(), cv::Size(filled, whole.height)), color,
                    cv::FILLED);
  }

  void dot(int x, int y, const cv::Scalar& color) {
    cv::circle(picture_, {x, y + line_ / 2}, line_ / 4, color, cv::FILLED, cv::LINE_AA);
  }

 private:
  cv::Mat& picture_;
  int line_;
};

/// Says in one line how far the run is.
std::string summary_of(const PreviewText& text) {
  if (!text.newest) return "waiting for the first frame";
  const LiveFrame& now = *text.newest;
  std::string out = fmt::format("frame {}", now.solution.frame);
  if (text.frames) out += fmt::format(" of {}", *text.frames);
  out += fmt::format("   {:.2f} s   {}", now.solution.time, to_string(now.solution.status));
  if (!std::isnan(now.fps)) out += fmt::format("   {:.1f} fps", now.fps);
  out += fmt::format("   {:.0f} ms", 1000 * now.solution.seconds);
  if (!std::isnan(now.error)) out += fmt::format("   error {:.1f} mm", 1000 * now.error);
  return out;
}

/// Writes a model's status, probability and sigma into a line.
void write_model(Sheet& sheet, int y, int width, int line, const PreviewText& text, std::size_t m) {
  constexpr double kLargestSigma = 0.02;  // metres, of a full bar
  const auto at = [&](double share) { return cvRound(share * width); };
  const int bar = at(0.12), gap = line / 2;
  const auto number = [&](double begin, const char* name, double value, double share,
                          const std::string& words, const cv::Scalar& color) {
    const int x = sheet.write(at(begin), y, name, at(0.1), faint()) + gap;
    if (std::isnan(value)) {
      sheet.write(x, y, "unknown", at(0.1), faint());
      return;
    }
    sheet.bar(x, y, bar, share, color);
    sheet.write(x + bar + gap, y, words, at(0.1), ink());
  };
  sheet.write(line + 4, y, text.models[m], at(0.18) - line, ink());
  if (!text.newest) return;
  const LiveFrame& now = *text.newest;
  const Status status = now.solution.models[m];
  const cv::Scalar color = color_of(status);
  sheet.dot(line / 2 + 2, y, color);
  sheet.write(at(0.2), y, to_string(status), at(0.11), color);
  const double probability =
      now.solution.probabilities.empty() ? std::nan("") : now.solution.probabilities[m];
  number(0.32, "probability", probability, probability, fmt::format("{:.2f}", probability), color);
  const double sigma = now.sigmas[m];
  number(0.66, "sigma", sigma, sigma / kLargestSigma, fmt::format("{:.1f} mm", 1000 * sigma),
         color);
}

void write_help(cv::Mat& picture, int line) {
  const auto& help = preview_key_help();
  const int rows = static_cast<int>(help.size());
  const cv::Size size(std::min(picture.cols, 26 * line), std::min(picture.rows, (rows + 1) * line));
  const cv::Rect box((picture.size() - size) / 2, size);
  cv::Mat part = picture(box);
  cv::addWeighted(part, 0.15, cv::Mat(size, CV_8UC3, paper()), 0.85, 0, part);
  Sheet sheet(part, line);
  for (int i = 0; i < rows; ++i) {
    const int y = line / 2 + i * line;
    sheet.write(line, y, help[static_cast<std::size_t>(i)].keys, 5 * line, yellow());
    sheet.write(6 * line, y, help[static_cast<std::size_t>(i)].text, size.width - 7 * line, ink());
  }
}

}  // namespace

cv::Size preview_size(const std::vector<Camera>& cameras, std::size_t models, cv::Size screen) {
  constexpr double kWidth = 0.92, kHeight = 0.85;  // of the screen: it has panels, windows frames
  constexpr int kLeast = 960, kMost = 1800;
  int width = 0;
  for (const Camera& camera : cameras) width += camera.width;
  width = std::min(std::clamp(width, kLeast, kMost), cvRound(kWidth * screen.width));
  const auto height_for = [&](int wide) {
    int highest = 0;
    for (const Camera& camera : preview_cameras(cameras, models, {wide, screen.height * 10}))
      highest = std::max(highest, camera.height);
    return highest + text_height(wide, models);
  };
  const int most = cvRound(kHeight * screen.height);
  while (height_for(width) > most && width > kLeast / 2) width -= 8;
  return {width, std::min(height_for(width), most)};
}

std::vector<Camera> preview_cameras(const std::vector<Camera>& cameras, std::size_t models,
                                    cv::Size area) {
  const cv::Size each(std::max(1, area.width / static_cast<int>(cameras.size())),
                      std::max(1, area.height - text_height(area.width, models)));
  std::vector<Camera> out;
  for (const Camera& camera : cameras) out.push_back(fitted(camera, each));
  return out;
}

cv::Mat preview_picture(const std::vector<cv::Mat>& views, const PreviewText& text, cv::Size area) {
  const int line = line_height(area.width), height = text_height(area.width, text.models.size());
  cv::Mat picture(area, CV_8UC3, paper());
  const int top = std::max(0, area.height - height);
  if (!views.empty()) {
    const cv::Mat row = joined(views, ViewLayout::row);
    const cv::Size size(std::min(row.cols, area.width), std::min(row.rows, top));
    row(cv::Rect({}, size))
        .copyTo(picture(cv::Rect({(area.width - size.width) / 2, (top - size.height) / 2}, size)));
  }
  Sheet sheet(picture, line);
  int y = top + line / 4;
  const int state = cvRound(0.82 * area.width);
  sheet.write(line / 4, y, summary_of(text), state - line, ink());
  const std::string recorded =
      text.status.recorded ? fmt::format("REC {}", *text.status.recorded) : "";
  const int space = area.width - state - line / 2;
  if (text.status.paused) sheet.write(state, y, "PAUSED", space / 2 - line / 4, yellow());
  if (!recorded.empty()) sheet.write(state + space / 2, y, recorded, space / 2, red());
  for (std::size_t m = 0; m < text.models.size(); ++m)
    write_model(sheet, y += line, area.width, line, text, m);
  const std::string keys =
      "space: pause   n: step   r: look again   s: snapshot   v: record   h: help   q: end";
  sheet.write(line / 4, y + line, text.message.empty() ? keys : text.message, area.width - line / 2,
              text.message.empty() ? faint() : yellow());
  if (text.help) write_help(picture, line);
  return picture;
}

}  // namespace hypotrack
