// Means of many samples, and tests of distributions.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/sanitized.hpp"

namespace brume::reference {

/// Under a sanitizer, so many times fewer samples, and so many times the error that remains.
constexpr std::uint32_t kFewer = kSanitized ? 64 : 1;
constexpr double kLooser = kSanitized ? 8 : 1;

/// Mean and standard error of independent samples.
class Mean {
 public:
  void add(double value) {
    // Welford 1962.
    ++count_;
    const double off = value - mean_;
    mean_ += off / count_;
    squares_ += off * (value - mean_);
  }
  double value() const { return mean_; }
  double error() const { return std::sqrt(squares_ / (count_ - 1) / count_); }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

/// Whether a mean is what it should be: within four standard errors, of which one in 16,000 right means is
/// not, and `known` to so much of it that this says something.
inline void expect_mean(const Mean& found, double expected, double known) {
  EXPECT_NEAR(found.value(), expected, 4 * found.error() + 1e-6 * expected);
  EXPECT_LT(found.error(), kLooser * known * expected);
}

/// Pearson's test: whether counts follow the expected ones, which sum to the same. Cells of less than five
/// expected counts are joined. The statistic of right ones has the mean m, their number less one, and the
/// variance 2 m; five deviations.
inline void expect_distribution(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0, cells = 0, joined_count = 0, joined_expected = 0;
  const auto add = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
    } else {
      joined_count += counts[i];
      joined_expected += expected[i];
    }
  }
  if (joined_expected >= 5) add(joined_count, joined_expected);
  EXPECT_LE(joined_count, joined_expected + 6 * std::sqrt(joined_expected) + 6);
  const double degrees = cells - 1;
  EXPECT_LT(statistic, degrees + 5 * std::sqrt(2 * degrees)) << cells << " cells";
}

}  // namespace brume::reference
