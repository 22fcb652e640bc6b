// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Included only by the files of materials, which define for each kind X
//
//   static ClosureAt closure_of(const description::XMaterial& m, MaterialCompiler& c) { ... }
//   template ClosureAt compile(const description::XMaterial& m, MaterialCompiler& c);
//
// The second line instantiates the function that the rest of the program calls.
#pragma once

#include "material/compiler.h"
#include "material/material.h"

namespace lanthorn {

template <class Parameters>
ClosureAt compile(const Parameters& parameters, MaterialCompiler& compiler) {
  return closure_of(parameters, compiler);
}

}  // namespace lanthorn
