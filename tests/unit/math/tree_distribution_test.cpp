// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/tree_distribution.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <utility>

#include "math/hash.h"
#include "math/vec.h"

namespace lanthorn::tree_distribution_test {
namespace {

using Numbers = TreeDistribution::Numbers;

// Masses 1, 2, 5 and 8 of 16, in cells of 1/2, 1/8, 1/8 and 1/4 of the volume.
TreeDistribution example() {
  TreeDistribution tree;
  const std::uint32_t a = tree.add_leaf(1), b = tree.add_leaf(2), c = tree.add_leaf(5), d = tree.add_leaf(8);
  tree.add_inner(0, a, tree.add_inner(3, tree.add_inner(1, b, c), d));
  return tree;
}

double density_of_example(const Numbers& at) {
  if (at[0] < 0.5f) return 1.0 / 16 / 0.5;
  if (at[3] >= 0.5f) return 8.0 / 16 / 0.25;
  return (at[1] < 0.5f ? 2.0 : 5.0) / 16 / 0.125;
}

TEST(TreeDistribution, DrawsByItsDensity) {
  const TreeDistribution tree = example();
  HashRng rng(1);
  constexpr int n = 200'000;
  double in_half = 0, mean_of_inverse = 0;
  for (int i = 0; i < n; ++i) {
    const Numbers u{rng.next(), rng.next(), rng.next(), rng.next()};
    ASSERT_NEAR(static_cast<double>(tree.pdf({u[0], u[1], u[2], u[3]})), density_of_example(u), 1e-6);
    const auto [at, pdf] = tree.sample(u);
    for (const float x : at) ASSERT_TRUE(x >= 0 && x < 1);
    ASSERT_NEAR(static_cast<double>(pdf), density_of_example(at), 1e-5);
    mean_of_inverse += 1 / static_cast<double>(pdf);  // its mean is the total volume
    in_half += at[2] < 0.5f ? 1 : 0;                  // no node splits this axis
  }
  EXPECT_NEAR(mean_of_inverse / n, 1, 0.01);
  EXPECT_NEAR(in_half / n, 0.5, 0.005);
}

TEST(TreeDistribution, IsEvenWithoutNodes) {
  const Numbers u{0.1f, 0.2f, 0.3f, one_minus_epsilon};
  EXPECT_EQ(TreeDistribution().sample(u).at, u);
  EXPECT_EQ(TreeDistribution().sample(u).pdf, 1);
  EXPECT_EQ(TreeDistribution().pdf({u[0], u[1], u[2], u[3]}), 1);
}

TEST(TreeDistribution, KnowsTheDensityOfSomeNumbers) {
  const TreeDistribution tree = example();
  const std::optional<float> any;
  EXPECT_FLOAT_EQ(tree.pdf({any, any, any, any}), 1);
  EXPECT_FLOAT_EQ(tree.pdf({any, any, 0.3f, any}), 1);
  EXPECT_FLOAT_EQ(tree.pdf({0.7f, any, any, any}), 15.0f / 16 / 0.5f);
  EXPECT_FLOAT_EQ(tree.pdf({any, any, any, 0.9f}), (0.5f + 8) / 16 / 0.5f);
  EXPECT_FLOAT_EQ(tree.pdf({any, 0.1f, any, 0.2f}), (0.25f + 2) / 16 / 0.25f);
}

// The axis of the root is halved again: masses 1, 2 and 5 of 8 in [0, 1/2), [1/2, 3/4) and [3/4, 1).
TEST(TreeDistribution, HalvesAnAxisTwice) {
  TreeDistribution tree;
  const std::uint32_t a = tree.add_leaf(1), b = tree.add_leaf(2), c = tree.add_leaf(5);
  tree.add_inner(0, a, tree.add_inner(0, b, c));
  const std::optional<float> any;
  for (const auto& [x, density] : {std::pair{0.2f, 0.25f}, {0.6f, 1.0f}, {0.9f, 2.5f}}) {
    EXPECT_FLOAT_EQ(tree.pdf({x, 0.5f, 0.5f, 0.5f}), density) << x;
    EXPECT_FLOAT_EQ(tree.pdf({x, any, any, any}), density) << x;
  }
  EXPECT_FLOAT_EQ(tree.pdf({any, 0.5f, any, any}), 1);
}

// Samples in narrow cells keep the full resolution of the number they are drawn from.
TEST(TreeDistribution, KeepsNumbersInNarrowCells) {
  TreeDistribution tree;
  std::uint32_t node = tree.add_leaf(1);
  for (int i = 0; i < 20; ++i) node = tree.add_inner(0, node, tree.add_leaf(1e-4f));
  float previous = -1;
  for (int i = 0; i < 1000; ++i) {
    const auto [at, pdf] = tree.sample({static_cast<float>(i) * 0.99e-3f, 0, 0, 0});
    ASSERT_GT(at[0], previous);
    ASSERT_LT(at[0], 0x1p-20f);
    ASSERT_NEAR(pdf, 0x1p20f / 1.002f, 0x1p10f);
    previous = at[0];
  }
}

}  // namespace
}  // namespace lanthorn::tree_distribution_test
