// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Replays the corpus collected by the fuzzers, with any compiler.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fuzz/targets.h"

namespace lanthorn::corpus_test {
namespace {

std::size_t replay(const char* name, void (*target)(std::string_view)) {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(LANTHORN_SOURCE_DIR "/tests/fuzz/corpus/" + std::string(name))) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    target(bytes);
    target(std::string_view(bytes).substr(0, bytes.size() / 2));
    ++count;
  }
  return count;
}

TEST(FuzzCorpus, Pbrt) { EXPECT_GT(replay("pbrt", fuzz::read_pbrt), 5u); }
TEST(FuzzCorpus, Ply) { EXPECT_GT(replay("ply", fuzz::read_ply), 5u); }
TEST(FuzzCorpus, Gltf) { EXPECT_GT(replay("gltf", fuzz::read_gltf), 5u); }
TEST(FuzzCorpus, Measured) { EXPECT_GT(replay("measured", fuzz::read_measured), 2u); }
TEST(FuzzCorpus, Hdr) { EXPECT_GT(replay("hdr", fuzz::read_hdr), 5u); }
TEST(FuzzCorpus, Obj) { EXPECT_GT(replay("obj", fuzz::read_obj), 2u); }
TEST(FuzzCorpus, Tables) { EXPECT_GT(replay("tables", fuzz::read_tables), 5u); }
TEST(FuzzCorpus, Request) { EXPECT_GT(replay("request", fuzz::read_request), 5u); }
TEST(FuzzCorpus, State) { EXPECT_GT(replay("state", fuzz::read_state), 5u); }

}  // namespace
}  // namespace lanthorn::corpus_test
