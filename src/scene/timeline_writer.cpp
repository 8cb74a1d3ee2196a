#include "scene/timeline_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "scene/files.hpp"
#include "scene/options.hpp"

namespace brume::scene {
namespace {

namespace fs = std::filesystem;

/// Formats a number as a TOML float.
template <typename Number>
std::string decimal(Number value) {
  const double size = std::abs(double{value});
  const bool plain = size == 0 || (size >= 1e-5 && size < 1e15);
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 plain ? std::chars_format::fixed : std::chars_format::scientific);
  std::string text(buffer.data(), end.ptr);
  if (plain && text.find('.') == std::string::npos) text += ".0";
  return text;
}

double read_back(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

std::string text_of(double value) {
  return decimal(value);
}

std::string text_of(float value) {
  // The reader rounds to double first, which in rare cases gives another float.
  std::string text = decimal(value);
  return static_cast<float>(read_back(text)) == value ? text : decimal(double{value});
}

/// Degrees that the reader converts to the same radians: as few digits as possible, within the angle's range.
std::string degrees_text(const OptionInfo& info, float radians) {
  const double degrees = double{radians} / kRadiansOfDegree;
  for (int digits = 1; digits < 17; ++digits) {
    std::array<char, 64> buffer;
    const int length = std::snprintf(buffer.data(), buffer.size(), "%.*e", digits - 1, degrees);
    const double rounded = read_back({buffer.data(), static_cast<std::size_t>(length)});
    if (rounded < info.low || rounded > info.high) continue;
    if (static_cast<float>(rounded * kRadiansOfDegree) == radians) return decimal(rounded);
  }
  return decimal(degrees);
}

std::string text_of(int value) {
  return std::to_string(value);
}

std::string text_of(std::uint32_t value) {
  return std::to_string(value);
}

template <typename Vector>
std::string triple(const Vector& v) {
  std::string text = "[";
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ", ";
    text += text_of(v[axis]);
  }
  text += ']';
  return text;
}

std::string text_of(const std::vector<float>& numbers) {
  std::string text;
  for (const float number : numbers) text += (text.empty() ? "[" : ", ") + text_of(number);
  return text + ']';
}

std::string text_of(const glm::vec2& v) {
  return text_of(std::vector{v.x, v.y});
}

std::string text_of(const std::vector<std::vector<float>>& rows) {
  std::string text;
  for (const std::vector<float>& row : rows) text += (text.empty() ? "[" : ", ") + text_of(row);
  return text + ']';
}

std::string text_of(const glm::vec3& v) {
  return triple(v);
}

std::string text_of(const glm::ivec3& v) {
  return triple(v);
}

std::string text_of(bool value) {
  return value ? "true" : "false";
}

std::string text_of(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      std::array<char, 8> escape;
      std::snprintf(escape.data(), escape.size(), "\\u%04X", unsigned{byte});
      text += escape.data();
    } else {
      text += c;
    }
  }
  text += '"';
  return text;
}

/// Settings and their texts; none for an absent one.
class OptionTexts {
 public:
  void operator()(const OptionInfo& info, const float& member) {
    add(info, is_angle(info) ? degrees_text(info, member) : text_of(member));
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const Member& member) {
    add(info, text_of(member));
  }
  template <typename Member>
  void operator()(const OptionInfo& info, const std::optional<Member>& member) {
    add(info, member ? text_of(*member) : "");
  }
  std::vector<std::pair<const char*, std::string>> texts;

 private:
  void add(const OptionInfo& info, std::string text) { texts.emplace_back(info.key, std::move(text)); }
};

/// `path` relative to a folder; its spelling is preserved if it begins with the folder's name.
fs::path path_from(const fs::path& path, const fs::path& folder) {
  const fs::path below = path.lexically_relative(folder);
  if (is_safe_relative(below.generic_string())) return below;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  const fs::path base = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder, error), error);
  if (error || whole.empty() || base.empty()) return path;
  const bool have_a_folder_in_common = std::next(whole.begin()) != whole.end() &&
                                       std::next(base.begin()) != base.end() &&
                                       *std::next(whole.begin()) == *std::next(base.begin());
  return have_a_folder_in_common ? whole.lexically_relative(base) : whole;
}

class Writer {
 public:
  explicit Writer(const fs::path& folder) : folder_(folder) {}

  std::string write(const Timeline& timeline) {
    write_head(timeline);
    for (const Carrier& carrier : timeline.carriers) write_carrier(carrier);
    for (const VolumeOptions& volume : timeline.volumes) write_volume(volume);
    for (const DecalOptions& decal : timeline.decals) write_decal(decal);
    for (const CameraKey& key : timeline.camera) {
      text_ += "\n[[camera]]\n";
      line("time", key.time);
      line("position", key.camera.position_world);
      line("target", key.camera.target_world);
      static const Camera kUsualCamera;
      // The field of view always, of the lens what is not as usual.
      OptionTexts texts, usual;
      visit_camera_options(key.camera, texts);
      visit_camera_options(kUsualCamera, usual);
      for (std::size_t i = 0; i < texts.texts.size(); ++i)
        if (i == 0 || texts.texts[i] != usual.texts[i])
          text_ += std::string(texts.texts[i].first) + " = " + texts.texts[i].second + "\n";
      if (!key.camera.lens.opening.empty())
        line("opening", path_from(key.camera.lens.opening, folder_).generic_string());
    }
    write_events(timeline);
    return std::move(text_);
  }

 private:
  void write_head(const Timeline& timeline) {
    text_ += "version = 1\n";
    line("scene", path_from(timeline.scene, folder_).generic_string());
    options(timeline, Timeline(), "", [](auto& o, auto& v) { visit_timeline_options(o, v); });
    if (timeline.tone == ToneCurve::standard) line("tone", std::string("standard"));
    options(timeline, Timeline(), "", [](auto& o, auto& v) { visit_level_options(o, v); });
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
    VolumeOptions defaults;
    if (!volume.masks.empty()) defaults.extinction = kMaskedExtinction;
    options(volume, defaults, "", [](auto& o, auto& v) { visit_volume_options(o, v); });
    if (volume.loop) line("loop", volume.loop);
    if (volume.range) line("range", *volume.range);
    std::vector<std::vector<float>> rows;
    for (const OpacityPoint& point : volume.opacity) rows.push_back({point.at, point.opacity});
    if (!rows.empty()) line("opacity", rows);
    rows.clear();
    for (const auto& [at, color] : volume.color_map.points) rows.push_back({at, color.r, color.g, color.b});
    if (!volume.color_map.name.empty()) line("color_map", volume.color_map.name);
    if (!rows.empty()) line("color_map", rows);
    if (!volume.carrier.empty()) line("carrier", volume.carrier);
    options(volume, VolumeOptions(), "", [](auto& o, auto& v) { visit_particle_options(o, v); });
    write_disturbance(volume.disturbance);
    for (const VolumeMask& mask : volume.masks) write_mask(mask);
  }

  void write_disturbance(const Disturbance& disturbance) {
    const std::size_t before = text_.size();
    options(disturbance, Disturbance(), "\n[volume.disturb]\n",
            [](auto& o, auto& v) { visit_disturbance_options(o, v); });
    // The reader requires the strength, also where it is the default.
    const bool has_strength = text_of(disturbance.strength) != text_of(Disturbance().strength);
    if (text_.size() > before && !has_strength) line("strength", disturbance.strength);
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

  void write_event(const SmokeEvent& event) {
    line("from", event.from_world);
    line("at", event.at_world);
  }
  void write_event(const ShotEvent& event) {
    line("from", event.from_world);
    line("toward", event.toward_world);
    if (event.shape == ShotShape::box) text_ += "shape = \"box\"\n";
    if (event.shape == ShotShape::mask) {
      text_ += "shape = \"mask\"\n";
      line("mask", path_from(event.mask, folder_).generic_string());
    }
    options(event, ShotEvent(), "", [](auto& o, auto& v) { visit_shot_options(o, v); });
  }
  void write_event(const TextEvent& event) {
    line("text", event.text);
    line("from", event.from_world);
    line("toward", event.toward_world);
    if (!event.font.empty()) line("font", path_from(event.font, folder_).generic_string());
    options(event, TextEvent(), "", [](auto& o, auto& v) { visit_text_options(o, v); });
  }
  void write_event(const BlastEvent& event) {
    line("at", event.at_world);
    options(event, BlastEvent(), "", [](auto& o, auto& v) { visit_blast_options(o, v); });
  }
  void write_event(const MoveEvent& event) {
    line("body", event.body);
    line("to", event.to_world);
  }
  void write_event(const EditEvent& event) {
    line("low", event.low_world);
    line("high", event.high_world);
    line("solid", event.solid);
  }
  void write_event(const DoorEvent& event) {
    line("object", event.object);
    line("open", event.open);
  }

  template <typename Value>
  void line(const char* key, const Value& value) {
    text_ += std::string(key) + " = " + text_of(value) + "\n";
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

  const fs::path& folder_;
  std::string text_;
};

/// Copies files that a timeline names into the timeline's own folder.
class FileCollector {
 public:
  FileCollector(fs::path folder, fs::path own) : folder_(std::move(folder)), own_(std::move(own)) {}

  /// Replaces `file` by its path below the folder, where `copy_files` puts it.
  Result<void> collect(fs::path& file) {
    if (file.empty() || is_safe_relative(path_from(file, folder_).generic_string())) return {};
    const auto known = collected_.find(file);
    if (known != collected_.end()) {
      file = known->second;
      return {};
    }
    auto bytes = read_file(file);
    if (!bytes) return bytes.failure();
    const fs::path copy = place_for(file, *bytes);
    copies_[copy] = std::move(*bytes);
    collected_[file] = copy;
    file = copy;
    return {};
  }

  Result<void> copy_files() const {
    std::error_code error;
    if (!copies_.empty()) fs::create_directories(own_, error);
    if (error)
      return Failure{ErrorCode::bad_input, own_.string() + ": cannot create the folder: " + error.message()};
    for (const auto& [place, bytes] : copies_)
      if (!fs::exists(place, error))
        if (auto written = write_file_atomic(place, bytes); !written) return written;
    return {};
  }

 private:
  /// A path that is unused, or that holds the same bytes.
  fs::path place_for(const fs::path& file, const std::vector<std::byte>& bytes) const {
    fs::path place = own_ / file.filename();
    for (int number = 2; !is_free_for(place, bytes); ++number)
      place = own_ / (file.stem().string() + "-" + std::to_string(number) + file.extension().string());
    return place;
  }
  bool is_free_for(const fs::path& place, const std::vector<std::byte>& bytes) const {
    if (const auto planned = copies_.find(place); planned != copies_.end()) return planned->second == bytes;
    std::error_code error;
    if (!fs::exists(place, error)) return true;
    const auto existing = read_file(place);
    return existing && *existing == bytes;
  }

  fs::path folder_, own_;
  std::map<fs::path, fs::path> collected_;             // new path by original path
  std::map<fs::path, std::vector<std::byte>> copies_;  // bytes by new path
};

}  // namespace

std::string format_timeline(const Timeline& timeline, const fs::path& folder) {
  return Writer(folder).write(timeline);
}

Result<void> save_timeline(const fs::path& path, const Timeline& timeline) {
  Timeline saved = timeline;
  FileCollector files(path.parent_path(), path.parent_path() / (path.stem().string() + "_files"));
  for (ShotEvent& shot : saved.shots)
    if (auto done = files.collect(shot.mask); !done) return done;
  for (TextEvent& text : saved.texts)
    if (auto done = files.collect(text.font); !done) return done;
  for (CameraKey& key : saved.camera)
    if (auto done = files.collect(key.camera.lens.opening); !done) return done;
  const std::string text = format_timeline(saved, path.parent_path());
  // Never write a timeline that could not be read back.
  if (const auto read = parse_timeline(text, path); !read) return read.failure();
  if (auto copied = files.copy_files(); !copied) return copied;
  return write_file_atomic(path, text);
}

}  // namespace brume::scene
