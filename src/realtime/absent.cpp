// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/methods.h"

namespace lanthorn {

void add_realtime_methods() {}

}  // namespace lanthorn
