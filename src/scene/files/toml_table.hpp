// Reads settings from TOML tables: every key must be known, of the right type and in range; errors name the
// place.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "core/error.hpp"

namespace brume::scene {

/// Reads one table. Each `read` takes a key that may be missing (the value is then unchanged); `finish` fails
/// for keys that were never read. The first failure is stored and later reads do nothing, so that a reader
/// can read all keys in a row and check the result once.
class TomlTable {
 public:
  /// `name` names the table in messages ("[smoke]"), `file` the file.
  TomlTable(const toml::table& table, std::string name, std::string file);

  void read(std::string_view key, float& value, double least, double most);
  void read(std::string_view key, double& value, double least, double most);
  void read(std::string_view key, std::optional<float>& value, double least, double most);
  void read(std::string_view key, std::uint32_t& value, std::int64_t least, std::int64_t most);
  void read(std::string_view key, std::optional<std::uint32_t>& value, std::int64_t least, std::int64_t most);
  void read(std::string_view key, glm::vec3& value, double least, double most);
  void read(std::string_view key, std::optional<glm::vec3>& value, double least, double most);
  /// Two numbers.
  void read(std::string_view key, std::optional<glm::vec2>& value, double least, double most);
  /// Rows of `columns` numbers in [0, 1] each.
  void read(std::string_view key, std::vector<std::vector<float>>& rows, std::size_t columns);
  void read(std::string_view key, std::optional<glm::ivec3>& value, std::int64_t least, std::int64_t most);
  void read(std::string_view key, std::string& value);
  void read(std::string_view key, bool& value);
  /// A table of the table; nothing when the key is missing.
  const toml::table* table(std::string_view key);
  /// The tables of an array of tables.
  std::vector<const toml::table*> tables(std::string_view key);

  /// "file:line:column" of the table.
  std::string place() const;
  /// The same of a key's value, or of the table if the key is missing.
  std::string place(std::string_view key) const;
  /// Fails if the key is missing.
  void require(std::string_view key);
  /// Fails at a key's value, or at the table if the key is missing.
  void fail(std::string_view key, const std::string& what);
  /// The same at an element of an array.
  void fail(std::string_view key, std::size_t element, const std::string& what);
  bool has(std::string_view key) const { return table_.get(key) != nullptr; }
  /// Whether a key's value is a string.
  bool is_text(std::string_view key) const;
  /// The first failure; otherwise the first key that was never read, with what was probably meant.
  Result<void> finish();

 private:
  const toml::node* find(std::string_view key);
  std::string place_of(const toml::source_region& where) const;
  void fail_at(const toml::source_region& where, const std::string& what);
  std::optional<double> number(const toml::node& node, std::string_view key, double least, double most);
  std::optional<std::int64_t> whole(const toml::node& node, std::string_view key, std::int64_t least,
                                    std::int64_t most);
  const toml::array* triple(const toml::node& node, std::string_view key);

  const toml::table& table_;
  std::string name_, file_;
  std::vector<std::string> known_;
  std::optional<Failure> failure_;
};

/// Parses a document; errors are "file:line:column: ...". Accepts non-ASCII characters only in comments and
/// single-line strings: elsewhere, and while it recovers from a malformed value, toml++ 3.3 tests for white
/// space and reaches undefined behaviour for some of them (U+024C).
Result<toml::table> parse_toml(std::string_view text, const std::string& file);

}  // namespace brume::scene
