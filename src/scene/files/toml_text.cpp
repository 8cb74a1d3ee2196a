#include "scene/files/toml_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string_view>

#include "scene/files/scene_files.hpp"

namespace brume::scene {
namespace {

namespace fs = std::filesystem;

/// Formats a number as a TOML float.
template <typename Number>
std::string decimal(Number value) {
  const double size = std::abs(double{value});
  const bool plain = size == 0 || (size >= 1e-5 && size < 1e15);
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 plain ? std::chars_format::fixed : std::chars_format::scientific);
  std::string text(buffer.data(), end.ptr);
  if (plain && text.find('.') == std::string::npos) text += ".0";
  return text;
}

double read_back(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

template <typename Vector>
std::string triple(const Vector& v) {
  std::string text = "[";
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ", ";
    text += to_text(v[axis]);
  }
  text += ']';
  return text;
}

}  // namespace

std::string to_text(double value) {
  return decimal(value);
}

std::string to_text(float value) {
  // The reader rounds to double first, which in rare cases gives another float.
  std::string text = decimal(value);
  return static_cast<float>(read_back(text)) == value ? text : decimal(double{value});
}

std::string degrees_text(const OptionInfo& info, float radians) {
  const double degrees = double{radians} / kRadiansOfDegree;
  for (int digits = 1; digits < 17; ++digits) {
    std::array<char, 64> buffer;
    const int length = std::snprintf(buffer.data(), buffer.size(), "%.*e", digits - 1, degrees);
    const double rounded = read_back({buffer.data(), static_cast<std::size_t>(length)});
    if (rounded < info.low || rounded > info.high) continue;
    if (static_cast<float>(rounded * kRadiansOfDegree) == radians) return decimal(rounded);
  }
  return decimal(degrees);
}

std::string to_text(int value) {
  return std::to_string(value);
}

std::string to_text(std::uint32_t value) {
  return std::to_string(value);
}

std::string to_text(const std::vector<float>& numbers) {
  std::string text;
  for (const float number : numbers) text += (text.empty() ? "[" : ", ") + to_text(number);
  return text + ']';
}

std::string to_text(const glm::vec2& v) {
  return to_text(std::vector{v.x, v.y});
}

std::string to_text(const std::vector<std::vector<float>>& rows) {
  std::string text;
  for (const std::vector<float>& row : rows) text += (text.empty() ? "[" : ", ") + to_text(row);
  return text + ']';
}

std::string to_text(const glm::vec3& v) {
  return triple(v);
}

std::string to_text(const glm::ivec3& v) {
  return triple(v);
}

std::string to_text(bool value) {
  return value ? "true" : "false";
}

std::string to_text(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      std::array<char, 8> escape;
      std::snprintf(escape.data(), escape.size(), "\\u%04X", unsigned{byte});
      text += escape.data();
    } else {
      text += c;
    }
  }
  text += '"';
  return text;
}

Failure not_saved(const Failure& failure, const fs::path& path) {
  std::string_view why = failure.message;
  if (why.starts_with(path.string() + ":")) {
    why.remove_prefix(path.string().size());
    why.remove_prefix(std::min(why.find_first_not_of(":0123456789 "), why.size()));
  }
  return {failure.code, "not saved: " + std::string(why)};
}

fs::path path_from(const fs::path& path, const fs::path& folder) {
  const fs::path below = path.lexically_relative(folder);
  if (is_safe_relative(below.generic_string())) return below;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  const fs::path base = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder, error), error);
  if (error || whole.empty() || base.empty()) return path;
  const bool have_a_folder_in_common = std::next(whole.begin()) != whole.end() &&
                                       std::next(base.begin()) != base.end() &&
                                       *std::next(whole.begin()) == *std::next(base.begin());
  return have_a_folder_in_common ? whole.lexically_relative(base) : whole;
}

void TomlText::camera(const CameraKey& key) {
  text_ += "\n[[camera]]\n";
  line("time", key.time);
  line("position", key.camera.position_world);
  line("target", key.camera.target_world);
  static const Camera kUsualCamera;
  // The field of view always, of the lens what is not as usual.
  OptionTexts texts, usual;
  visit_camera_options(key.camera, texts);
  visit_camera_options(kUsualCamera, usual);
  for (std::size_t i = 0; i < texts.texts.size(); ++i)
    if (i == 0 || texts.texts[i] != usual.texts[i])
      text_ += std::string(texts.texts[i].first) + " = " + texts.texts[i].second + "\n";
  if (!key.camera.lens.opening.empty())
    line("opening", path_from(key.camera.lens.opening, folder_).generic_string());
}

}  // namespace brume::scene
