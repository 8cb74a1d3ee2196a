// A glTF document's JSON, read with the path of each value at hand for error messages.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume::scene {

/// One value of the document. Everything here throws brume::Error (bad_input) with "file: path: expected
/// ..., " when the value is not what was asked for; parse_gltf turns that into its Result.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& value, std::string path, std::shared_ptr<const std::string> file)
      : value_(&value), path_(std::move(path)), file_(std::move(file)) {}

  /// A member of an object; nothing when it is missing.
  std::optional<GltfValue> find(const char* key) const;
  /// A member that must be there.
  GltfValue member(const char* key) const;
  /// An array's length and elements.
  std::size_t size() const;
  GltfValue operator[](std::size_t index) const;

  double number(double least, double most) const;
  std::uint64_t whole(std::uint64_t most) const;
  const std::string& text() const;
  bool is_true() const;
  bool is_object() const { return value_->is_object(); }
  /// `count` numbers.
  std::vector<double> numbers(std::size_t count) const;

  /// Members with a value to fall back on.
  double number_or(const char* key, double otherwise, double least, double most) const;
  glm::vec3 vec3_or(const char* key, glm::vec3 otherwise, double least, double most) const;
  std::string text_or(const char* key, const std::string& otherwise) const;

  [[noreturn]] void fail(const std::string& what) const;
  /// "file: path".
  std::string place() const;
  const std::shared_ptr<const std::string>& file() const { return file_; }

 private:
  [[noreturn]] void fail_expected(const std::string& what) const;

  const nlohmann::json* value_;
  std::string path_;
  std::shared_ptr<const std::string> file_;
};

/// Most bytes of a document's JSON.
constexpr std::uint64_t kMostGltfJson = 1ull << 26;

/// Parses the JSON; syntax errors are "file:line:column: ...". Throws brume::Error.
nlohmann::json parse_gltf_json(std::string_view text, const std::string& file);

}  // namespace brume::scene
