// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/plain_data.h"

namespace lanthorn::plain {

/// The entries of a dict of textures in an order in which each comes after those that it refers to. Fails for textures
/// that refer to themselves.
std::vector<const Dict::Entry*> in_texture_order(Reader& reader, const Dict& textures);

}  // namespace lanthorn::plain
