#include "scene/gltf_json.hpp"

#include <cmath>

#include "scene/text_reader.hpp"

namespace brume::scene {

std::string GltfValue::place() const {
  return *file_ + ": " + (path_.empty() ? "the document" : path_);
}

void GltfValue::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_input, place() + ": " + what);
}

void GltfValue::fail_expected(const std::string& what) const {
  // Dumping a hostile value could be long: arrays and objects are only named.
  const std::string found =
      value_->is_structured()
          ? std::string("an ") + value_->type_name()
          : in_quotes(value_->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  fail("expected " + what + ", found " + found);
}

std::optional<GltfValue> GltfValue::find(const char* key) const {
  if (!value_->is_object()) fail_expected("an object");
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return GltfValue(*member, path_.empty() ? key : path_ + "." + key, file_);
}

GltfValue GltfValue::member(const char* key) const {
  auto found = find(key);
  if (!found) fail(std::string("expected a member \"") + key + "\"");
  return *std::move(found);
}

std::size_t GltfValue::size() const {
  if (!value_->is_array()) fail_expected("an array");
  return value_->size();
}

GltfValue GltfValue::operator[](std::size_t index) const {
  BRUME_ASSERT(index < size(), place());
  return GltfValue((*value_)[index], path_ + "[" + std::to_string(index) + "]", file_);
}

double GltfValue::number(double least, double most) const {
  if (!value_->is_number()) fail_expected("a number");
  const double number = value_->get<double>();
  if (!(number >= least && number <= most)) {
    fail_expected("a number from " + nlohmann::json(least).dump() + " to " + nlohmann::json(most).dump());
  }
  return number;
}

std::uint64_t GltfValue::whole(std::uint64_t most) const {
  if (!value_->is_number()) fail_expected("a whole number");
  const double number = value_->get<double>();
  if (!(number >= 0 && number <= static_cast<double>(most) && number == std::floor(number))) {
    fail_expected("a whole number up to " + std::to_string(most));
  }
  return value_->is_number_unsigned() ? value_->get<std::uint64_t>() : static_cast<std::uint64_t>(number);
}

const std::string& GltfValue::text() const {
  if (!value_->is_string()) fail_expected("a text");
  return value_->get_ref<const std::string&>();
}

bool GltfValue::is_true() const {
  return value_->is_boolean() && value_->get<bool>();
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  if (size() != count)
    fail("expected " + std::to_string(count) + " numbers, found " + std::to_string(size()));
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back((*this)[i].number(-1e30, 1e30));
  return values;
}

double GltfValue::number_or(const char* key, double otherwise, double least, double most) const {
  const auto found = find(key);
  return found ? found->number(least, most) : otherwise;
}

glm::vec3 GltfValue::vec3_or(const char* key, glm::vec3 otherwise, double least, double most) const {
  const auto found = find(key);
  if (!found) return otherwise;
  if (found->size() != 3) found->fail("expected 3 numbers, found " + std::to_string(found->size()));
  glm::vec3 value(0);
  for (int axis = 0; axis < 3; ++axis)
    value[axis] = static_cast<float>((*found)[static_cast<std::size_t>(axis)].number(least, most));
  return value;
}

std::string GltfValue::text_or(const char* key, const std::string& otherwise) const {
  const auto found = find(key);
  return found ? found->text() : otherwise;
}

nlohmann::json parse_gltf_json(std::string_view text, const std::string& file) {
  if (text.size() > kMostGltfJson) {
    throw Error(ErrorCode::resource_limit, file + ": has " + std::to_string(text.size()) +
                                               " bytes of JSON, at most " + std::to_string(kMostGltfJson) +
                                               " are read; keep the buffers in a .bin or .glb file");
  }
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    const LineColumn at = line_column(text, error.byte > 0 ? error.byte - 1 : 0);
    throw Error(ErrorCode::bad_input, file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                                          ": expected JSON, it breaks off here");
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::bad_input, file + ": the JSON holds a number too large to read");
  }
}

}  // namespace brume::scene
