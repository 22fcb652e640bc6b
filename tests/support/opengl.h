// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "gl/context.h"

namespace lanthorn::test {

/// A test with its own OpenGL context. Skipped, with the reason, if OpenGL 4.5 is missing.
class OpenGl : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context_.emplace(gl::Context::headless());
    } catch (const gl::Unavailable& e) {
      GTEST_SKIP() << "SKIPPED, NOT TESTED: " << e.what();
    }
  }
  std::optional<gl::Context> context_;
};

}  // namespace lanthorn::test
