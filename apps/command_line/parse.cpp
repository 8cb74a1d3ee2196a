#include "apps/command_line/parse.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "apps/command_line/number.hpp"
#include "core/error.hpp"
#include "image/image.hpp"
#include "scene/events.hpp"

namespace brume::cli {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& expected) {
  throw Error(ErrorCode::usage, option + " '" + text + "': expected " + expected);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// The whole text as a number, independent of the locale.
template <typename Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <typename Number>
std::optional<std::vector<Number>> numbers(std::string_view text, char separator, std::size_t count) {
  std::vector<Number> values;
  for (const std::string_view part : split(text, separator)) {
    const auto value = number<Number>(part);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

std::optional<glm::vec3> point(const std::string& text) {
  const auto values = parse_numbers(text, 3);
  if (!values) return std::nullopt;
  const glm::vec3 p((*values)[0], (*values)[1], (*values)[2]);
  const bool fits = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  return fits ? std::optional(p) : std::nullopt;
}

}  // namespace

glm::uvec2 parse_size(const std::string& option, const std::string& text) {
  const auto values = numbers<std::uint32_t>(text, 'x', 2);
  if (values && (*values)[0] > 0 && (*values)[1] > 0 && (*values)[0] <= image::kMaxAxis &&
      (*values)[1] <= image::kMaxAxis) {
    return {(*values)[0], (*values)[1]};
  }
  refuse(option, text, "WIDTHxHEIGHT up to " + std::to_string(image::kMaxAxis) + " each, such as 1280x720");
}

glm::ivec3 parse_grid(const std::string& option, const std::string& text) {
  const auto values = numbers<std::int32_t>(text, 'x', 3);
  if (values && (*values)[0] >= 0 && (*values)[1] >= 0 && (*values)[2] >= 0) {
    return {(*values)[0], (*values)[1], (*values)[2]};
  }
  refuse(option, text, "voxels along x, y and z, such as 120x20x120");
}

std::vector<std::string> parse_points(const std::string& text) {
  std::vector<std::string> points;
  bool joined = false;  // The next word belongs to the last point.
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (joined || (word.starts_with(',') && !points.empty())) {
      points.back() += word;
    } else {
      points.push_back(word);
    }
    // "1, 2, 3" goes on after a comma; "1,2,3, 4,5,6" does not.
    const auto commas = std::count(points.back().begin(), points.back().end(), ',');
    joined = points.back().ends_with(',') && commas < 3;
    if (points.back().ends_with(',') && commas == 3) points.back().pop_back();
  }
  return points;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text, std::size_t count) {
  std::string joined;
  for (const std::string& part : parse_points(text)) joined += (joined.empty() ? "" : " ") + part;
  std::vector<double> values;
  for (const std::string_view part : split(joined, ',')) {
    const auto value = parse_number(part);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values.size() == count ? std::optional(values) : std::nullopt;
}

glm::vec3 parse_point(const std::string& option, const std::string& text) {
  if (const auto value = point(text)) return *value;
  refuse(option, text, "three finite numbers, such as -30,0,2.5");
}

glm::vec3 parse_event_point(const std::string& option, const std::string& text) {
  const glm::vec3 p = parse_point(option, text);
  if (glm::all(glm::lessThanEqual(glm::abs(p), glm::vec3(scene::kFarthestEvent)))) return p;
  refuse(option, text,
         "coordinates within " + std::to_string(static_cast<int>(scene::kFarthestEvent)) + " m");
}

scene::Camera parse_camera(const std::string& option, const std::string& text) {
  constexpr double kDefaultFov = 60;
  const auto parts = parse_points(text);
  if (parts.size() == 2 || parts.size() == 3) {
    const auto position = point(parts[0]), target = point(parts[1]);
    const auto degrees = parts.size() == 3 ? parse_number(parts[2]) : kDefaultFov;
    const float radians = static_cast<float>(degrees.value_or(0) * std::numbers::pi / 180);
    if (position && target && *position != *target && degrees && *degrees < 180 && radians > 0)
      return {*position, *target, radians};
  }
  refuse(option, text,
         "\"position target fov\" with two distinct points and an angle in (0, 180) degrees, which may be "
         "missing, such as \"0,1.7,5 0,1.5,0 60\"");
}

passes::ViewSlice parse_slice(const std::string& option, const std::string& text) {
  const std::size_t axis = std::string_view("xyz").find(text.empty() ? '?' : text[0]);
  const bool begins = axis != std::string_view::npos && text.size() > 2 && text[1] == '=';
  const auto at = begins ? parse_number(std::string_view(text).substr(2)) : std::nullopt;
  if (!at || !std::isfinite(static_cast<float>(*at)))
    refuse(option, text, "an axis and a position in metres, such as y=1.5");
  return {static_cast<std::uint32_t>(axis), static_cast<float>(*at)};
}

FrameRange parse_frames(const std::string& option, const std::string& text) {
  constexpr std::uint32_t kMaxFrame = 1'000'000;
  const auto values = numbers<std::uint32_t>(text, '-', 2);
  if (values && (*values)[0] <= (*values)[1] && (*values)[1] <= kMaxFrame)
    return {(*values)[0], (*values)[1]};
  refuse(option, text, "FIRST-LAST up to " + std::to_string(kMaxFrame) + ", such as 0-119");
}

TimeRange parse_times(const std::string& option, const std::string& text) {
  const std::size_t dash = text.find('-', 1);
  if (dash != std::string::npos) {
    const auto begin = parse_number(text.substr(0, dash)), end = parse_number(text.substr(dash + 1));
    if (begin && end && *begin >= 0 && *begin < *end && *end <= 3600) return {*begin, *end};
  }
  refuse(option, text, "BEGIN-END in seconds, up to 3600, such as 1.5-6");
}

}  // namespace brume::cli
