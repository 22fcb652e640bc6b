// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Statistical tests have a false-alarm rate of 1e-4 each and fixed keys.
#include "math/primary_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "math/hash.h"
#include "math/sampler.h"
#include "support/chi2.h"

namespace lanthorn::primary_samples_test {
namespace {

constexpr int cells = 32;

double chi2_p(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  return test::chi2_upper_tail(statistic, static_cast<int>(counts.size()) - 1);
}

double uniform_p(const std::vector<double>& counts) {
  double sum = 0;
  for (const double n : counts) sum += n;
  return chi2_p(counts, std::vector<double>(counts.size(), sum / static_cast<double>(counts.size())));
}

std::size_t cell_of(float x) { return static_cast<std::size_t>(x * cells); }

// Probability of [a, b) modulo 1 under a normal density with mean 0.
double wrapped_normal(double a, double b, double sigma) {
  double sum = 0;
  for (int turn = -5; turn <= 5; ++turn)
    sum += 0.5 * (std::erf((b + turn) / (sigma * std::sqrt(2.0))) - std::erf((a + turn) / (sigma * std::sqrt(2.0))));
  return sum;
}

// Tests how far numbers move around the torus in `mutations` small mutations, if the group is only read after the last
// one: the distribution is the same as after as many separate steps. The numbers stay uniform.
void expect_wrapped_normal(float sigma, int mutations) {
  constexpr int vectors = 20000;
  std::vector<double> steps(cells), places(cells), expected(cells);
  for (int i = 0; i < vectors; ++i) {
    PrimarySamples samples(sigma);
    samples.start(hash_words({1, static_cast<std::uint64_t>(i)}));
    const PrimarySamples::Group before = samples.group(3);
    for (int m = 0; m < mutations; ++m) {
      samples.propose(Mutation::small);
      if (m + 1 < mutations) samples.accept();
    }
    const PrimarySamples::Group& after = samples.group(3);
    for (std::size_t d = 0; d < PrimarySamples::group_size; ++d) {
      ASSERT_GE(after[d], 0);
      ASSERT_LT(after[d], 1);
      const float step = after[d] - before[d];
      ++steps[std::min<std::size_t>(cell_of(step - std::floor(step)), cells - 1)];
      ++places[cell_of(after[d])];
    }
  }
  const double all = vectors * static_cast<double>(PrimarySamples::group_size);
  for (int c = 0; c < cells; ++c)
    expected[static_cast<std::size_t>(c)] =
        all * wrapped_normal(static_cast<double>(c) / cells, (c + 1.0) / cells,
                             static_cast<double>(sigma) * std::sqrt(static_cast<double>(mutations)));
  EXPECT_GT(chi2_p(steps, expected), 1e-4) << sigma << ", " << mutations;
  EXPECT_GT(uniform_p(places), 1e-4) << sigma << ", " << mutations;
}

TEST(PrimarySamples, SmallMutationsAreNormalStepsAroundTheTorus) {
  expect_wrapped_normal(0.25f, 1);
  expect_wrapped_normal(0.12f, 4);  // groups that were not read catch up
}

TEST(PrimarySamples, NumbersTakeStepsOfTheirOwn) {
  constexpr int vectors = 10000;
  constexpr std::size_t numbers = 2 * PrimarySamples::group_size;
  std::array<std::array<int, numbers>, numbers> same_way{};
  const auto read = [](PrimarySamples& samples) {
    std::array<float, numbers> values{};
    for (std::size_t i = 0; i < numbers; ++i)
      values[i] =
          samples.group(static_cast<std::uint32_t>(i / PrimarySamples::group_size))[i % PrimarySamples::group_size];
    return values;
  };
  for (int i = 0; i < vectors; ++i) {
    PrimarySamples samples(1e-4f);
    samples.start(static_cast<std::uint64_t>(i));
    const auto before = read(samples);
    samples.propose(Mutation::small);
    const auto after = read(samples);
    for (std::size_t a = 0; a < numbers; ++a)
      for (std::size_t b = 0; b < a; ++b) same_way[a][b] += (after[a] > before[a]) == (after[b] > before[b]) ? 1 : 0;
  }
  for (std::size_t a = 0; a < numbers; ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_NEAR(same_way[a][b], 0.5 * vectors, 2.5 * std::sqrt(vectors)) << a << ", " << b;
}

TEST(PrimarySamples, SmallMutationsKeepMostSeeds) {
  constexpr int vectors = 20000;
  for (const int mutations : {1, 5}) {  // the group is only read after the last
    int kept = 0;
    for (int i = 0; i < vectors; ++i) {
      PrimarySamples samples(0.01f);
      samples.start(static_cast<std::uint64_t>(i));
      const std::uint64_t before = samples.seed_of(0);
      for (int m = 0; m < mutations; ++m) {
        samples.propose(Mutation::small);
        if (m + 1 < mutations) samples.accept();
      }
      kept += samples.seed_of(0) == before ? 1 : 0;
    }
    const double expected = std::pow(0.875, mutations);
    EXPECT_NEAR(kept, expected * vectors, 4 * std::sqrt(expected * (1 - expected) * vectors));
  }
}

TEST(PrimarySamples, RejectionRestoresEveryNumber) {
  PrimarySamples samples(0.1f), untouched(0.1f);
  samples.start(7);
  untouched.start(7);
  const auto expect_equal = [&](std::uint32_t groups) {
    for (std::uint32_t g = 0; g < groups; ++g) {
      EXPECT_EQ(samples.group(g), untouched.group(g)) << g;
      EXPECT_EQ(samples.seed_of(g), untouched.seed_of(g)) << g;
    }
  };
  expect_equal(8);
  for (const Mutation mutation : {Mutation::small, Mutation::large, Mutation::small}) {
    samples.propose(mutation);
    for (std::uint32_t g = 0; g < 12; g += 2) EXPECT_NE(samples.group(g), untouched.group(g));
    samples.reject();
    expect_equal(8);
  }
  // The group had steps to catch up when a mutation read it; then the mutation is rejected.
  for (PrimarySamples* s : {&samples, &untouched}) {
    s->propose(Mutation::small);
    s->accept();
  }
  samples.propose(Mutation::small);
  const PrimarySamples::Group seen = samples.group(5);
  samples.reject();
  samples.propose(Mutation::small);
  samples.reject();
  EXPECT_NE(samples.group(5), seen);
}

TEST(PrimarySamples, LargeMutationsForgetWhatWasNotRead) {
  constexpr int vectors = 5000;
  std::vector<double> steps(cells);
  for (int i = 0; i < vectors; ++i) {
    PrimarySamples samples(1e-4f);
    samples.start(static_cast<std::uint64_t>(i));
    const PrimarySamples::Group before = samples.group(1);
    samples.propose(Mutation::large);
    samples.accept();
    samples.propose(Mutation::small);
    for (std::size_t d = 0; d < PrimarySamples::group_size; ++d) {
      const float step = samples.group(1)[d] - before[d];
      ++steps[std::min<std::size_t>(cell_of(step - std::floor(step)), cells - 1)];
    }
  }
  EXPECT_GT(uniform_p(steps), 1e-4);
}

// Once a large mutation has redrawn a group, the group keeps these values whenever it is read.
TEST(PrimarySamples, RejectionRestoresWhatALargeMutationDrew) {
  PrimarySamples samples(1e-4f);
  samples.start(13);
  samples.group(1);
  samples.propose(Mutation::large);
  samples.accept();
  samples.propose(Mutation::small);
  const PrimarySamples::Group proposed = samples.group(1);
  samples.reject();
  samples.propose(Mutation::small);
  samples.reject();
  for (std::size_t d = 0; d < PrimarySamples::group_size; ++d) EXPECT_NEAR(samples.group(1)[d], proposed[d], 1e-3);
  // After a second large mutation, the group differs from what the first one drew.
  samples.propose(Mutation::large);
  samples.accept();
  samples.propose(Mutation::large);
  const PrimarySamples::Group rejected = samples.group(1);
  samples.reject();
  EXPECT_NE(samples.group(1), rejected);
}

TEST(PrimarySamples, StartForgetsAll) {
  PrimarySamples samples(0.1f), fresh(0.1f);
  samples.start(17);
  for (const Mutation mutation : {Mutation::small, Mutation::large}) {
    samples.propose(mutation);
    samples.group(0);
    samples.accept();
  }
  samples.start(18);
  fresh.start(18);
  EXPECT_EQ(samples.group(0), fresh.group(0));
  EXPECT_EQ(samples.seed_of(1), fresh.seed_of(1));
}

// Metropolis' rule on a density that depends on two groups, the second of which is not always read. Chains that start
// with that density keep it.
TEST(PrimarySamples, ChainsKeepTheirDensity) {
  constexpr int chains = 20000, mutations = 12;
  constexpr float largest = 5;
  std::vector<double> first(cells), other(cells), expected_first(cells), expected_other(cells);
  const auto density = [](PrimarySamples& samples) {
    if (samples.group(0)[0] < 0.5f) return 2.0f;
    return samples.group(1)[2] < 0.5f ? 1.0f : largest;  // like paths, which only read the numbers they need
  };
  for (int i = 0; i < chains; ++i) {
    PrimarySamples samples(0.2f);
    HashRng rng(hash_words({5, static_cast<std::uint64_t>(i)}));
    std::uint64_t start = 0;
    do samples.start(hash_words({6, static_cast<std::uint64_t>(i), start++}));
    while (largest * rng.next() >= density(samples));
    float current = density(samples);
    for (int m = 0; m < mutations; ++m) {
      samples.propose(rng.next() < 0.3f ? Mutation::large : Mutation::small);
      const float proposed = density(samples);
      if (rng.next() * current < proposed) {
        current = proposed;
        samples.accept();
      } else {
        samples.reject();
      }
    }
    ++first[cell_of(samples.group(0)[0])];
    ++other[cell_of(samples.group(1)[2])];
  }
  for (std::size_t c = 0; c < cells; ++c) {
    const bool low = c < cells / 2;
    expected_first[c] = (low ? 2 : 3) * chains / (2.5 * cells);
    expected_other[c] = (low ? 2 + 1 : 2 + 5) * chains / (5.0 * cells);
  }
  EXPECT_GT(chi2_p(first, expected_first), 1e-4);
  EXPECT_GT(chi2_p(other, expected_other), 1e-4);
}

TEST(PrimarySamples, NumbersDoNotDependOnTheOrderOfReading) {
  PrimarySamples a(0.1f), b(0.1f);
  for (PrimarySamples* s : {&a, &b}) s->start(3);
  for (int m = 0; m < 4; ++m) {
    for (PrimarySamples* s : {&a, &b}) s->propose(m == 2 ? Mutation::large : Mutation::small);
    const PrimarySamples::Group last = a.group(9);
    for (std::uint32_t g = 0; g < 9; ++g) EXPECT_EQ(a.group(g), b.group(g));
    EXPECT_EQ(b.group(9), last);
    for (PrimarySamples* s : {&a, &b}) s->accept();
  }
}

TEST(PrimarySamples, AreWhatTheSamplerGives) {
  PrimarySamples samples(0.1f);
  samples.start(11);
  Sampler sampler(samples);
  sampler.seek(4);
  const PrimarySamples::Group group = samples.group(4);
  EXPECT_EQ(sampler.next2(), Vec2(group[0], group[1]));
  EXPECT_EQ(sampler.next(), group[2]);
  EXPECT_EQ(sampler.generator(6).next(), HashRng(samples.seed_of(6)).next());
}

}  // namespace
}  // namespace lanthorn::primary_samples_test
