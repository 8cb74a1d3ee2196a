#include "scene/files/timeline_writer.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "scene/event_fields.hpp"
#include "scene/files/file_collector.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/toml_text.hpp"
#include "scene/tank_scene.hpp"

namespace brume::scene {
namespace {

namespace fs = std::filesystem;

/// The fields of an event as TOML: the visitor of scene/event_fields.hpp.
struct EventTexts {
  const fs::path& folder;
  struct Line {
    const char* key;
    std::string text;
    bool required;
  };
  std::vector<Line> lines = {};

  void operator()(const OptionInfo& info, const auto& member) { add_option(info, member); }
  void operator()(const ChoiceField& field, const auto& choice) { add_option(field, choice); }
  void operator()(const FileField& field, const fs::path& file) {
    lines.push_back(
        {field.key, file.empty() ? "" : to_text(path_from(file, folder).generic_string()), false});
  }
  void operator()(const EventRule&, const auto&, const auto&) {}
  void operator()(const auto& field, const auto& member) {
    lines.push_back({field.key, to_text(member), true});
  }

 private:
  void add_option(const auto& field, const auto& member) {
    OptionTexts option;
    option(field, member);
    lines.push_back({field.key, option.texts.front().second, false});
  }
};

/// Copies the files of events.
struct EventFiles {
  FileCollector& files;
  Result<void>& outcome;
  void operator()(const FileField&, fs::path& file) {
    if (outcome) outcome = files.collect(file);
  }
  void operator()(const auto&, const auto&...) {}
};

class Writer : private TomlText {
 public:
  explicit Writer(const fs::path& folder) : TomlText(folder) {}

  std::string write(const Timeline& timeline) {
    write_head(timeline);
    for (const Carrier& carrier : timeline.carriers) write_carrier(carrier);
    for (const VolumeOptions& volume : timeline.volumes) write_volume(volume);
    for (const DecalOptions& decal : timeline.decals) write_decal(decal);
    for (const TankOptions& tank : timeline.tanks) write_tank(tank);
    for (const RoleOptions& role : timeline.roles) write_role(role);
    for (const CameraKey& key : timeline.camera) camera(key);
    write_events(timeline);
    return std::move(text_);
  }

 private:
  void write_head(const Timeline& timeline) {
    text_ += "version = 1\n";
    line("scene", path_from(timeline.scene, folder_).generic_string());
    options(timeline, Timeline(), "", [](auto& o, auto& v) { visit_timeline_options(o, v); });
    options(timeline.grid, GridOptions(), "\n[grid]\n", [](auto& o, auto& v) { visit_grid_options(o, v); });
    SmokeOptions smoke = timeline.smoke;
    if (smoke.droplet) smoke.anisotropy = SmokeOptions().anisotropy;
    options(smoke, SmokeOptions(), "\n[smoke]\n", [](auto& o, auto& v) { visit_smoke_options(o, v); });
    options(timeline.sky, SkyOptions(), "\n[sky]\n", [](auto& o, auto& v) { visit_sky_options(o, v); });
    if (!timeline.sun) return;
    text_ += "\n[sun]\n";
    options(*timeline.sun, SunOptions(), "", [](auto& o, auto& v) { visit_sun_options(o, v); });
  }

  void write_volume(const VolumeOptions& volume) {
    text_ += "\n[[volume]]\n";
    line("file", path_from(volume.file, folder_).generic_string());
    if (volume.first) line("first", *volume.first);
    if (volume.last) line("last", *volume.last);
    if (volume.clip) line("clip", volume.clip);
    if (volume.ping_pong) line("ping_pong", volume.ping_pong);
    if (!volume.density.empty()) line("density", volume.density);
    if (!volume.heat.empty()) line("heat", volume.heat);
    if (!volume.color.empty()) line("color", volume.color);
    line("position", volume.position_world);

    // Options that differ from their defaults, one of which masks change.
    VolumeOptions defaults;
    if (!volume.masks.empty()) defaults.extinction = kMaskedExtinction;
    options(volume, defaults, "", [](auto& o, auto& v) { visit_volume_options(o, v); });
    if (volume.loop) line("loop", volume.loop);

    // The transfer function.
    if (volume.range) line("range", *volume.range);
    std::vector<std::vector<float>> rows;
    for (const OpacityPoint& point : volume.opacity) rows.push_back({point.at, point.opacity});
    if (!rows.empty()) line("opacity", rows);
    rows.clear();
    for (const auto& [at, color] : volume.color_map.points) rows.push_back({at, color.r, color.g, color.b});
    if (!volume.color_map.name.empty()) line("color_map", volume.color_map.name);
    if (!rows.empty()) line("color_map", rows);
    if (!volume.carrier.empty()) line("carrier", volume.carrier);

    // Particles, then tables.
    options(volume, VolumeOptions(), "", [](auto& o, auto& v) { visit_particle_options(o, v); });
    write_noise(volume.disturbance, "\n[volume.disturb]\n",
                [](auto& o, auto& v) { visit_disturbance_options(o, v); });
    write_noise(volume.detail, "\n[volume.detail]\n", [](auto& o, auto& v) { visit_detail_options(o, v); });
    for (const VolumeMask& mask : volume.masks) write_mask(mask);
  }

  /// A table of noise, whose reader requires the strength, also where it is the default.
  template <typename Noise, typename Visit>
  void write_noise(const Noise& noise, const char* title, const Visit& visit) {
    const std::size_t before = text_.size();
    options(noise, Noise(), title, visit);
    const bool has_strength = to_text(noise.strength) != to_text(Noise().strength);
    if (text_.size() > before && !has_strength) line("strength", noise.strength);
  }

  void write_mask(const VolumeMask& mask) {
    text_ += "\n[[volume.mask]]\n";
    line("grid", mask.grid);
    options(mask, VolumeMask(), "", [](auto& o, auto& v) { visit_mask_options(o, v); });
    for (const MaskKey& key : mask.keys) {
      text_ += "\n[[volume.mask.key]]\n";
      line("time", key.time);
      line("color", key.color);
      line("intensity", key.intensity);
    }
  }

  void write_carrier(const Carrier& carrier) {
    text_ += "\n[[carrier]]\n";
    line("name", carrier.name);
    if (!carrier.object.empty()) line("object", carrier.object);
    for (const CarrierKey& key : carrier.keys) {
      text_ += "\n[[carrier.key]]\n";
      line("time", key.time);
      line("position", key.position_world);
      options(key, CarrierKey(), "", [](auto& o, auto& v) { visit_carrier_options(o, v); });
    }
  }

  void write_decal(const DecalOptions& decal) {
    text_ += "\n[[decal]]\n";
    line("file", path_from(decal.file, folder_).generic_string());
    if (!decal.grid.empty()) line("grid", decal.grid);
    if (!decal.carrier.empty()) line("carrier", decal.carrier);
    line("position", decal.position_world);
    options(decal, DecalOptions(), "", [](auto& o, auto& v) { visit_decal_options(o, v); });
  }

  void write_tank(const TankOptions& tank) {
    text_ += "\n[[tank]]\n";
    line("file", path_from(tank.file, folder_).generic_string());
    if (!tank.carrier.empty()) line("carrier", tank.carrier);
    line("position", tank.position_world);
    options(tank, TankOptions(), "", [](auto& o, auto& v) { visit_tank_options(o, v); });
    if (tank.view) line("view", std::string(view_name(*tank.view)));
  }

  void write_role(const RoleOptions& role) {
    text_ += "\n[[role]]\n";
    line("object", role.object);
    line("role", std::string(name_of(role.role)));
  }

  /// Writes all events by time; events of the same time in the order in which they happen.
  void write_events(const Timeline& timeline) {
    struct EventText {
      double time;
      bool changes_level;
      std::string text;
    };
    std::vector<EventText> events;
    std::string head = std::move(text_);
    for_each_event_list(timeline, [&](const char* type, const auto& list) {
      for (const auto& event : list) {
        text_.clear();
        text_ += "\n[[event]]\ntype = \"" + std::string(type) + "\"\n";
        line("time", event.time);
        write_event(event);
        events.push_back({event.time, changes_level(event), std::move(text_)});
      }
    });
    // The level changes before anything else of the same time happens.
    std::stable_sort(events.begin(), events.end(), [](const EventText& a, const EventText& b) {
      return a.time != b.time ? a.time < b.time : a.changes_level && !b.changes_level;
    });
    text_ = std::move(head);
    for (const EventText& event : events) text_ += event.text;
  }

  template <typename Event>
  static constexpr bool changes_level(const Event&) {
    return std::is_same_v<Event, EditEvent> || std::is_same_v<Event, DoorEvent>;
  }

  /// Points, texts and flags always; what has a default where it differs.
  template <typename Event>
  void write_event(const Event& event) {
    EventTexts texts{folder_}, defaults{folder_};
    visit_event(event, texts);
    static const Event kUsual;
    visit_event(kUsual, defaults);
    for (std::size_t i = 0; i < texts.lines.size(); ++i)
      if (texts.lines[i].required || texts.lines[i].text != defaults.lines[i].text)
        text_ += std::string(texts.lines[i].key) + " = " + texts.lines[i].text + "\n";
  }
};

}  // namespace

std::string format_timeline(const Timeline& timeline, const fs::path& folder) {
  return Writer(folder).write(timeline);
}

Result<void> save_timeline(const fs::path& path, const Timeline& timeline) {
  Timeline saved = timeline;
  FileCollector files(path);
  Result<void> outcome;
  for_each_event_list(saved, [&](const char*, auto& events) {
    for (auto& event : events) visit_event(event, EventFiles{files, outcome});
  });
  if (!outcome) return outcome;
  for (CameraKey& key : saved.camera)
    if (auto done = files.collect(key.camera.lens.opening); !done) return done;
  const std::string text = format_timeline(saved, path.parent_path());
  // Never write a timeline that could not be read back.
  if (const auto read = parse_timeline(text, path); !read) return not_saved(read.failure(), path);
  if (auto copied = files.copy_files(); !copied) return copied;
  return write_file_atomic(path, text);
}

}  // namespace brume::scene
