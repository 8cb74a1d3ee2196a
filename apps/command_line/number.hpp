// The one reader of numbers in arguments: finite, in a range, decimal or a fraction.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace brume::cli {

/// The whole text as a finite number, independent of the locale: "2.5", "-1e3", "+4" or a fraction
/// "24000/1001". Nothing for NaN, infinity, hexadecimal numbers, blanks and anything else.
std::optional<double> parse_number(std::string_view text);

/// What numbers an option takes.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool whole = false;
};

/// The number, or in `fault` what was expected and found: "expected a number from 0 to 3600, found 'nan'".
std::optional<double> checked_number(std::string_view text, const NumberRange& range, std::string& fault);

/// A frame rate as an exact fraction [frames per second]. 23.976, 29.97, 47.952, 59.94 and 119.88 are the
/// rates of television, 24000/1001 and so on.
struct FrameRate {
  std::uint32_t numerator = 24, denominator = 1;
  /// Time of a frame [s].
  double time_of(std::uint32_t frame) const {
    return static_cast<double>(std::uint64_t{frame} * denominator) / numerator;
  }
  double per_second() const { return static_cast<double>(numerator) / denominator; }
};

/// "24", "23.976", "24000/1001": from 1 to 1000 per second. Throws Error (usage).
FrameRate parse_rate(const std::string& option, const std::string& text);

}  // namespace brume::cli
