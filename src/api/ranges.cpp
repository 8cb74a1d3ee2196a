#include "api/ranges.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace brume::api {
namespace {

/// Large powers as such: 10^6, 2^22.
std::string to_text(double value) {
  const double exponent = std::round(std::log10(std::max(value, 1.0)));
  if (value >= 1e6 && std::pow(10.0, exponent) == value)
    return "10^" + std::to_string(static_cast<int>(exponent));
  const auto whole = static_cast<std::uint32_t>(value);
  if (value == whole && value >= 1 << 16 && std::has_single_bit(whole))
    return "2^" + std::to_string(std::countr_zero(whole));
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

[[noreturn]] void refuse_range(const scene::OptionInfo& info, const std::string& name, const char* or_else) {
  refuse(name + " must be from " + to_text(info.low) + " to " + to_text(info.high) + or_else);
}

}  // namespace

void require_range(const scene::OptionInfo& info, float value, const std::string& name, const char* or_else) {
  if (!scene::is_in_range(info, value)) refuse_range(info, name, or_else);
}

void require_range(const scene::OptionInfo& info, std::uint32_t value, const std::string& name) {
  if (value > info.high) refuse(name + " must be at most " + to_text(info.high));
  if (value < info.low) refuse_range(info, name, "");
}

void require_range(const scene::OptionInfo& info, float value, const char* name) {
  if (!scene::is_in_range(info, value)) refuse_range(info, name, "");
}

bool RangeCheck::is_in_range(const scene::OptionInfo& info, float value) {
  return scene::is_in_range(info, value);
}

bool RangeCheck::is_in_range(const scene::OptionInfo& info, std::uint32_t value) {
  return value >= info.low && value <= info.high;
}

std::string RangeCheck::name_of(const scene::OptionInfo& info) const {
  const std::string start =
      number_ ? std::string(start_) + " " + std::to_string(*number_) + ": `" : std::string(start_);
  return start + info.key + "`";
}

}  // namespace brume::api
