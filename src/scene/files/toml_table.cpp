#include "scene/files/toml_table.hpp"

#include <algorithm>

#include "core/similar.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

/// The start of a message about a key's value.
std::string expected(std::string_view key, const char* what) {
  std::string text = "\"";
  text += key;
  text += "\": expected ";
  text += what;
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

/// The first non-ASCII byte outside of comments and single-line strings.
std::optional<std::size_t> misplaced_letter(std::string_view text) {
  enum class In { open, comment, basic, literal, long_basic, long_literal } in = In::open;
  const bool has_mark = text.starts_with("\xef\xbb\xbf");
  for (std::size_t i = has_mark ? 3 : 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_long = in == In::long_basic || in == In::long_literal;
    const bool triple = text.substr(i, 3) == "\"\"\"" || text.substr(i, 3) == "'''";
    if (static_cast<unsigned char>(c) >= 0x80) {
      if (in == In::open || is_long) return i;
    } else if (c >= '\n' && c <= '\r') {
      if (!is_long) in = In::open;
    } else if (c == '\\' && (in == In::basic || in == In::long_basic)) {
      if (i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0x80) ++i;
    } else if (in == In::open) {
      if (c == '#') in = In::comment;
      if (c == '"') in = triple ? In::long_basic : In::basic;
      if (c == '\'') in = triple ? In::long_literal : In::literal;
      if (triple) i += 2;
    } else if ((in == In::basic && c == '"') || (in == In::literal && c == '\'')) {
      in = In::open;
    } else if (is_long && triple && c == (in == In::long_basic ? '"' : '\'')) {
      // Up to two more quotes belong to the string that ends here; more are a syntax error.
      for (i += 2; i + 1 < text.size() && text[i + 1] == c;) ++i;
      in = In::open;
    }
  }
  return std::nullopt;
}

/// The text with an x for every non-ASCII character: lines and columns are preserved.
std::string ascii_twin(std::string_view text) {
  std::string twin;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) twin += c;
    if (byte >= 0xc0) twin += 'x';
  }
  return twin;
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string name, std::string file)
    : table_(table), name_(std::move(name)), file_(std::move(file)) {}

const toml::node* TomlTable::find(std::string_view key) {
  known_.emplace_back(key);
  return failure_ ? nullptr : table_.get(key);
}

std::string TomlTable::place_of(const toml::source_region& where) const {
  return file_ + ":" + std::to_string(where.begin.line) + ":" + std::to_string(where.begin.column);
}

std::string TomlTable::place() const {
  return place_of(table_.source());
}

std::string TomlTable::place(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return place_of(node ? node->source() : table_.source());
}

void TomlTable::fail_at(const toml::source_region& where, const std::string& what) {
  if (!failure_) failure_ = Failure{ErrorCode::bad_input, place_of(where) + ": " + what};
}

void TomlTable::fail(std::string_view key, const std::string& what) {
  const toml::node* node = table_.get(key);
  fail_at(node ? node->source() : table_.source(), what);
}

void TomlTable::fail(std::string_view key, std::size_t element, const std::string& what) {
  const toml::node* node = table_.get(key);
  const toml::array* array = node ? node->as_array() : nullptr;
  if (array == nullptr || element >= array->size()) return fail(key, what);
  fail_at((*array)[element].source(), what);
}

bool TomlTable::is_text(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return node != nullptr && node->is_string();
}

void TomlTable::require(std::string_view key) {
  if (table_.get(key) != nullptr) return;
  const std::string message = name_ + " lacks the key \"" + std::string(key) + "\"";
  for (const auto& [other, value] : table_)
    if (lower(other.str()) == key)
      return fail_at(other.source(), message + "; keys are in lower case, found " + in_quotes(other.str()));
  fail_at(table_.source(), message);
}

std::optional<double> TomlTable::number(const toml::node& node, std::string_view key, double least,
                                        double most) {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (value && *value >= least && *value <= most) return value;
  std::string found = value ? ", found " + shown(*value) : "";
  fail_at(node.source(), expected(key, "a number from ") + shown(least) + " to " + shown(most) + found);
  return std::nullopt;
}

std::optional<std::int64_t> TomlTable::whole(const toml::node& node, std::string_view key, std::int64_t least,
                                             std::int64_t most) {
  const std::optional<std::int64_t> value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  if (value && *value >= least && *value <= most) return value;
  std::string found = value ? ", found " + std::to_string(*value) : "";
  const std::string range = least == most ? expected(key, "") + std::to_string(least)
                                          : expected(key, "a whole number from ") + std::to_string(least) +
                                                " to " + std::to_string(most);
  fail_at(node.source(), range + found);
  return std::nullopt;
}

const toml::array* TomlTable::triple(const toml::node& node, std::string_view key) {
  const toml::array* array = node.as_array();
  if (array != nullptr && array->size() == 3) return array;
  fail_at(node.source(), expected(key, "three numbers, like [0.0, 1.0, 2.0]"));
  return nullptr;
}

void TomlTable::read(std::string_view key, double& value, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto found = number(*node, key, least, most)) value = *found;
}

void TomlTable::read(std::string_view key, float& value, double least, double most) {
  double wide = double{value};
  read(key, wide, least, most);
  value = static_cast<float>(wide);
}

void TomlTable::read(std::string_view key, std::optional<float>& value, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto found = number(*node, key, least, most)) value = static_cast<float>(*found);
}

void TomlTable::read(std::string_view key, std::uint32_t& value, std::int64_t least, std::int64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto found = whole(*node, key, least, most)) value = static_cast<std::uint32_t>(*found);
}

void TomlTable::read(std::string_view key, std::optional<std::uint32_t>& value, std::int64_t least,
                     std::int64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto found = whole(*node, key, least, most)) value = static_cast<std::uint32_t>(*found);
}

void TomlTable::read(std::string_view key, glm::vec3& value, double least, double most) {
  std::optional<glm::vec3> found;
  read(key, found, least, most);
  if (found) value = *found;
}

void TomlTable::read(std::string_view key, std::optional<glm::vec3>& value, double least, double most) {
  const toml::node* node = find(key);
  const toml::array* array = node != nullptr ? triple(*node, key) : nullptr;
  if (array == nullptr) return;
  glm::vec3 result(0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto found = number((*array)[static_cast<std::size_t>(axis)], key, least, most);
    if (!found) return;
    result[axis] = static_cast<float>(*found);
  }
  value = result;
}

void TomlTable::read(std::string_view key, std::optional<glm::vec2>& value, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2)
    return fail_at(node->source(), expected(key, "two numbers, like [0.0, 1.0]"));
  const auto low = number((*array)[0], key, least, most);
  const auto high = low ? number((*array)[1], key, least, most) : std::nullopt;
  if (high) value = glm::vec2(static_cast<float>(*low), static_cast<float>(*high));
}

void TomlTable::read(std::string_view key, std::vector<std::vector<float>>& rows, std::size_t columns) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const std::string form =
      "points of " + std::to_string(columns) + " numbers, like " +
      (columns == 2 ? "[[0.0, 0.0], [1.0, 1.0]]" : "[[0.0, 0.2, 0.3, 0.8], [1.0, 0.7, 0.0, 0.1]]");
  const toml::array* array = node->as_array();
  if (array == nullptr) return fail_at(node->source(), expected(key, form.c_str()));
  rows.clear();
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::array* const row = (*array)[i].as_array();
    if (row == nullptr || row->size() != columns)
      return fail_at((*array)[i].source(), expected(key, form.c_str()));
    std::vector<float>& numbers = rows.emplace_back();
    for (std::size_t column = 0; column < columns; ++column) {
      const auto found = number((*row)[column], key, 0, 1);
      if (!found) return;
      numbers.push_back(static_cast<float>(*found));
    }
  }
}

void TomlTable::read(std::string_view key, std::optional<glm::ivec3>& value, std::int64_t least,
                     std::int64_t most) {
  const toml::node* node = find(key);
  const toml::array* array = node != nullptr ? triple(*node, key) : nullptr;
  if (array == nullptr) return;
  glm::ivec3 result(0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto found = whole((*array)[static_cast<std::size_t>(axis)], key, least, most);
    if (!found) return;
    result[axis] = static_cast<int>(*found);
  }
  value = result;
}

void TomlTable::read(std::string_view key, std::string& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto* text = node->as_string()) {
    value = text->get();
  } else {
    fail_at(node->source(), expected(key, "a string in quotes"));
  }
}

void TomlTable::read(std::string_view key, bool& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (const auto* found = node->as_boolean()) {
    value = found->get();
  } else {
    fail_at(node->source(), expected(key, "true or false"));
  }
}

const toml::table* TomlTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) fail_at(node->source(), "expected a table [" + std::string(key) + "]");
  return node->as_table();
}

std::vector<const toml::table*> TomlTable::tables(std::string_view key) {
  std::vector<const toml::table*> result;
  const toml::node* node = find(key);
  if (node == nullptr) return result;
  const toml::array* array = node->as_array();
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    if ((*array)[i].is_table()) result.push_back((*array)[i].as_table());
  }
  if (array == nullptr || result.size() != array->size()) {
    fail_at(node->source(), "expected tables [[" + std::string(key) + "]]");
    result.clear();
  }
  return result;
}

Result<void> TomlTable::finish() {
  for (const auto& [key, value] : table_) {
    const std::string_view name = key.str();
    if (failure_ || std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string message = "unknown key " + in_quotes(name) + " in " + name_;
    fail_at(key.source(), message + suggestion(name, known_, "\""));
  }
  return failure_ ? Result<void>(*failure_) : Result<void>();
}

Result<toml::table> parse_toml(std::string_view text, const std::string& file) {
  const auto failure = [&](std::size_t line, std::size_t column, std::string_view what) {
    return Failure{ErrorCode::bad_input, file + ":" + std::to_string(line) + ":" + std::to_string(column) +
                                             ": " + std::string(what)};
  };
  if (text.find('\0') != std::string_view::npos)
    return Failure{ErrorCode::bad_input, file + ": is binary or UTF-16; expected a text file in UTF-8"};
  if (const auto byte = misplaced_letter(text)) {
    const LineColumn at = line_column(text, *byte);
    return failure(at.line, at.column,
                   "expected ASCII; other characters are allowed in comments and in single-line strings");
  }
  // If the ASCII twin parses, the document is valid and its other characters are only seen as text.
  const std::string twin = ascii_twin(text);
  toml::parse_result parsed = toml::parse(twin);
  if (parsed && twin != text) parsed = toml::parse(text);
  if (parsed) return std::move(parsed).table();
  const toml::source_position at = parsed.error().source().begin;
  return failure(at.line, at.column, parsed.error().description());
}

}  // namespace brume::scene
