// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "image/image_codec.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>

#include "base/parallel.h"
#include "base/threads.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

// Loads the shared libraries of a folder that the system lacks, so that modules that need them find them loaded. The
// system's libraries take precedence: drivers must not meet an older library of the same name.
void load_fallback_libraries(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (dlopen(entry.path().filename().c_str(), RTLD_LAZY | RTLD_LOCAL) == nullptr) missing.push_back(entry.path());
  // All libraries that the system provides are loaded by now, including for those that need each other.
  for (const fs::path& library : missing) dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
}

// The folder of such libraries beside this library's modules, which the relocatable archive has
// (scripts/bundle-libraries); empty if it does not exist.
fs::path folder_of_fallback_libraries() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&folder_of_fallback_libraries), &own) == 0) return {};
  const fs::path beside = fs::path(own.dli_fname).parent_path();
  std::error_code ignored;
  // The second path is for a library in glibc-hwcaps/x86-64-v3.
  for (const char* modules : {"lanthorn", "../../lanthorn"})
    if (fs::path folder = beside / modules / "fallback"; fs::is_directory(folder, ignored)) return folder;
  return {};
}

void* load_module() {
  void* module = dlopen(LANTHORN_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  if (const auto folder = folder_of_fallback_libraries(); module == nullptr && !folder.empty()) {
    load_fallback_libraries(folder);
    module = dlopen(LANTHORN_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  }
  return module;
}

// For a child process that may crash or, as a copy of a process with several threads, wait for a lock forever.
void end_without_a_trace() {
  constexpr unsigned most_seconds = 20;
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGABRT, SIGALRM}) ::signal(signal, SIG_DFL);
  ::prctl(PR_SET_DUMPABLE, 0);
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  ::alarm(most_seconds);
}

// Throws Error if the module cannot be loaded.
const ImageCodec& open_codec(bool with_one_thread) {
  void* const module = load_module();
  void* const symbol = module != nullptr ? dlsym(module, image_codec_symbol) : nullptr;
  if (symbol == nullptr) throw Error({}, std::string("the module that reads images cannot be loaded: ") + dlerror());
  const ImageCodec& codec = *reinterpret_cast<ImageCodecFunction>(symbol)();
  if (with_one_thread) codec.use_one_thread();
  return codec;
}

// Whether a child process survives opening the codec with one thread.
bool child_survives() {
  const pid_t child = ::fork();
  if (child == 0) {
    end_without_a_trace();
    try {
      open_codec(/*with_one_thread=*/true);
    } catch (const Error&) {  // the caller will get the same error
    } catch (...) {           // a thread could not be started
      ::_exit(1);
    }
    ::_exit(0);
  }
  if (child < 0) return false;
  int status = 0;
  pid_t ended = -1;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// The libraries behind the module start threads: when they are loaded, and for their pools. If they cannot, log4cplus
// and OpenImageIO end the program, and OpenBLAS sends it SIGINT. How many they start depends on which libraries the
// system has. Where threads are scarce, the codec therefore uses one thread, and a child process tries first.
const ImageCodec& load_codec() {
  constexpr unsigned unknown = 8;  // threads of other libraries
  const unsigned pool_of_openexr = std::max(1u, std::thread::hardware_concurrency());
  const unsigned ample = threads_of_image_libraries() + unknown + pool_of_openexr + thread_count() - 1;
  const unsigned startable = startable_threads(ample);
  const bool are_scarce = startable < ample;
  if (are_scarce && !child_survives())
    throw Error(fmt::format(
        "images cannot be read: the libraries that read them start threads, and the system allows only {} more",
        startable));
  return open_codec(are_scarce);
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec& codec = load_codec();
  return codec;
}

}  // namespace lanthorn
