#include "gl/egl_context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "base/numbers.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::gl::internal {
namespace {

constexpr int kVersionNeeded = 33;  // 3.3 in epoxy's notation

/// A candidate for an EGL display; it may not work.
struct Candidate {
  std::string name;
  EGLenum platform = 0;
  void* native = nullptr;  // device, or the default display of the platform
  int rank = 0;
};

struct Made {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string device;
  std::string problem;  // why there is no context, otherwise empty
};

std::atomic<int> preferred_gpu = -1;  // -1: any

/// Returns the number of the GPU that is to draw; -1: any.
int wanted_gpu() {
  const char* const named = std::getenv("HYPOTRACK_GL_GPU");
  if (!named) return preferred_gpu;
  const auto number = detail::parse_integer(named);
  if (!number || *number < 0 || *number > std::numeric_limits<int>::max())
    throw DeviceError(fmt::format(
        "HYPOTRACK_GL_GPU is '{}'; expected the number of the GPU that is to draw, as 0", named));
  return static_cast<int>(*number);
}

bool has_word(const char* words, std::string_view word) {
  std::string_view rest = words ? words : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == word) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string egl_error() {
  const EGLint code = eglGetError();
  switch (code) {
    case EGL_SUCCESS:
      return "no error reported";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST:
      return "EGL_CONTEXT_LOST";
    default:
      return fmt::format("EGL error 0x{:04x}", code);
  }
}

void add_devices(const char* client_extensions, std::vector<Candidate>& candidates) {
  const bool enumerates = has_word(client_extensions, "EGL_EXT_device_enumeration") ||
                          has_word(client_extensions, "EGL_EXT_device_base");
  if (!enumerates || !has_word(client_extensions, "EGL_EXT_platform_device")) return;
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  const int wanted = wanted_gpu();
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return;
  for (EGLint i = 0; i < count; ++i) {
    const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    int rank = 1;
    if (has_word(extensions, "EGL_NV_device_cuda")) {
      EGLAttrib number = -1;
      const bool told = eglQueryDeviceAttribEXT(devices[i], EGL_CUDA_DEVICE_NV, &number);
      rank = told && number == wanted ? -1 : 0;
    }
    if (has_word(extensions, "EGL_MESA_device_software")) rank = 2;
    candidates.push_back(
        {fmt::format("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[i], rank});
  }
}

std::vector<Candidate> find_candidates() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<Candidate> candidates;
  if (!has_word(extensions, "EGL_EXT_platform_base")) return candidates;
  add_devices(extensions, candidates);
  if (has_word(extensions, "EGL_MESA_platform_surfaceless")) {
    candidates.push_back(
        {"Mesa surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, 3});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
  return candidates;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "unknown";
}

EGLContext create_context(EGLDisplay display) {
  const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                            kVersionNeeded / 10,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            kVersionNeeded % 10,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                            EGL_NONE};
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

Made try_candidate(const Candidate& candidate) {
  Made made;
  made.display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
  EGLint major = 0, minor = 0;
  if (made.display == EGL_NO_DISPLAY || !eglInitialize(made.display, &major, &minor)) {
    made.problem = "cannot be initialised: " + egl_error();
    return made;
  }
  const char* extensions = eglQueryString(made.display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
    if (!has_word(extensions, needed)) {
      made.problem = fmt::format("lacks {}", needed);
      return made;
    }
  }
  if (major == 1 && minor < 5 && !has_word(extensions, "EGL_KHR_create_context")) {
    made.problem = "lacks EGL_KHR_create_context";
    return made;
  }
  if (!eglBindAPI(EGL_OPENGL_API)) {
    made.problem = "has no desktop OpenGL: " + egl_error();
    return made;
  }
  made.context = create_context(made.display);
  if (made.context == EGL_NO_CONTEXT) {
    made.problem = "gives no OpenGL 3.3 core context: " + egl_error();
    return made;
  }
  if (!eglMakeCurrent(made.display, EGL_NO_SURFACE, EGL_NO_SURFACE, made.context)) {
    made.problem = "its context cannot be made current: " + egl_error();
  } else {
    made.device = fmt::format("{}, {}, OpenGL {}", gl_string(GL_VENDOR), gl_string(GL_RENDERER),
                              gl_string(GL_VERSION));
    if (epoxy_gl_version() < kVersionNeeded) made.problem = "is too old: " + made.device;
  }
  if (!made.problem.empty()) eglDestroyContext(made.display, made.context);
  return made;
}

/// Restores what the thread had current before contexts were tried.
class KeepCurrent {
 public:
  KeepCurrent()
      : api_(eglQueryAPI()),
        display_(eglGetCurrentDisplay()),
        context_(eglGetCurrentContext()),
        draw_(eglGetCurrentSurface(EGL_DRAW)),
        read_(eglGetCurrentSurface(EGL_READ)) {}
  ~KeepCurrent() {
    const EGLDisplay tried = eglGetCurrentDisplay();
    if (tried != EGL_NO_DISPLAY) {
      eglMakeCurrent(tried, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglBindAPI(api_);
    if (context_ != EGL_NO_CONTEXT) eglMakeCurrent(display_, draw_, read_, context_);
  }
  KeepCurrent(const KeepCurrent&) = delete;
  KeepCurrent& operator=(const KeepCurrent&) = delete;

 private:
  EGLenum api_;
  EGLDisplay display_;
  EGLContext context_;
  EGLSurface draw_;
  EGLSurface read_;
};

}  // namespace

Context::Context() {
  const std::string advice =
      "install a driver with EGL: Mesa's software rasteriser is in the package libegl-mesa0, "
      "NVIDIA's driver brings its own";
  if (!epoxy_has_egl()) {
    throw DeviceError("no OpenGL context: libEGL.so.1 cannot be opened; " + advice);
  }
  expect_driver_threads();
  const KeepCurrent keep;
  std::string tried;
  for (const Candidate& candidate : find_candidates()) {
    Made made = try_candidate(candidate);
    if (made.problem.empty()) {
      display_ = made.display;
      context_ = made.context;
      device_ = std::move(made.device);
      return;
    }
    tried += fmt::format("\n  {}: {}", candidate.name, made.problem);
  }
  if (tried.empty()) {
    tried = "\n  EGL offers neither the device nor the surfaceless platform";
  }
  throw DeviceError(
      fmt::format("no OpenGL 3.3 context without a window; tried:{}\n{}", tried, advice));
}

void prefer_gpu(int number) { preferred_gpu = number; }

Context::~Context() { eglDestroyContext(display_, context_); }

CurrentContext::CurrentContext(const Context& context)
    : display_(context.display_),
      former_api_(eglQueryAPI()),
      former_display_(eglGetCurrentDisplay()),
      former_context_(eglGetCurrentContext()),
      former_draw_(eglGetCurrentSurface(EGL_DRAW)),
      former_read_(eglGetCurrentSurface(EGL_READ)) {
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_)) {
    const std::string reason = egl_error();
    eglBindAPI(former_api_);
    throw DeviceError(fmt::format(
        "the OpenGL context of {} cannot be made current in this thread ({}); it may be in use by "
        "another thread: use one renderer per thread",
        context.device_, reason));
  }
}

CurrentContext::~CurrentContext() {
  if (former_context_ == EGL_NO_CONTEXT || former_display_ != display_) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglBindAPI(former_api_);
  if (former_context_ != EGL_NO_CONTEXT) {
    eglMakeCurrent(former_display_, former_draw_, former_read_, former_context_);
  }
}

}  // namespace hypotrack::gl::internal
