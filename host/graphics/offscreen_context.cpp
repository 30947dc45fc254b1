#include <array>
#include <utility>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include "host/api/log.h"
#include "host/graphics/context.h"
#include "host/graphics/context_debug.h"

namespace meridian::graphics {

namespace {

constexpr std::string_view driverRemedy =
    "install a driver with OpenGL 4.5 (Debian: libgl1-mesa-dri), or try LIBGL_ALWAYS_SOFTWARE=1";

std::string eglErrorName(EGLint code) {
  using Entry = std::pair<EGLint, const char*>;
  static constexpr std::array<Entry, 14> names{{{EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
                                                {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
                                                {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
                                                {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
                                                {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
                                                {EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},
                                                {EGL_BAD_CURRENT_SURFACE, "EGL_BAD_CURRENT_SURFACE"},
                                                {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
                                                {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
                                                {EGL_BAD_NATIVE_PIXMAP, "EGL_BAD_NATIVE_PIXMAP"},
                                                {EGL_BAD_NATIVE_WINDOW, "EGL_BAD_NATIVE_WINDOW"},
                                                {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
                                                {EGL_BAD_SURFACE, "EGL_BAD_SURFACE"},
                                                {EGL_CONTEXT_LOST, "EGL_CONTEXT_LOST"}}};
  for (const auto& [value, name] : names) {
    if (value == code) {
      return name;
    }
  }
  return fmt::format("EGL error 0x{:04x}", code);
}

bool hasWord(const char* list, std::string_view word) {
  const std::string padded = fmt::format(" {} ", list != nullptr ? list : "");
  return padded.find(fmt::format(" {} ", word)) != std::string::npos;
}

struct NamedDisplay {
  EGLDisplay display = EGL_NO_DISPLAY;
  const char* platform = "";
};

/// The displays to try, best first. EGL gives the same display for the same question, so they are never terminated:
/// that would pull it from under every other context of the process.
std::vector<NamedDisplay> displays() {
  std::vector<NamedDisplay> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (hasWord(client, "EGL_EXT_platform_base")) {
    if (hasWord(client, "EGL_MESA_platform_surfaceless")) {
      found.push_back(
          {eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "surfaceless"});
    }
    if (hasWord(client, "EGL_EXT_platform_device") && hasWord(client, "EGL_EXT_device_enumeration")) {
      EGLDeviceEXT device = nullptr;
      EGLint count = 0;
      if (eglQueryDevicesEXT(1, &device, &count) == EGL_TRUE && count > 0) {
        found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr), "device"});
      }
    }
  }
  found.push_back({eglGetDisplay(EGL_DEFAULT_DISPLAY), "default display"});
  return found;
}

EGLContext makeContext(EGLDisplay display, EGLConfig config, EGLContext share, int major, int minor, bool debug) {
  const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         major,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         minor,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_CONTEXT_OPENGL_DEBUG,
                                         debug ? EGL_TRUE : EGL_FALSE,
                                         EGL_NONE};
  return eglCreateContext(display, config, share, attributes.data());
}

/// What the display can do instead, in words, for the message that 4.5 is not there.
std::string versionFound(EGLDisplay display, EGLConfig config) {
  EGLContext context = makeContext(display, config, EGL_NO_CONTEXT, 3, 2, false);
  if (context == EGL_NO_CONTEXT) {
    return "not even OpenGL 3.2 core";
  }
  std::string found = "an older version";
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
    found = fmt::format("{} ({})", reinterpret_cast<const char*>(glGetString(GL_VERSION)),
                        reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display, context);
  return found;
}

}  // namespace

struct OffscreenContext::Implementation {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLConfig config = nullptr;
  EGLSurface surface = EGL_NO_SURFACE;  ///< stays empty where contexts need none
  EGLContext context = EGL_NO_CONTEXT;
  std::string platform;
  ContextOptions options;

  Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    if (context != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == context) {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      }
      eglDestroyContext(display, context);
    }
    if (surface != EGL_NO_SURFACE) {
      eglDestroySurface(display, surface);
    }
  }

  /// Makes surface and context on `display`.
  Result<void> open(EGLContext share);
};

Result<void> OffscreenContext::Implementation::open(EGLContext share) {
  const std::string where = "EGL, " + platform;
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) {
    return failure("EGL here has no OpenGL", where, std::string(driverRemedy));
  }
  const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) {
    return failure("no configuration for OpenGL off screen", where, std::string(driverRemedy));
  }
  if (!hasWord(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    const std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size.data());
    if (surface == EGL_NO_SURFACE) {
      return failure(fmt::format("no pixel buffer ({})", eglErrorName(eglGetError())), where);
    }
  }
  context = makeContext(display, config, share, 4, 5, options.debug);
  if (context == EGL_NO_CONTEXT) {
    const std::string reason = eglErrorName(eglGetError());
    if (share != EGL_NO_CONTEXT) {
      return failure(fmt::format("no second context ({})", reason), where);
    }
    return failure(fmt::format("OpenGL 4.5 core is needed ({}), found {}", reason, versionFound(display, config)),
                   where, std::string(driverRemedy));
  }
  return {};
}

OffscreenContext::OffscreenContext(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

OffscreenContext::~OffscreenContext() = default;

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::create(const ContextOptions& options) {
  std::string tried;
  Error last{"no EGL display", "EGL", std::string(driverRemedy)};
  for (const NamedDisplay& candidate : displays()) {
    if (candidate.display == EGL_NO_DISPLAY || eglInitialize(candidate.display, nullptr, nullptr) == EGL_FALSE) {
      tried += fmt::format("{}{}", tried.empty() ? "" : ", ", candidate.platform);
      continue;
    }
    auto made = std::make_unique<Implementation>();
    made->display = candidate.display;
    made->platform = candidate.platform;
    made->options = options;
    if (auto opened = made->open(EGL_NO_CONTEXT); !opened) {
      last = opened.error();
      log::debug("{}", last.message());
      continue;
    }
    return std::unique_ptr<OffscreenContext>(new OffscreenContext(std::move(made)));
  }
  if (last.what == "no EGL display") {
    last.what = fmt::format("no EGL display (tried {})", tried);
  }
  return tl::make_unexpected(std::move(last));
}

Result<void> OffscreenContext::makeCurrent() {
  const Implementation& self = *implementation_;
  eglBindAPI(EGL_OPENGL_API);  // it is a setting of the thread
  if (eglMakeCurrent(self.display, self.surface, self.surface, self.context) == EGL_FALSE) {
    return failure(fmt::format("the context cannot be made current ({})", eglErrorName(eglGetError())),
                   "EGL, " + self.platform);
  }
  if (self.options.debug) {
    logDebugMessages();
  }
  return {};
}

void OffscreenContext::release() {
  eglBindAPI(EGL_OPENGL_API);
  eglMakeCurrent(implementation_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

Result<std::unique_ptr<Context>> OffscreenContext::createShared() {
  auto made = std::make_unique<Implementation>();
  made->display = implementation_->display;
  made->platform = implementation_->platform;
  made->options = implementation_->options;
  if (auto opened = made->open(implementation_->context); !opened) {
    return tl::make_unexpected(opened.error());
  }
  return std::unique_ptr<Context>(new OffscreenContext(std::move(made)));
}

const std::string& OffscreenContext::platform() const {
  return implementation_->platform;
}

}  // namespace meridian::graphics
