#include "apps/command_line/number.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/error.hpp"

namespace brume::cli {
namespace {

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::optional<double> to_decimal(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('+') || text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return to_decimal(text);
  const auto above = to_decimal(text.substr(0, slash)), below = to_decimal(text.substr(slash + 1));
  if (!above || !below || !std::isfinite(*above / *below)) return std::nullopt;
  return *above / *below;
}

std::optional<double> checked_number(std::string_view text, const NumberRange& range, std::string& fault) {
  const auto value = parse_number(text);
  const bool kind = value && (!range.whole || *value == std::floor(*value));
  if (kind && *value >= range.low && *value <= range.high) return value;
  fault = range.whole ? "expected a whole number" : "expected a number";
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  if (low && high) fault += " from " + to_text(range.low) + " to " + to_text(range.high);
  if (low && !high) fault += " of at least " + to_text(range.low);
  fault += ", found '" + std::string(text) + "'";
  return std::nullopt;
}

FrameRate parse_rate(const std::string& option, const std::string& text) {
  constexpr double kSlowest = 1, kFastest = 1000;
  std::string fault;
  const auto rate = checked_number(text, {kSlowest, kFastest}, fault);
  if (!rate)
    throw Error(ErrorCode::usage, option + ": " + fault + "; fractions such as 24000/1001 are rates, too");

  // Television: 1000/1001 of a whole rate, written with two or three decimals.
  constexpr double kRounded = 0.0051;
  for (const std::uint32_t whole : {24u, 30u, 48u, 60u, 120u})
    if (std::abs(*rate - whole * 1000.0 / 1001) < kRounded && *rate != std::floor(*rate))
      return {whole * 1000, 1001};

  // The fraction as written, or millionths.
  const std::size_t slash = text.find('/');
  std::uint32_t above = 0, below = 0;
  const auto read = [&](std::string_view part, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (slash != std::string::npos && read(std::string_view(text).substr(0, slash), above) &&
      read(std::string_view(text).substr(slash + 1), below))
    return {above / std::gcd(above, below), below / std::gcd(above, below)};
  constexpr std::uint32_t kMillion = 1'000'000;
  const auto millionths = static_cast<std::uint32_t>(std::lround(*rate * kMillion));
  const std::uint32_t common = std::gcd(millionths, kMillion);
  return {millionths / common, kMillion / common};
}

}  // namespace brume::cli
