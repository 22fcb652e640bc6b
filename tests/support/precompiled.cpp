// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Compiles the headers that tests share (see lanthorn_test_headers in cmake/LanthornModules.cmake).
