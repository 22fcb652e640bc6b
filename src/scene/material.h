// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Materials with their textures, and their evaluation to closures: written by the scene part.
#pragma once
