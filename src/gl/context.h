// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An OpenGL 4.5 core context without window or display, by EGL.
#pragma once

#include <string>

#include "lanthorn/error.h"

namespace lanthorn::gl {

/// There is no usable OpenGL here; the message says what was found.
class Unavailable : public Error {
 public:
  using Error::Error;
};

/// Who draws.
struct Driver {
  std::string platform;  ///< how the context was made: "EGL device", "EGL surfaceless"
  std::string renderer;  ///< OpenGL's own name, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version;
  bool software = false;  ///< the CPU draws
};

/// The driver of the current context, whoever has made it. Throws Unavailable if it has no OpenGL 4.5 core.
Driver current_driver(std::string platform);

/// A context of its own. Current on the thread that made it, until another is made current.
class Context {
 public:
  /// Tries the devices that EGL lists, real ones first, then Mesa's platform without surfaces. Throws Unavailable.
  static Context headless();

  Context(Context&& other) noexcept;
  Context& operator=(Context&& other) noexcept;
  ~Context();

  void make_current() const;
  const Driver& driver() const { return driver_; }

 private:
  Context(void* display, void* context) : display_(display), context_(context) {}

  void* display_ = nullptr;  // EGLDisplay and EGLContext, so that users need not include EGL
  void* context_ = nullptr;
  Driver driver_;
};

/// Makes a context current for a scope, and the one before it afterwards.
class CurrentScope {
 public:
  explicit CurrentScope(const Context& context);
  CurrentScope(const CurrentScope&) = delete;
  CurrentScope& operator=(const CurrentScope&) = delete;
  ~CurrentScope();

 private:
  void *display_, *context_, *draw_, *read_;  // those before; null: none
};

}  // namespace lanthorn::gl
