// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Compares second moments for other numbers of samples with values computed by hand.
#include "integrators/auto/moments.h"

#include <gtest/gtest.h>

#include <vector>

namespace lanthorn::moments_test {
namespace {

constexpr EffortCandidate path_tracing{
    .light_paths = 0, .connections = 4, .merges = false, .merges_in_media = false, .sees = false};
constexpr EffortCandidate more{.light_paths = 2, .connections = 4, .merge_area = 0.5f};
constexpr EffortCandidate without_lens{.merges_in_media = false, .sees = false};
constexpr EffortCandidate short_paths{.goes_on = false};

const TechniqueSum sum{
    .within = {.walk = 1, .lens = 2, .connections = 3, .merging = 4, .media = 5},
    .beyond = {.walk = 10, .lens = 20, .connections = 30, .merging = 40, .media = 50},
};
constexpr float all = 165;

TEST(CandidateArrays, ComparesDensitiesOfAllTechniques) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, path_tracing, more, without_lens, short_paths});
  std::vector<float> ratios(candidates.size());
  candidates.ratios(sum, 0, ratios);
  EXPECT_FLOAT_EQ(ratios[0], 1);
  EXPECT_FLOAT_EQ(ratios[1], 11 / all);
  EXPECT_FLOAT_EQ(ratios[2], 11 * (1 + 2 * 2 + 4 * 3 + 2 * 0.5f * 4 + 2 * 5) / all);
  EXPECT_FLOAT_EQ(ratios[3], 11 * (1 + 3 + 4) / all);
  EXPECT_FLOAT_EQ(ratios[4], 15 / all);
}

TEST(CandidateArrays, ComparesAPartOfTheList) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, path_tracing, short_paths});
  std::vector<float> ratios(2);
  candidates.ratios(sum, 1, ratios);
  EXPECT_FLOAT_EQ(ratios[0], 11 / all);
  EXPECT_FLOAT_EQ(ratios[1], 15 / all);
}

TEST(CandidateArrays, GivesSomeDensityToPathsThatACandidateCannotFind) {
  const CandidateArrays candidates(std::vector{path_tracing});
  std::vector<float> ratios(1);
  candidates.ratios({.within = {.merging = 1}}, 0, ratios);
  EXPECT_FLOAT_EQ(ratios[0], 1e-6f);
}

TEST(PathMoments, SumsContributionsOfTheWalk) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, path_tracing});
  PathMoments moments(candidates);
  const TechniqueSum densities{.within = {.walk = 1, .merging = 3}};
  moments.add({2, densities, &TechniqueDensities::walk});
  moments.add({3, densities, &TechniqueDensities::walk});
  moments.set = 1;
  moments.add({9, densities, &TechniqueDensities::walk});  // the same eye path again
  EXPECT_EQ(moments.light, 5);
  EXPECT_EQ(moments.by_walk, 5);
  const PathMoments::Estimate pilot = moments.estimate(0), more_noise = moments.estimate(1);
  EXPECT_DOUBLE_EQ(pilot.light, 5);
  EXPECT_DOUBLE_EQ(pilot.second_moment, 25);
  EXPECT_DOUBLE_EQ(pilot.squares, 13);
  EXPECT_DOUBLE_EQ(pilot.all_squares, 13);
  EXPECT_DOUBLE_EQ(more_noise.light, 20);  // R = 1 / 4
  EXPECT_DOUBLE_EQ(more_noise.second_moment, 400);
  EXPECT_DOUBLE_EQ(more_noise.all_squares, 4 * 13);
}

TEST(PathMoments, TellsLightOfBothSetsApart) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, more, path_tracing});
  PathMoments moments(candidates);
  const TechniqueSum densities{.within = {.walk = 1, .connections = 1}};  // R of `more`: 5 / 2
  moments.add({5, densities, &TechniqueDensities::connections});
  moments.set = 1;
  moments.add({10, densities, &TechniqueDensities::connections});
  EXPECT_EQ(moments.light, 5);
  const PathMoments::Estimate pilot = moments.estimate(0), other = moments.estimate(1), none = moments.estimate(2);
  EXPECT_DOUBLE_EQ(pilot.light, 7.5);
  EXPECT_DOUBLE_EQ(pilot.of_eye_path, 50);
  EXPECT_DOUBLE_EQ(pilot.second_moment, 50 + 62.5 - 50);
  EXPECT_DOUBLE_EQ(other.light, 4 * (2 + 4) / 2.0);
  EXPECT_DOUBLE_EQ(other.of_eye_path, 16 * 2 * 4);
  EXPECT_DOUBLE_EQ(other.squares, 4 * (4 + 16) / 2.0);
  EXPECT_DOUBLE_EQ(other.second_moment, 16 * 2 * 4 + 4 * (4 + 16) / 2.0 - 4 * 2 * 4);
  EXPECT_DOUBLE_EQ(other.all_squares, 0.5 * (25 + 100) / 2.5);
  EXPECT_DOUBLE_EQ(none.light, 0);
  EXPECT_DOUBLE_EQ(none.squares, 0);
  EXPECT_DOUBLE_EQ(none.all_squares, (25 + 100));  // R = 1 / 2
}

TEST(PathMoments, LeavesOutWhatShortEyePathsDoNotFind) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, short_paths});
  PathMoments moments(candidates);
  const TechniqueSum densities{.within = {.merging = 1}, .beyond = {.merging = 1}, .is_beyond = true};
  moments.add({3, densities, &TechniqueDensities::merging});
  EXPECT_DOUBLE_EQ(moments.estimate(0).light, 1.5);
  EXPECT_DOUBLE_EQ(moments.estimate(1).light, 0);
  EXPECT_DOUBLE_EQ(moments.estimate(1).all_squares, 0.5 * 9 / 0.5);
}

TEST(PathMoments, TakesMergesOfBothSets) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}});
  PathMoments moments(candidates);
  const TechniqueSum densities{.within = {.merging = 1}};
  moments.add({3, densities, &TechniqueDensities::merging});
  moments.set = 1;
  moments.add({5, densities, &TechniqueDensities::merging});
  EXPECT_DOUBLE_EQ(moments.estimate(0).of_eye_path, 15);
}

// Over a ratio of almost nothing it would be infinite.
TEST(PathMoments, IgnoresBrightLightOfTechniquesThatACandidateDoesNotUse) {
  const CandidateArrays candidates(std::vector{EffortCandidate{}, path_tracing});
  PathMoments moments(candidates);
  const TechniqueSum densities{.within = {.merging = 1}};
  moments.add({1e37f, densities, &TechniqueDensities::merging});
  EXPECT_EQ(moments.estimate(1).light, 0);
}

}  // namespace
}  // namespace lanthorn::moments_test
