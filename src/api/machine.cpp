// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/machine.h"

#include "base/machine.h"
#include "base/memory.h"
#include "base/threads.h"
#include "image/image_codec.h"
#include "lanthorn/version.h"
#include "scene/scene.h"

namespace lanthorn {

MachineInfo machine_info() {
  MachineInfo machine = machine_from_files("/");
  machine.allowed_threads = allowed_threads();
  machine.default_threads = usable_threads();
  machine.memory_available = available_memory();
  machine.libraries = {{"Lanthorn", version},
                       {"Embree", version_of_embree()},
                       {"oneTBB", version_of_tbb()},
                       {"OpenImageIO", image_codec().version()}};
  return machine;
}

}  // namespace lanthorn
