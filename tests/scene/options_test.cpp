#include "scene/options.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "scene/event_fields.hpp"
#include "scene/tank_options.hpp"
#include "scene/tank_scene.hpp"
#include "scene/timeline.hpp"

namespace brume::scene {
namespace {

std::string shown(double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr;
  return {text, end};
}

/// The shortest decimal that parses to this float.
std::string shown(float value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr;
  return {text, end};
}

std::string default_text(const OptionInfo& info, float member) {
  return is_angle(info) ? shown(std::round(double{member} / kRadiansOfDegree * 100) / 100) : shown(member);
}
std::string default_text(const OptionInfo&, std::uint32_t member) {
  return std::to_string(member);
}
std::string default_text(const OptionInfo&, const glm::vec3& member) {
  if (member == glm::vec3(member.x)) return shown(member.x) + " each";
  return shown(member.x) + ", " + shown(member.y) + ", " + shown(member.z);
}

/// The rows of docs/guides/timelines.md, each up to its free text.
class RowMaker {
 public:
  explicit RowMaker(std::string table) : table_(std::move(table)) {}

  template <typename Member>
  void operator()(const OptionInfo& info, const Member& member) {
    add(info, " | " + default_text(info, member) + " | ");
  }
  /// The default is described in words.
  template <typename Member>
  void operator()(const OptionInfo& info, const std::optional<Member>& member) {
    EXPECT_FALSE(member) << info.key;
    add(info, " | ");
  }
  void operator()(const ChoiceField& field, const auto& choice) {
    const std::string name = field.names[static_cast<std::size_t>(choice)];
    rows.push_back(
        {"| " + table_ + "`" + field.key + "` | \"" + name + "\" | ", std::string("| ") + field.about});
  }
  struct Row {
    std::string start, end;
  };
  std::vector<Row> rows;

 private:
  void add(const OptionInfo& info, const std::string& defaults) {
    std::string range = shown(info.low) + " .. " + shown(info.high);
    if (*info.unit != '\0') range += std::string(" ") + info.unit;
    rows.push_back({"| " + table_ + "`" + info.key + "`" + defaults, range + " | " + info.about});
  }
  std::string table_;
};

/// Rows between a line that begins with `after` (empty: the first) and the next such.
std::string part_of(const std::string& text, const std::string& after) {
  const auto begin = text.find(after);
  EXPECT_NE(begin, std::string::npos) << after;
  const auto end = text.find("\n| `[[event]]`", begin + 1);
  return text.substr(begin, end - begin) + "\n";
}

void expect_rows(const std::string& text, const std::vector<RowMaker::Row>& rows,
                 const std::string& page = "docs/guides/timelines.md") {
  for (const auto& row : rows) {
    bool found = false;
    for (auto at = text.find("\n" + row.start); at != std::string::npos && !found;
         at = text.find("\n" + row.start, at + 1)) {
      const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
      const auto range = line.find("| " + row.end);
      found = range != std::string::npos && range + 2 >= row.start.size();
    }
    EXPECT_TRUE(found) << page << " lacks: " << row.start << "..." << row.end;
  }
}

/// Calls meet(key) for every field of an event: a visitor of scene/event_fields.hpp.
template <typename Meet>
struct KeyMeeter {
  const Meet& meet;
  void operator()(const EventRule&, const auto&, const auto&) {}
  void operator()(const auto& field, const auto&) { meet(field.key); }
};

TEST(Options, MatchTheTableInTheDocs) {
  const auto text =
      read_text_file(std::filesystem::path(BRUME_SOURCE_DIR) / "docs/guides/timelines.md").value_or_throw();
  RowMaker top(""), grid("`[grid]` "), smoke("`[smoke]` "), sky("`[sky]` "), sun("`[sun]` "),
      volume("`[[volume]]` "), mask("`[[volume.mask]]` "), disturbance("`[volume.disturb]` "),
      detail("`[volume.detail]` "), carrier("`[[carrier.key]]` "), decal("`[[decal]]` "), tank("`[[tank]]` "),
      camera("`[[camera]]` ");
  visit_timeline_options(static_cast<const Timeline&>(Timeline()), top);
  visit_grid_options(static_cast<const GridOptions&>(GridOptions()), grid);
  visit_smoke_options(static_cast<const SmokeOptions&>(SmokeOptions()), smoke);
  visit_sky_options(static_cast<const SkyOptions&>(SkyOptions()), sky);
  visit_sun_options(static_cast<const SunOptions&>(SunOptions()), sun);
  visit_volume_options(static_cast<const VolumeOptions&>(VolumeOptions()), volume);
  visit_particle_options(static_cast<const VolumeOptions&>(VolumeOptions()), volume);
  visit_mask_options(static_cast<const VolumeMask&>(VolumeMask()), mask);
  visit_disturbance_options(static_cast<const Disturbance&>(Disturbance()), disturbance);
  visit_detail_options(static_cast<const VolumeDetail&>(VolumeDetail()), detail);
  visit_carrier_options(static_cast<const CarrierKey&>(CarrierKey()), carrier);
  visit_decal_options(static_cast<const DecalOptions&>(DecalOptions()), decal);
  visit_tank_options(static_cast<const TankOptions&>(TankOptions()), tank);
  visit_camera_options(static_cast<const Camera&>(Camera()), camera);
  const std::string head = part_of(text, "| key |");
  for (const RowMaker* maker : {&top, &grid, &smoke, &sky, &sun, &volume, &mask, &disturbance, &detail,
                                &carrier, &decal, &tank, &camera})
    expect_rows(head, maker->rows);

  for_each_event_kind([&](const char* kind, auto list) {
    const std::string part = part_of(text, std::string("| `[[event]]` `type = \"") + kind + "\"`");
    const auto event = (Timeline().*list).emplace_back();
    RowMaker rows("... ");
    visit_event_numbers(event, rows);
    expect_rows(part, rows.rows);
    const auto expect_key = [&](const char* key) {
      EXPECT_NE(part.find("`" + std::string(key) + "`"), std::string::npos) << kind << ": " << key;
    };
    visit_event(event, KeyMeeter<decltype(expect_key)>{expect_key});
  });
}

TEST(Options, OfTanksMatchTheTableInTheDocs) {
  const std::string page = "docs/guides/spheres.md";
  const auto text = read_text_file(std::filesystem::path(BRUME_SOURCE_DIR) / page).value_or_throw();
  RowMaker top(""), tank("`[tank]` "), sky("`[sky]` "), fog("`[fog]` "), light("`[[light]]` "),
      glass("`[glass]` "), camera("`[[camera]]` ");
  visit_film_options(static_cast<const TankScene&>(TankScene()), top);
  visit_tone_options(static_cast<const TankScene&>(TankScene()), top);
  visit_tank_picture_options(static_cast<const TankScene&>(TankScene()), tank);
  visit_pack_options(static_cast<const spheres::PackOptions&>(spheres::PackOptions()), tank);
  visit_sky_options(static_cast<const SkyOptions&>(SkyOptions()), sky);
  visit_fog_options(static_cast<const TankFog&>(TankFog()), fog);
  visit_tank_light_options(static_cast<const TankLight&>(TankLight()), light);
  visit_glass_options(static_cast<const TankGlass&>(TankGlass()), glass);
  visit_camera_options(static_cast<const Camera&>(Camera()), camera);
  for (const RowMaker* maker : {&top, &tank, &sky, &fog, &light, &glass, &camera})
    expect_rows(text, maker->rows, page);
}

/// Checks that defaults are in range and keys are unique.
struct Checker {
  std::set<std::string> keys;

  void in_range(const OptionInfo& info, double value) const {
    EXPECT_GE(value, info.low) << info.key;
    EXPECT_LE(value, info.high) << info.key;
  }
  void meet_key(const char* key) { EXPECT_TRUE(keys.insert(key).second) << key << " is there twice"; }
  void meet(const OptionInfo& info) {
    EXPECT_LT(info.low, info.high) << info.key;
    meet_key(info.key);
  }
  void operator()(const ChoiceField& field, const auto& choice) {
    meet_key(field.key);
    EXPECT_LT(static_cast<std::size_t>(choice), field.names.size()) << field.key;
  }
  void operator()(const OptionInfo& info, float& member) {
    meet(info);
    in_range(info, is_angle(info) ? double{member} / kRadiansOfDegree : double{member});
  }
  void operator()(const OptionInfo& info, std::uint32_t& member) {
    meet(info);
    in_range(info, member);
  }
  void operator()(const OptionInfo& info, glm::vec3& member) {
    meet(info);
    for (int axis = 0; axis < 3; ++axis) in_range(info, member[axis]);
  }
  template <typename Member>
  void operator()(const OptionInfo& info, std::optional<Member>&) {
    meet(info);
  }
};

/// The number of members that the visitor must visit.
template <typename Options, typename Visit>
std::size_t met(Options options, Visit visit) {
  Checker checker;
  visit(options, checker);
  return checker.keys.size();
}

/// Stands in for a member of any type.
struct AnyMember {
  template <typename Member>
  operator Member() const;
};

/// The number of members of an aggregate without bases.
template <typename Aggregate, typename... Members>
constexpr std::size_t members_of() {
  if constexpr (requires { Aggregate{Members()..., AnyMember()}; })
    return members_of<Aggregate, Members..., AnyMember>();
  else
    return sizeof...(Members);
}

TEST(Options, AreCompleteWithDefaultsInRange) {
#define MET(options, visit) met(options, [](auto& o, auto& v) { visit(o, v); })
  constexpr std::size_t kPictureSettings = members_of<PictureSettings<>>();
  EXPECT_EQ(MET(Timeline(), visit_picture_options), kPictureSettings);
  EXPECT_EQ(MET(Timeline(), visit_timeline_options), kPictureSettings + 4);
  EXPECT_EQ(MET(GridOptions(), visit_grid_options), 3u);
  EXPECT_EQ(MET(SmokeOptions(), visit_smoke_options), 16u);
  EXPECT_EQ(MET(SkyOptions(), visit_sky_options), 5u);
  EXPECT_EQ(MET(SunOptions(), visit_sun_options), 3u);
  EXPECT_EQ(MET(VolumeOptions(), visit_volume_options), 14u);
  EXPECT_EQ(MET(VolumeMask(), visit_mask_options), 2u);
  EXPECT_EQ(MET(MaskKey(), visit_mask_options), 2u);
  EXPECT_EQ(MET(Disturbance(), visit_disturbance_options), 4u);
  EXPECT_EQ(MET(VolumeDetail(), visit_detail_options), 3u);
  EXPECT_EQ(MET(VolumeOptions(), visit_particle_options), 2u);
  EXPECT_EQ(MET(CarrierKey(), visit_carrier_options), 1u);
  EXPECT_EQ(MET(DecalOptions(), visit_decal_options), 8u);
  EXPECT_EQ(MET(TankOptions(), visit_tank_options), 3u);
  EXPECT_EQ(MET(Camera(), visit_camera_options), 5u);
  for_each_event_kind([](const char*, auto list) {
    const auto event = (Timeline().*list).emplace_back();
    MET(event, visit_event_numbers);
  });
  EXPECT_EQ(MET(TankScene(), visit_film_options), 2u);
  EXPECT_EQ(MET(TankScene(), visit_tank_picture_options), 4u);
  EXPECT_EQ(MET(spheres::PackOptions(), visit_pack_options), 5u);
  EXPECT_EQ(MET(TankFog(), visit_fog_options), 2u);
  EXPECT_EQ(MET(TankLight(), visit_tank_light_options), 4u);
  EXPECT_EQ(MET(TankGlass(), visit_glass_options), 3u);
#undef MET
}

}  // namespace
}  // namespace brume::scene
