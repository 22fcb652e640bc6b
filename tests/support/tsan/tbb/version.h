// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// There is no TBB in this build.
inline const char* TBB_runtime_version() { return "none"; }
