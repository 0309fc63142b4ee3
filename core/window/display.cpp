#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "hypotrack/api/error.hpp"
#include "window/window.hpp"

namespace hypotrack {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

/// The X display of DISPLAY, by the library of X, which is loaded only here.
class XDisplay {
 public:
  XDisplay() : library_(dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL)) {
    const auto open = function<void* (*)(const char*)>("XOpenDisplay");
    if (open) display_ = open(nullptr);
  }
  ~XDisplay() {
    const auto close = function<int (*)(void*)>("XCloseDisplay");
    if (display_ && close) close(display_);
  }
  XDisplay(const XDisplay&) = delete;
  XDisplay& operator=(const XDisplay&) = delete;

  /// Returns false if the display surely cannot be reached.
  bool may_be_there() const { return !library_ || display_; }

  cv::Size size() const {
    const auto width = function<int (*)(void*, int)>("XDisplayWidth");
    const auto height = function<int (*)(void*, int)>("XDisplayHeight");
    if (!display_ || !width || !height) return {};
    return {width(display_, 0), height(display_, 0)};
  }

 private:
  template <class F>
  F function(const char* name) const {
    return library_ ? reinterpret_cast<F>(dlsym(library_, name)) : nullptr;
  }

  void* library_;
  void* display_ = nullptr;
};

}  // namespace

void check_display(const std::string& instead) {
  if (is_set("WAYLAND_DISPLAY") || is_set("QT_QPA_PLATFORM")) return;
  const bool has_display = is_set("DISPLAY");
  // Qt would abort the program.
  if (has_display && XDisplay().may_be_there()) return;
  const std::string what =
      has_display ? fmt::format("the display {} cannot be reached", std::getenv("DISPLAY"))
                  : "neither DISPLAY nor WAYLAND_DISPLAY is set";
  throw DeviceError(fmt::format(
      "there is no display for the window: {}; run this where there is one, or {}", what, instead));
}

cv::Size screen_size() {
  const cv::Size kSmall(1280, 720);
  const cv::Size size = is_set("DISPLAY") ? XDisplay().size() : cv::Size();
  return size.empty() ? kSmall : size;
}

}  // namespace hypotrack
