// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "image/image_codec.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "base/parallel.h"
#include "base/threads.h"
#include "image/fallback_libraries.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

const ImageCodec& load_codec() {
  const unsigned started_by_libraries = threads_of_image_libraries();
  if (startable_threads(started_by_libraries) < started_by_libraries)
    throw Error(fmt::format("the libraries that read images start up to {} threads, more than are allowed",
                            started_by_libraries));
  void* module = dlopen(LANTHORN_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  if (const auto folder = folder_of_fallback_libraries(); module == nullptr && !folder.empty()) {
    load_fallback_libraries(folder);
    module = dlopen(LANTHORN_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  }
  void* const symbol = module != nullptr ? dlsym(module, image_codec_symbol) : nullptr;
  if (symbol == nullptr) throw Error({}, std::string("the module that reads images cannot be loaded: ") + dlerror());
  const ImageCodec& codec = *reinterpret_cast<ImageCodecFunction>(symbol)();
  // OpenEXR starts a thread for every core and fails if it cannot.
  const unsigned wanted = thread_count() - 1 + std::max(1u, std::thread::hardware_concurrency());
  if (startable_threads(wanted) < wanted) codec.use_one_thread();
  return codec;
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec& codec = load_codec();
  return codec;
}

}  // namespace lanthorn
