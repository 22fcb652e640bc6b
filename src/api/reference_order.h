// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lanthorn/plain_data.h"

namespace lanthorn::plain {

/// The entries of a dict of textures or materials in an order in which each one follows those that it refers to by
/// {"texture": name} or, in a mix, {"materials": [names]}. Fails for entries that refer to themselves.
std::vector<const Dict::Entry*> in_reference_order(Reader& reader, const Dict& table);

}  // namespace lanthorn::plain
