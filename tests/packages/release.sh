#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
#
# Usage: tests/packages/release.sh FOLDER
# Makes the packages for the other tests in this folder. Exits with 77, which ctest shows as skipped, if a program that
# scripts/release needs is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
for tool in lintian patchelf zstd; do
  command -v "$tool" >/dev/null || { echo "SKIPPED, NOT TESTED: no $tool (scripts/install-packages package)" >&2; exit 77; }
done
[ -z "$(git status --porcelain)" ] || { echo "SKIPPED, NOT TESTED: a release is of a commit, and files differ from it" >&2; exit 77; }
scripts/release "${1:?folder}"
