#include "grids/files/json.hpp"

#include <cmath>

#include "core/file.hpp"

namespace brume::grids {
namespace {

constexpr std::uint64_t kMostBytes = 1 << 20;
/// The parser and its destructor are recursive.
constexpr int kMostNesting = 8;

}  // namespace

Result<Json> read_json_object(const std::filesystem::path& path) {
  const auto text = read_text_file(path, kMostBytes);
  if (!text) return text.failure();
  bool too_deep = false;
  Json json = Json::parse(
      *text,
      [&](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > kMostNesting;
        return !too_deep;
      },
      /*allow_exceptions=*/false);
  if (json.is_discarded() || !json.is_object())
    return Failure{ErrorCode::bad_input, path.string() + ": not a JSON object"};
  return json;
}

Failure bad_description(const std::filesystem::path& path, const std::string& what) {
  return {ErrorCode::bad_input, path.string() + ": " + what};
}

std::optional<std::int64_t> to_integer(const Json& value, std::int64_t low, std::int64_t high) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  const auto number = value.get<std::int64_t>();
  return number >= low && number <= high ? std::optional(number) : std::nullopt;
}

std::optional<glm::ivec3> to_integers(const Json& list, int low, int high) {
  if (!list.is_array() || list.size() != 3) return std::nullopt;
  glm::ivec3 v;
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = to_integer(list[static_cast<std::size_t>(axis)], low, high);
    if (!number) return std::nullopt;
    v[axis] = static_cast<int>(*number);
  }
  return v;
}

std::optional<glm::dvec3> to_point(const Json& list) {
  if (!list.is_array() || list.size() != 3) return std::nullopt;
  glm::dvec3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const Json& value = list[static_cast<std::size_t>(axis)];
    if (!value.is_number()) return std::nullopt;
    point[axis] = value.get<double>();
    if (!std::isfinite(point[axis])) return std::nullopt;
  }
  return point;
}

std::optional<glm::dmat4> to_transform(const Json& columns) {
  if (!columns.is_array() || columns.size() != 4) return std::nullopt;
  glm::dmat4 m(1);
  for (int column = 0; column < 4; ++column) {
    const auto v = to_point(columns[static_cast<std::size_t>(column)]);
    if (!v) return std::nullopt;
    m[column] = glm::dvec4(*v, column == 3 ? 1 : 0);
  }
  return m;
}

Json to_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json to_json(const glm::dmat4& affine) {
  Json columns = Json::array();
  for (int column = 0; column < 4; ++column) columns.push_back(to_json(glm::dvec3(affine[column])));
  return columns;
}

}  // namespace brume::grids
