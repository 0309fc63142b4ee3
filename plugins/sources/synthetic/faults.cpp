#include "faults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/error.hpp"

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

/// Throws ConfigError if a key that has a value belongs to another kind.
void check_use(const FaultParams& fault, const ConfigNode& item, const char* key, bool has_value,
               FaultKind kind) {
  if (fault.kind == kind || !has_value) return;
  const auto name = [](FaultKind k) { return enum_names(k)[static_cast<std::size_t>(k)]; };
  throw ConfigError(fmt::format("{}: `{}` belongs to the kind {}; leave it out of the kind {}",
                                item.get(key).where(), key, name(kind), name(fault.kind)));
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

View copy_of(const View& view) {
  return {view.color.clone(), view.mask.clone(), view.depth.clone()};
}

}  // namespace

Faults::Faults(const std::vector<FaultParams>& params, const ConfigNode& node, const Scene& scene,
               const std::vector<Camera>& cameras)
    : models_(scene.items().size()) {
  for (std::size_t i = 0; i < params.size(); ++i) {
    const ConfigNode item = node.at(i);
    check_frames(params[i], item);
    check_use(params[i], item, "model", !params[i].model.empty(), FaultKind::absent);
    check_use(params[i], item, "view", params[i].view.has_value(), FaultKind::frozen);
    Fault fault{static_cast<int>(params[i].frames[0]),
                static_cast<int>(params[i].frames[1]),
                params[i].kind,
                {},
                {}};
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
  faults_.push_back({first, last, FaultKind::absent, {}, {}});
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

void Faults::apply(int frame, std::vector<View>& views) {
  const int next = next_delivered(frame + 1);
  kept_.resize(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (holds(FaultKind::frozen, frame, v)) {
      views[v] = copy_of(kept_[v]);
    } else if (holds(FaultKind::frozen, next, v)) {
      kept_[v] = copy_of(views[v]);
    }
  }
  if (holds(FaultKind::exchanged, frame)) std::swap(views[0], views[1]);
  if (!holds(FaultKind::black, frame)) return;
  for (View& view : views)
    for (cv::Mat* image : {&view.color, &view.mask, &view.depth})
      if (!image->empty()) image->setTo(0);
}

}  // namespace hypotrack::synthetic
