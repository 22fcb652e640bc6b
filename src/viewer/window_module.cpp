// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <string>

#include "viewer/panel.h"

namespace lanthorn {

namespace {

const WindowFunctions& load() {
  void* const module = dlopen(LANTHORN_WINDOW_MODULE, RTLD_LAZY | RTLD_LOCAL);
  void* const symbol = module != nullptr ? dlsym(module, window_symbol) : nullptr;
  if (symbol == nullptr)
    throw ViewerUnavailable(std::string("the module that opens windows cannot be loaded: ") + dlerror());
  return *reinterpret_cast<WindowSymbol>(symbol)();
}

}  // namespace

const WindowFunctions& window_functions() {
  static const WindowFunctions& functions = load();
  return functions;
}

}  // namespace lanthorn
