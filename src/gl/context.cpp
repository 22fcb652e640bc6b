// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace lanthorn::gl {

namespace {

constexpr int needed_version = 45;

/// A way to access a display.
struct Platform {
  std::string name;
  EGLenum kind = 0;
  void* native = nullptr;
};

bool has(const char* extensions, std::string_view name) {
  std::string_view rest = extensions != nullptr ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::vector<Platform> devices(const char* client_extensions) {
  if (!has(client_extensions, "EGL_EXT_platform_device") || !has(client_extensions, "EGL_EXT_device_enumeration"))
    return {};
  constexpr EGLint most = 16;
  std::array<EGLDeviceEXT, most> found{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(most, found.data(), &count)) return {};
  std::vector<Platform> real, software;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT device = found[static_cast<std::size_t>(i)];
    const bool is_software = has(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
    (is_software ? software : real).push_back({fmt::format("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, device});
  }
  real.insert(real.end(), software.begin(), software.end());
  return real;
}

std::vector<Platform> platforms() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<Platform> all = devices(extensions);
  if (has(extensions, "EGL_MESA_platform_surfaceless"))
    all.push_back({"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
  return all;
}

/// An initialised display with a current context, or the reason why the platform failed.
struct Attempt {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string failure;
};

Attempt make_context(EGLDisplay display) {
  if (!has(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
    return {display, EGL_NO_CONTEXT, "contexts need a surface"};
  if (!eglBindAPI(EGL_OPENGL_API)) return {display, EGL_NO_CONTEXT, "no OpenGL, only OpenGL ES"};
  constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count == 0)
    return {display, EGL_NO_CONTEXT, "no configuration for OpenGL"};
  // The last pair, with which drivers report resets, is omitted where it is unknown.
  std::array<EGLint, 11> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                    needed_version / 10,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    needed_version % 10,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_CONTEXT_OPENGL_DEBUG,
                                    EGL_TRUE,
                                    EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                    EGL_LOSE_CONTEXT_ON_RESET,
                                    EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) {
    attributes[8] = EGL_NONE;
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  }
  if (context == EGL_NO_CONTEXT)
    return {display, EGL_NO_CONTEXT, fmt::format("no OpenGL 4.5 core (EGL error {:#x})", eglGetError())};
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return {display, EGL_NO_CONTEXT, "its context cannot be made current"};
  }
  return {display, context, ""};
}

Attempt open(const Platform& platform) {
  EGLDisplay display = eglGetPlatformDisplayEXT(platform.kind, platform.native, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
    return {EGL_NO_DISPLAY, EGL_NO_CONTEXT, fmt::format("cannot be opened (EGL error {:#x})", eglGetError())};
  return make_context(display);
}

constexpr const char* advice =
    "Install a driver of the graphics card, or libgl1-mesa-dri and libegl1 to draw in software";

// Ignores other messages (performance, portability, deprecated functions), which do not affect the frame.
void APIENTRY note(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum /*severity*/, GLsizei length,
                   const GLchar* text, const void* log) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  auto& messages = *static_cast<std::vector<std::string>*>(const_cast<void*>(log));
  const char* kind = type == GL_DEBUG_TYPE_ERROR ? "error" : "undefined behaviour";
  messages.push_back(fmt::format("OpenGL {}: {}", kind, std::string(text, static_cast<std::size_t>(length))));
}

}  // namespace

Driver current_driver(std::string platform) {
  const auto text = [](GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); };
  Driver driver{std::move(platform), text(GL_RENDERER), text(GL_VERSION), false};
  if (epoxy_gl_version() < needed_version)
    throw Unavailable(
        fmt::format("OpenGL 4.5 core is needed; {} has OpenGL {}. {}", driver.renderer, driver.version, advice));
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"})
    if (driver.renderer.find(name) != std::string::npos) driver.software = true;
  return driver;
}

Context Context::headless() {
  if (!epoxy_has_egl())
    throw Unavailable(fmt::format("OpenGL 4.5 core is needed, but there is no libEGL.so.1. {}", advice));
  std::vector<std::string> failures;
  for (const Platform& platform : platforms()) {
    const Attempt attempt = open(platform);
    if (attempt.context != EGL_NO_CONTEXT) {
      Context context(attempt.display, attempt.context);
      context.driver_ = current_driver(platform.name);
      return context;
    }
    failures.push_back(fmt::format("{}: {}", platform.name, attempt.failure));
  }
  throw Unavailable(fmt::format(
      "OpenGL 4.5 core is needed, but EGL has no way to draw without a window ({}). {}",
      failures.empty() ? "no devices, no platform without surfaces" : fmt::format("{}", fmt::join(failures, "; ")),
      advice));
}

Context::Context(Context&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)),
      driver_(std::move(other.driver_)) {}

Context& Context::operator=(Context&& other) noexcept {
  std::swap(display_, other.display_);
  std::swap(context_, other.context_);
  std::swap(driver_, other.driver_);
  return *this;
}

// The display stays initialised, because EGL does not count its users.
Context::~Context() {
  if (context_ == nullptr) return;
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void Context::make_current() const {
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    throw Error(fmt::format("the OpenGL context is lost (EGL error {:#x})", eglGetError()));
}

CurrentScope::CurrentScope(const Context& context)
    : display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)) {
  context.make_current();
}

CurrentScope::~CurrentScope() {
  if (context_ != EGL_NO_CONTEXT)
    eglMakeCurrent(display_, draw_, read_, context_);
  else
    eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

DebugLog::DebugLog() : messages_(std::make_unique<std::vector<std::string>>()) {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(note, messages_.get());
}

void DebugLog::check() const {
  if (glGetGraphicsResetStatus() != GL_NO_ERROR)
    throw Unavailable("the OpenGL context was lost: the driver of the graphics card was reset");
  if (messages_->empty()) return;
  const std::vector<std::string> said = std::exchange(*messages_, {});
  throw Error(said.front());
}

}  // namespace lanthorn::gl
