#include "apps/command_line/json.hpp"

#include <charconv>
#include <nlohmann/json.hpp>

namespace brume::cli {

using Value = nlohmann::ordered_json;

Json::Json(std::nullptr_t) : value_(std::make_unique<Value>()) {}
Json::Json(Boolean boolean) : value_(std::make_unique<Value>(boolean.value)) {}
Json::Json(Signed number) : value_(std::make_unique<Value>(number.value)) {}
Json::Json(Unsigned number) : value_(std::make_unique<Value>(number.value)) {}
Json::Json(Real number) : value_(std::make_unique<Value>(number.value)) {}
Json::Json(float value) {
  // Infinite values and NaN become null.
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double shortest = static_cast<double>(value);
  std::from_chars(text, end, shortest);
  value_ = std::make_unique<Value>(shortest);
}
Json::Json(const char* text) : value_(std::make_unique<Value>(text)) {}
Json::Json(const std::string& text) : value_(std::make_unique<Value>(text)) {}
Json::Json(const std::vector<std::string>& texts) : value_(std::make_unique<Value>(texts)) {}

Json::Json(std::initializer_list<Member> members) : value_(std::make_unique<Value>(Value::object())) {
  for (const Member& member : members) set(member.key, member.value);
}

Json Json::object() {
  return Json(std::initializer_list<Member>{});
}

Json Json::list(std::initializer_list<Json> values) {
  Json list(nullptr);
  *list.value_ = Value::array();
  for (const Json& value : values) list.push_back(value);
  return list;
}

Json::Json(const Json& other) : value_(std::make_unique<Value>(*other.value_)) {}
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json& Json::operator=(const Json& other) {
  return *this = Json(other);
}

void Json::set(const std::string& key, const Json& value) {
  (*value_)[key] = *value.value_;
}

void Json::update(const Json& members) {
  value_->update(*members.value_);
}

void Json::push_back(const Json& value) {
  value_->push_back(*value.value_);
}

std::string Json::dump() const {
  // File names need not be UTF-8.
  return value_->dump(2, ' ', false, Value::error_handler_t::replace);
}

std::string Json::text() const {
  return value_->is_string() ? value_->get<std::string>() : value_->dump();
}

}  // namespace brume::cli
