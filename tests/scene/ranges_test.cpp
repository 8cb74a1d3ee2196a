// Ranges that other files repeat are those of scene/options.hpp: Blender's add-on, the C headers, their page.
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "scene/event_fields.hpp"
#include "scene/tank_options.hpp"
#include "scene/tank_scene.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {
namespace {

namespace fs = std::filesystem;

/// Of lines in Python.
constexpr std::size_t kWidth = 120;
const fs::path kRoot = BRUME_SOURCE_DIR;

std::string text_of_file(const fs::path& path) {
  return read_text_file(kRoot / path).value_or_throw();
}

/// The shortest text that reads as the same number in Python.
template <typename Number>
std::string decimal(Number value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// A float in Python, which an integer is not.
std::string real(float value) {
  const std::string text = decimal(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// Settings as a dictionary in Python: a visitor of scene/options.hpp.
class PythonSettings {
 public:
  /// `indent`: blanks in front of its end.
  explicit PythonSettings(std::size_t indent) : indent_(indent, ' ') {}
  void operator()(const OptionInfo& info, float member) {
    row(info,
        real(is_angle(info) ? static_cast<float>(std::round(double{member} / kRadiansOfDegree * 100) / 100)
                            : member));
  }
  void operator()(const OptionInfo& info, std::uint32_t member) { row(info, decimal(member)); }
  void operator()(const OptionInfo& info, const glm::vec3& v) {
    row(info, "(" + real(v.x) + ", " + real(v.y) + ", " + real(v.z) + ")");
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const std::optional<Member>&) {
    row(info, "None");
  }
  std::string text() const { return text_.empty() ? "{}" : "{\n" + text_ + indent_ + "}"; }

 private:
  void row(const OptionInfo& info, const std::string& initial) {
    const std::string start = indent_ + "    \"" + info.key + "\": Setting(";
    const std::string values = initial + ", " + decimal(info.low) + ", " + decimal(info.high) + ", \"" +
                               info.unit + "\", \"" + info.about + "\"";
    const bool fits = start.size() + values.size() + 2 <= kWidth;
    text_ += start + (fits ? values : "\n        " + indent_ + values + "\n    " + indent_) + "),\n";
  }
  std::string indent_, text_;
};

/// Texts in Python: ("a", "b").
std::string tuple_of(const std::vector<std::string>& texts) {
  std::string text;
  for (const std::string& one : texts) text += (text.empty() ? "" : ", ") + one;
  return "(" + text + (texts.size() == 1 ? ",)" : ")");
}

/// Fields and rules of an event in Python: a visitor of scene/event_fields.hpp.
class PythonEvent {
 public:
  void operator()(const OptionInfo&, const auto&) {}
  void operator()(const PointField& field, const auto&) { points_.push_back(quoted(field.key)); }
  void operator()(const TextField& field, const auto&) {
    if (field.most_bytes < SIZE_MAX)
      bytes_.push_back(
          tuple_of({quoted(field.key), std::to_string(field.least_bytes), std::to_string(field.most_bytes)}));
  }
  void operator()(const EventRule& rule, const auto&, const auto&) {
    static constexpr const char* kKinds[] = {"differs", "at_least", "above", "goes_with"};
    rules_.push_back(
        tuple_of({quoted(kKinds[static_cast<int>(rule.kind)]), quoted(rule.key), quoted(rule.other)}));
  }
  void operator()(const auto&, const auto&) {}
  std::string text() const { return tuple_of(points_) + ", " + tuple_of(bytes_) + ", " + tuple_of(rules_); }

 private:
  static std::string quoted(const char* text) { return '"' + std::string(text) + '"'; }
  std::vector<std::string> points_, bytes_, rules_;
};

/// What follows the hand-written head of the add-on's settings.py.
std::string tables_for_blender() {
  std::string text = "SETTINGS = {\n";
  const auto add = [&](const char* table, const auto& defaults, auto visit) {
    PythonSettings settings(4);
    visit(defaults, settings);
    text += std::string("    \"") + table + "\": " + settings.text() + ",\n";
  };
  add("timeline", Timeline(), [](auto& o, auto& v) { visit_film_options(o, v); });
  add("grid", GridOptions(), [](auto& o, auto& v) { visit_grid_options(o, v); });
  add("smoke", SmokeOptions(), [](auto& o, auto& v) { visit_smoke_options(o, v); });
  add("volume", VolumeOptions(), [](auto& o, auto& v) { visit_volume_options(o, v); });
  add("camera", Camera(), [](auto& o, auto& v) { visit_camera_options(o, v); });
  text += "}\n\nEVENT_FIELDS = {\n";
  for_each_event_kind([&](const char* kind, auto list) {
    const auto event = (Timeline().*list).emplace_back();
    PythonSettings numbers(8);
    visit_event_numbers(event, numbers);
    PythonEvent fields;
    visit_event(event, fields);
    text += std::string("    \"") + kind + "\": EventFields(\n        " + fields.text() + ",\n        " +
            numbers.text() + ",\n    ),\n";
  });
  return text + "}\n";
}

TEST(Ranges, AreThoseOfTheAddon) {
  const fs::path path = kRoot / "integrations/blender/brume_blender/settings.py";
  const std::string text = read_text_file(path).value_or_throw();
  const auto begin = text.find("SETTINGS = {");
  ASSERT_NE(begin, std::string::npos);
  const std::string tables = tables_for_blender();
  if (std::getenv("BRUME_UPDATE"))
    ASSERT_TRUE(write_file_atomic(path, text.substr(0, begin) + tables));
  else
    EXPECT_EQ(text.substr(begin), tables) << "BRUME_UPDATE=1 writes them";
}

/// "10^6", "2^22", "1e-6"
double number_of(const std::string& text) {
  const auto power = text.find('^');
  if (power == std::string::npos) return std::stod(text);
  return std::pow(std::stod(text.substr(0, power)), std::stod(text.substr(power + 1)));
}

/// Compares the ranges that a struct of a C header states with those of its settings.
class HeaderCheck {
 public:
  HeaderCheck(const char* header, const std::string& name, std::string prefix = "")
      : prefix_(std::move(prefix)) {
    const std::string text = text_of_file(std::string("include/brume/") + header);
    const auto begin = text.find("typedef struct " + name + " {"), end = text.find("} " + name + ";");
    EXPECT_TRUE(begin < end && end != std::string::npos) << name;
    struct_ = text.substr(begin, end - begin);
  }
  ~HeaderCheck() { EXPECT_EQ(found_, expected_); }
  HeaderCheck(const HeaderCheck&) = delete;

  template <typename Member>
  void operator()(const OptionInfo& info, const Member&) {
    const std::string key = prefix_ + info.key;
    // The member, with the comment behind it or above it.
    const std::regex behind("\\n *\\w+ " + key + "(?:\\[3\\])?; *(///<[^\\n]*)"),
        above("((?:\\n *///[^<\\n][^\\n]*)+)\\n *\\w+ " + key + ";"), range("\\[([^,\\] ]+), ([^,\\] ]+)\\]");
    std::smatch match;
    if (!std::regex_search(struct_, match, behind) && !std::regex_search(struct_, match, above)) return;
    const std::string comment = match[1];
    if (!std::regex_search(comment, match, range)) return;
    const std::string low = match[1], high = match[2];
    EXPECT_EQ(number_of(low), info.low) << key;
    EXPECT_EQ(number_of(high), info.high) << key;
    ++found_;
  }
  HeaderCheck& expect(int members) {
    expected_ = members;
    return *this;
  }

 private:
  std::string prefix_, struct_;
  int found_ = 0, expected_ = 0;
};

TEST(Ranges, AreThoseOfTheHeaders) {
  const SmokeOptions smoke;
  const VolumeOptions volume;
  const DecalOptions decal;
  const TankScene tank;
  const spheres::PackOptions pack;
  visit_smoke_options(smoke, HeaderCheck("brume.h", "brume_drawn_params").expect(6));
  visit_smoke_options(smoke, HeaderCheck("brume_vulkan.h", "brume_smoke_look").expect(8));
  visit_volume_options(volume, HeaderCheck("brume_assets.h", "brume_volume_params").expect(1));
  visit_volume_options(volume, HeaderCheck("brume_assets.h", "brume_shown_volume").expect(6));
  visit_decal_options(decal, HeaderCheck("brume_assets.h", "brume_shown_decal").expect(6));
  visit_pack_options(pack, HeaderCheck("brume_assets.h", "brume_tank_params").expect(1));
  visit_tank_picture_options(tank, HeaderCheck("brume_assets.h", "brume_tank_lighting").expect(2));
  visit_fog_options(tank.fog, HeaderCheck("brume_assets.h", "brume_tank_lighting", "fog_").expect(2));
  const TankGlass glass;
  visit_glass_options(glass, HeaderCheck("brume_assets.h", "brume_tank_lighting", "glass_").expect(2));
  const TankLight light;
  visit_tank_light_options(light, HeaderCheck("brume_assets.h", "brume_tank_light").expect(2));
}

/// "[0, 1]", as tables of the page show a range.
std::string range_text(const OptionInfo& info) {
  return "[" + decimal(info.low) + ", " + decimal(info.high) + "]";
}

TEST(Ranges, AreThoseOfThePageOfTheCInterface) {
  const std::string page = text_of_file("docs/reference/c-api.md");
  const auto info = [](const char* key) {
    return info_of<SmokeOptions>(key, [](auto& o, auto& v) { visit_smoke_options(o, v); });
  };
  for (const auto& [first, second] :
       {std::pair("albedo", "anisotropy"), std::pair("noise_size", "hole_rim"), std::pair("swirl", "rise")}) {
    const auto row = page.find(std::string("| `look.") + first + "`");
    ASSERT_NE(row, std::string::npos) << first;
    const std::string line = page.substr(row, page.find('\n', row) - row);
    EXPECT_NE(line.find(range_text(info(first)) + ", " + range_text(info(second))), std::string::npos)
        << line;
  }
}

}  // namespace
}  // namespace brume::scene
