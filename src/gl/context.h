// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An OpenGL 4.5 core context without window or display, created with EGL, and the errors that OpenGL reports.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lanthorn/error.h"

namespace lanthorn::gl {

/// OpenGL is not usable here; the message lists the devices and why each is unusable.
class Unavailable : public Error {
 public:
  using Error::Error;
};

/// The OpenGL driver.
struct Driver {
  std::string platform;  ///< how the context was created: "EGL device", "EGL surfaceless"
  std::string renderer;  ///< OpenGL's name for it, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version;
  bool software = false;  ///< true if the CPU draws
};

/// The driver of the current context, whoever created it. Throws Unavailable if it lacks OpenGL 4.5 core.
Driver current_driver(std::string platform);

/// Owns a context, which is current on the thread that created it until another one is made current.
class Context {
 public:
  /// Tries the devices that EGL lists, hardware first, then Mesa's surfaceless platform. Throws Unavailable.
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

/// Makes a context current for a scope, then restores the previous one.
class CurrentScope {
 public:
  explicit CurrentScope(const Context& context);
  CurrentScope(const CurrentScope&) = delete;
  CurrentScope& operator=(const CurrentScope&) = delete;
  ~CurrentScope();

 private:
  void *display_, *context_, *draw_, *read_;  // the previous ones; null: none
};

/// Collects the errors and the undefined behaviour that OpenGL reports for the context that was current when the log
/// was created. Must live as long as the context is used.
class DebugLog {
 public:
  DebugLog();

  /// Messages so far, in order.
  const std::vector<std::string>& messages() const { return *messages_; }
  /// Throws Unavailable if the driver was reset and the context is lost, or Error with the first message, if there is
  /// one; this empties the log.
  void check() const;

 private:
  std::unique_ptr<std::vector<std::string>> messages_;  // OpenGL stores its address
};

}  // namespace lanthorn::gl
