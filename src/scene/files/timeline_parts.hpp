// Readers of the parts of a timeline that have a source of their own. Internal to this folder.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/files/toml_table.hpp"
#include "scene/options.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {

/// "a", "b" or "c"
std::string in_words(std::span<const char* const> names);
/// The number of the chosen name, `usual` without one.
std::size_t read_choice(TomlTable& table, const ChoiceField& field, std::size_t usual);

/// Reads settings from a table: the visitor of scene/options.hpp.
struct OptionReader {
  TomlTable& table;

  template <typename Member>
  void operator()(const OptionInfo& info, Member& member) const {
    table.read(info.key, member, info.low, info.high);
  }
  void operator()(const OptionInfo& info, float& member) const {
    if (!is_angle(info)) return table.read(info.key, member, info.low, info.high);
    double degrees = double{member} / kRadiansOfDegree;
    table.read(info.key, degrees, info.low, info.high);
    member = static_cast<float>(degrees * kRadiansOfDegree);
  }
  void operator()(const OptionInfo& info, std::uint32_t& member) const {
    table.read(info.key, member, static_cast<std::int64_t>(info.low), static_cast<std::int64_t>(info.high));
  }
  void operator()(const OptionInfo& info, std::optional<glm::ivec3>& member) const {
    table.read(info.key, member, static_cast<std::int64_t>(info.low), static_cast<std::int64_t>(info.high));
  }
  template <typename Choice>
  void operator()(const ChoiceField& field, Choice& choice) const {
    choice = static_cast<Choice>(read_choice(table, field, static_cast<std::size_t>(choice)));
  }
};

/// The time of the next key, which must be later than the last one.
template <typename Key>
void read_key_time(TomlTable& table, const std::vector<Key>& keys, double& time) {
  table.require("time");
  table.read("time", time, 0, kLatestTime);
  if (!keys.empty() && !(time > keys.back().time))
    table.fail("time", "\"time\": expected a later time than the previous key's");
}

/// What follows the key of a file that lies elsewhere.
constexpr const char* kExpectedFile = ": expected the name of a file below the folder of this file";
/// The file that a key names below the folder of `path`, if there is such a key.
void read_file_name(TomlTable& table, const std::filesystem::path& path, const char* key,
                    std::filesystem::path& file);
Result<void> read_sky(const toml::table& source, const std::filesystem::path& path, SkyOptions& sky);
/// Adds a [[camera]], which must come later than those before.
Result<void> read_camera_key(const toml::table& source, const std::filesystem::path& path,
                             std::vector<CameraKey>& keys);

// Each adds one table to a timeline whose file is `path`. Fail as load_timeline.
Result<void> read_carrier(const toml::table& source, const std::filesystem::path& path, Timeline& timeline);
Result<void> read_volume(const toml::table& source, const std::filesystem::path& path, Timeline& timeline);
Result<void> read_role(const toml::table& source, const std::filesystem::path& path, Timeline& timeline);
Result<void> read_decal(const toml::table& source, const std::filesystem::path& path, Timeline& timeline);
Result<void> read_tank(const toml::table& source, const std::filesystem::path& path, Timeline& timeline);

}  // namespace brume::scene
