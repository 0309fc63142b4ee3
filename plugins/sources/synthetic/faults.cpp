#include "faults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::synthetic {
namespace {

void check_frames(const FaultParams& fault, const ConfigNode& item) {
  const double first = fault.frames[0], last = fault.frames[1];
  if (first == std::floor(first) && last == std::floor(last) && first <= last) return;
  throw ConfigError(
      fmt::format("{}: frames are {:g} to {:g}; expected the numbers of the first "
                  "and the last frame",
                  item.get("frames").where(), first, last));
}

/// Throws ConfigError if a key that has a value belongs to other kinds.
void check_use(const FaultParams& fault, const ConfigNode& item, const char* key, bool has_value,
               std::initializer_list<FaultKind> kinds) {
  if (!has_value || std::ranges::find(kinds, fault.kind) != kinds.end()) return;
  const auto name = [](FaultKind k) { return enum_names(k)[static_cast<std::size_t>(k)]; };
  std::vector<std::string_view> names;
  for (const FaultKind kind : kinds) names.push_back(name(kind));
  throw ConfigError(fmt::format("{}: `{}` belongs to the kind {}; leave it out of the kind {}",
                                item.get(key).where(), key, fmt::join(names, ", "),
                                name(fault.kind)));
}

void check_keys(const FaultParams& fault, const ConfigNode& item) {
  using enum FaultKind;
  check_use(fault, item, "model", !fault.model.empty(), {absent});
  check_use(fault, item, "view", fault.view.has_value(), {frozen, late, misaligned, exposure});
  check_use(fault, item, "noise_sigma", fault.noise_sigma.has_value(), {frozen});
  check_use(fault, item, "by", fault.by.has_value(), {late});
  check_use(fault, item, "shift_px", fault.shift != Eigen::Vector2d(0, 0), {misaligned});
  check_use(fault, item, "roll_deg", fault.roll.has_value(), {misaligned});
  check_use(fault, item, "scale", fault.scale.has_value(), {misaligned});
  check_use(fault, item, "gain", fault.gain.has_value(), {exposure});
}

std::size_t model_of(const ConfigNode& name, const Scene& scene) {
  std::vector<std::string> known;
  for (const Scene::Item& item : scene.items()) {
    if (item.name == name.scalar()) return known.size();
    known.push_back(item.name);
  }
  throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                name.where(), name.scalar(), fmt::join(known, ", ")));
}

void check_exchange(const ConfigNode& item, const std::vector<Camera>& cameras) {
  if (cameras.size() == 2 && cameras[0].width == cameras[1].width &&
      cameras[0].height == cameras[1].height)
    return;
  throw ConfigError(item.get("kind").where() +
                    ": only two cameras with pictures of one size can be exchanged");
}

void add_noise(cv::Mat& image, double sigma, int frame, std::size_t view) {
  cv::RNG random((static_cast<std::uint64_t>(frame) + 1) * 7919 + view);
  cv::Mat noise(image.size(), CV_16SC3);
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, image, cv::noArray(), CV_8U);
}

/// Moves what a picture shows: a point is turned and scaled about `center`, then shifted.
void misalign(cv::Mat& image, const Eigen::Vector2d& center, const Eigen::Vector2d& shift,
              double roll, double scale) {
  if (image.empty()) return;
  const Eigen::Matrix2d turn = scale * Eigen::Rotation2Dd(roll).toRotationMatrix();
  const Eigen::Vector2d to = center + shift - turn * center;
  const cv::Matx23d map(turn(0, 0), turn(0, 1), to.x(), turn(1, 0), turn(1, 1), to.y());
  const int lookup = image.channels() == 3 ? cv::INTER_LINEAR : cv::INTER_NEAREST;
  cv::Mat moved;
  cv::warpAffine(image, moved, map, image.size(), lookup, cv::BORDER_REPLICATE);
  image = moved;
}

View copy_of(const View& view) {
  return {view.color.clone(), view.mask.clone(), view.depth.clone()};
}

}  // namespace

Faults::Faults(const std::vector<FaultParams>& params, const ConfigNode& node, const Scene& scene,
               const std::vector<Camera>& cameras)
    : models_(scene.items().size()), delivered_(cameras.size()) {
  for (const Camera& camera : cameras) centers_.emplace_back(camera.cx, camera.cy);
  for (std::size_t i = 0; i < params.size(); ++i) {
    const ConfigNode item = node.at(i);
    check_frames(params[i], item);
    check_keys(params[i], item);
    Fault fault{.first = static_cast<int>(params[i].frames[0]),
                .last = static_cast<int>(params[i].frames[1]),
                .kind = params[i].kind,
                .model = {},
                .view = {},
                .noise_sigma = params[i].noise_sigma.value_or(0),
                .by = params[i].by.value_or(1),
                .shift = params[i].shift,
                .roll = params[i].roll.value_or(0),
                .scale = params[i].scale.value_or(1),
                .gain = params[i].gain.value_or(1)};
    if (!params[i].model.empty()) fault.model = model_of(item.get("model"), scene);
    if (params[i].view) fault.view = static_cast<std::size_t>(*params[i].view);
    if (fault.view && *fault.view >= cameras.size())
      throw ConfigError(item.get("view").where() + ": there is one view only, 0");
    if (fault.kind == FaultKind::exchanged) check_exchange(item, cameras);
    if (fault.kind == FaultKind::frozen && fault.first == 0)
      throw ConfigError(item.get("frames").where() +
                        ": no picture comes before frame 0 that could be repeated");
    if (fault.kind == FaultKind::missing && fault.first == 0)
      throw ConfigError(item.get("frames").where() +
                        ": frame 0 cannot be missing; a recording begins with its first frame");
    faults_.push_back(fault);
  }
}

void Faults::add_absence(int first, int last) {
  faults_.push_back(
      {.first = first, .last = last, .kind = FaultKind::absent, .model = {}, .view = {}});
}

bool Faults::holds(FaultKind kind, int frame, std::size_t part) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
    const std::optional<std::size_t>& of = kind == FaultKind::absent ? fault.model : fault.view;
    return fault.kind == kind && frame >= fault.first && frame <= fault.last &&
           of.value_or(part) == part;
  });
}

int Faults::next_delivered(int frame) const {
  while (holds(FaultKind::missing, frame)) ++frame;
  return frame;
}

std::vector<bool> Faults::absent(int frame) const {
  std::vector<bool> absent;
  for (std::size_t m = 0; m < models_; ++m) absent.push_back(holds(FaultKind::absent, frame, m));
  if (std::find(absent.begin(), absent.end(), true) == absent.end()) absent.clear();
  return absent;
}

void Faults::delay(int frame, std::vector<View>& views) {
  for (const Fault& fault : faults_) {
    if (fault.kind != FaultKind::late) continue;
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (!fault.concerns(v)) continue;
      std::deque<View>& delivered = delivered_[v];
      delivered.push_back(copy_of(views[v]));
      if (std::ssize(delivered) > fault.by + 1) delivered.pop_front();
      if (frame >= fault.first && frame <= fault.last) views[v] = copy_of(delivered.front());
    }
  }
}

void Faults::freeze(int frame, std::vector<View>& views) {
  const int next = next_delivered(frame + 1);
  kept_.resize(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (holds(FaultKind::frozen, frame, v)) {
      views[v] = copy_of(kept_[v]);
    } else if (holds(FaultKind::frozen, next, v)) {
      kept_[v] = copy_of(views[v]);
    }
  }
}

void Faults::spoil(int frame, std::vector<View>& views) const {
  for (const Fault& fault : faults_) {
    if (frame < fault.first || (frame > fault.last && fault.kind != FaultKind::exposure)) continue;
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (!fault.concerns(v)) continue;
      if (fault.kind == FaultKind::frozen && fault.noise_sigma > 0)
        add_noise(views[v].color, fault.noise_sigma, frame, v);
      if (fault.kind == FaultKind::misaligned)
        for (cv::Mat* image : {&views[v].color, &views[v].mask, &views[v].depth})
          misalign(*image, centers_[v], fault.shift, fault.roll, fault.scale);
      if (fault.kind == FaultKind::exposure) {
        const double share = fault.last > fault.first ? static_cast<double>(frame - fault.first) /
                                                            (fault.last - fault.first)
                                                      : 1.0;
        const double gain = 1 + std::min(share, 1.0) * (fault.gain - 1);
        views[v].color.convertTo(views[v].color, -1, gain);
      }
    }
  }
}

void Faults::apply(int frame, std::vector<View>& views) {
  delay(frame, views);
  freeze(frame, views);
  spoil(frame, views);
  if (holds(FaultKind::exchanged, frame)) std::swap(views[0], views[1]);
  if (!holds(FaultKind::black, frame)) return;
  for (View& view : views)
    for (cv::Mat* image : {&view.color, &view.mask, &view.depth})
      if (!image->empty()) image->setTo(0);
}

}  // namespace hypotrack::synthetic
