// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Common parts of statistical tests: variable seeds, means with standard errors, and limits that a correct program
// exceeds at a stated rate. A fixed seed alone does not fix results, since bytes differ between instruction sets.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace lanthorn::test {

/// Maximum rate at which a test fails by chance, over all its checks.
inline constexpr double false_alarm_rate = 1e-6;

/// `n`, or with --gtest_random_seed=S a different number for each S, to run a test with other random numbers.
inline std::uint64_t seed(std::uint64_t n) {
  return n + 1'000'003 * static_cast<std::uint64_t>(GTEST_FLAG_GET(random_seed));
}

/// The false-alarm rate per check that gives `rate` for `checks` independent checks together (Šidák 1967).
inline double sidak(double rate, int checks) { return -std::expm1(std::log1p(-rate) / checks); }

/// The value that |z| of a normal variable exceeds at this rate: 4.9 for 1e-6.
inline double z_limit(double rate = false_alarm_rate) {
  double low = 0, high = 40;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (std::erfc(z / std::sqrt(2.0)) > rate ? low : high) = z;
  }
  return high;
}

/// Records how close a check came to its limit (1: at the limit). The largest value of a test becomes this property in
/// the report of --gtest_output=xml:FILE.
inline void note_share(const char* property, double share) {
  static const ::testing::TestInfo* test = nullptr;
  static std::map<std::string, double> largest;
  const ::testing::TestInfo* current = ::testing::UnitTest::GetInstance()->current_test_info();
  if (current != test) largest.clear();
  test = current;
  double& of_property = largest[property];
  of_property = std::max(of_property, share);
  ::testing::Test::RecordProperty(property, std::to_string(of_property));
}
/// Records the share of the tested limit.
inline void note_share_of_limit(double share) { note_share("share_of_limit", share); }
/// Records the share of the noise that a test may have while remaining meaningful.
inline void note_share_of_noise(double share) { note_share("share_of_noise", share); }

/// True if |a - b| <= limit.
inline ::testing::AssertionResult within(double a, double b, double limit) {
  const double difference = std::fabs(a - b);
  note_share_of_limit(difference / limit);
  auto result = difference <= limit ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << a << " and " << b << " differ by " << difference << ", limit " << limit;
}

/// True if a positive number is below its limit. The comment beside a limit states its distance from the number's mean,
/// in standard deviations over seeds.
inline ::testing::AssertionResult below(double x, double limit) {
  note_share_of_limit(x / limit);
  return (x < limit ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << x << ", limit " << limit;
}

/// True if a p-value is not below `limit`.
inline ::testing::AssertionResult not_below(double p, double limit) {
  note_share_of_limit(p > 0 ? std::log(p) / std::log(limit) : 100);
  auto result = p >= limit ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << "p = " << p << ", limit " << limit;
}

/// Mean of independent numbers, and its standard error.
class Mean {
 public:
  void add(double x) {
    ++n_;
    const double difference = x - mean_;
    mean_ += difference / n_;
    squares_ += difference * (x - mean_);
  }
  double count() const { return n_; }
  double mean() const { return mean_; }
  /// Variance of the mean, not of the numbers.
  double squared_error() const { return n_ > 1 ? squares_ / (n_ - 1) / n_ : 0; }
  double error() const { return std::sqrt(squared_error()); }

 private:
  double n_ = 0, mean_ = 0, squares_ = 0;
};

/// z-test of a mean of so many numbers that their standard error is reliable: within z standard errors of `expected`,
/// plus `slack` times it for quadrature and rounding.
inline ::testing::AssertionResult agrees(const Mean& mean, double expected, double z, double slack = 0) {
  return within(mean.mean(), expected, z * mean.error() + slack * std::fabs(expected))
         << ", standard error " << mean.error();
}
/// The same of two means.
inline ::testing::AssertionResult agree(const Mean& a, const Mean& b, double z) {
  const double error = std::sqrt(a.squared_error() + b.squared_error());
  return within(a.mean(), b.mean(), z * error) << ", standard error " << error;
}

}  // namespace lanthorn::test
