// Texts of TOML files that read back bit for bit: what the writers of scenes share. Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "scene/camera_path.hpp"
#include "scene/options.hpp"

namespace brume::scene {

// A value as TOML: numbers as the shortest decimals that read back as the same.
std::string to_text(double value);
std::string to_text(float value);
std::string to_text(int value);
std::string to_text(std::uint32_t value);
std::string to_text(bool value);
std::string to_text(const std::string& value);
std::string to_text(const glm::vec2& v);
std::string to_text(const glm::vec3& v);
std::string to_text(const glm::ivec3& v);
std::string to_text(const std::vector<float>& numbers);
std::string to_text(const std::vector<std::vector<float>>& rows);
/// Degrees that the reader converts to the same radians: as few digits as possible, within the angle's range.
std::string degrees_text(const OptionInfo& info, float radians);

/// Why a text that was to be saved as `path` cannot be read back, without its line: there is no such file.
Failure not_saved(const Failure& failure, const std::filesystem::path& path);

/// `path` relative to a folder; its spelling is preserved if it begins with the folder's name.
std::filesystem::path path_from(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Settings and their texts; none for an absent one.
class OptionTexts {
 public:
  void operator()(const OptionInfo& info, const float& member) {
    add(info.key, is_angle(info) ? degrees_text(info, member) : to_text(member));
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const Member& member) {
    add(info.key, to_text(member));
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const std::optional<Member>& member) {
    add(info.key, member ? to_text(*member) : "");
  }
  void operator()(const ChoiceField& field, const auto& choice) {
    add(field.key, to_text(std::string(field.names[static_cast<std::size_t>(choice)])));
  }
  std::vector<std::pair<const char*, std::string>> texts;

 private:
  void add(const char* key, std::string text) { texts.emplace_back(key, std::move(text)); }
};

/// The text of a file, line by line.
class TomlText {
 public:
  explicit TomlText(const std::filesystem::path& folder) : folder_(folder) {}

 protected:
  template <typename Value>
  void line(const char* key, const Value& value) {
    text_ += std::string(key) + " = " + to_text(value) + "\n";
  }

  /// Writes the options that differ from their defaults, under a title.
  template <typename Options, typename Visit>
  void options(const Options& chosen, const Options& defaults, const char* title, Visit visit) {
    OptionTexts texts, default_texts;
    visit(chosen, texts);
    visit(defaults, default_texts);
    bool titled = false;
    for (std::size_t i = 0; i < texts.texts.size(); ++i) {
      const auto& [key, text] = texts.texts[i];
      if (text == default_texts.texts[i].second) continue;
      if (!std::exchange(titled, true)) text_ += title;
      text_ += std::string(key) + " = " + text + "\n";
    }
  }
  /// A [[camera]]: the field of view always, of the lens what is not as usual.
  void camera(const CameraKey& key);

  const std::filesystem::path& folder_;
  std::string text_;
};

}  // namespace brume::scene
