// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// For the files of materials, and for nothing else. Such a file defines
//
//   static ClosureAt closure_of(const description::XMaterial& m, MaterialCompiler& c) { ... }
//   template ClosureAt compile(const description::XMaterial& m, MaterialCompiler& c);
//
// The second line is what the rest of the program calls.
#pragma once

#include "material/compiler.h"
#include "material/material.h"

namespace lanthorn {

template <class Parameters>
ClosureAt compile(const Parameters& parameters, MaterialCompiler& compiler) {
  return closure_of(parameters, compiler);
}

}  // namespace lanthorn
