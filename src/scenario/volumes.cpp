#include "scenario/volumes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <regex>

#include "core/log.hpp"
#include "core/similar.hpp"
#include "grids/color_bricks.hpp"
#include "grids/files.hpp"

namespace brume::scenario {
namespace {

namespace fs = std::filesystem;

/// The names that Blender, Houdini and EmberGen give, in order.
constexpr std::array kDensityNames{"density", "Density", "smoke", "fog", "soot", "surface"};
constexpr std::array kColorNames{"Cd", "color", "colour", "Color", "Colour"};
constexpr std::array kHeatNames{"temperature", "heat", "flame", "flames", "fire", "burn"};

/// Where the number of a frame stands in a name: "%04d" or "%d".
struct NumberPlace {
  std::string before, after;
};
std::optional<NumberPlace> number_place(const std::string& name) {
  static const std::regex number(R"(%0?\d*d)");
  std::smatch match;
  if (!std::regex_search(name, match, number)) return std::nullopt;
  return NumberPlace{match.prefix(), match.suffix()};
}

/// The files of a sequence, by number.
Result<std::map<std::int64_t, fs::path>> files_of(const fs::path& file) {
  const auto place = number_place(file.filename().string());
  if (!place) return std::map<std::int64_t, fs::path>{{0, file}};
  std::map<std::int64_t, fs::path> found;
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::size_t around = place->before.size() + place->after.size();
    if (name.size() <= around || !name.starts_with(place->before) || !name.ends_with(place->after)) continue;
    const char* const last = name.data() + name.size() - place->after.size();
    std::int64_t number = 0;
    const auto read = std::from_chars(name.data() + place->before.size(), last, number);
    if (read.ec == std::errc() && read.ptr == last) found.emplace(number, file.parent_path() / name);
  }
  if (found.empty()) return Failure{ErrorCode::bad_input, file.string() + ": no such frames"};
  return found;
}

bool is_number_grid(const grids::Grid& grid) {
  return grid.type == grids::ValueType::float32 || grid.type == grids::ValueType::float64;
}

/// The grid of a name; without one the first of the usual names; null: none.
Result<const grids::Grid*> choose_grid(const grids::GridFile& file, const std::string& name,
                                       std::span<const char* const> usual,
                                       bool (*fits)(const grids::Grid&) = is_number_grid) {
  std::vector<std::string> known;
  for (const grids::Grid& grid : file.grids) {
    if (!name.empty() && grid.name == name) return &grid;
    known.push_back(grid.name);
  }
  if (!name.empty())
    return Failure{ErrorCode::bad_input, "has no grid \"" + name + "\"" + suggestion(name, known, "\"")};
  for (const char* const one : usual)
    for (const grids::Grid& grid : file.grids)
      if (grid.name == one && fits(grid)) return &grid;
  return static_cast<const grids::Grid*>(nullptr);
}

Result<const grids::Grid*> choose_density(const grids::GridFile& file, const std::string& name) {
  auto grid = choose_grid(file, name, kDensityNames);
  if (!grid || *grid) return grid;
  const auto first = std::ranges::find_if(file.grids, is_number_grid);
  if (first == file.grids.end()) return Failure{ErrorCode::bad_input, "has no grid of numbers to render"};
  return &*first;
}

/// Whether the file says so: Blender's solver names the resolution of its domain.
bool is_z_up(const grids::Grid& grid) {
  return std::ranges::any_of(grid.metadata, [](const grids::Metadata& one) {
    return one.name == "file_base_resolution" || one.name.starts_with("blender");
  });
}

Box<float> transformed(const glm::mat4& matrix, const Box<float>& box) {
  Box<float> result = kEmptyBox;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    const glm::vec3 p(matrix * glm::vec4(glm::mix(box.low, box.high, high), 1));
    result = united(result, {p, p});
  }
  return result;
}

void warn_of_level(const fs::path& file, const grids::Grid& grid, const grids::BrickVolume& volume) {
  if (volume.level == 0) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": grid %s is shown at 1/%d of its resolution, off by %.2g of its largest value on average; "
                "it is too large for the device",
                grid.name.c_str(), 1 << volume.level,
                volume.rms_error / std::max(double{volume.high}, 1e-30));
  log_warning(file.string() + text);
}

/// What a first view is made from.
void measure_first_view(const grids::Grid& density, VolumeFrame& frame) {
  const double voxel = std::abs(glm::determinant(glm::dmat3(density.world_from_index)));
  const auto active = static_cast<double>(count_active(density));
  frame.filled_volume = active * voxel;
  frame.mean_density = active > 0 ? frame.density.sum * std::exp2(3 * frame.density.level) / active : 0;
  const shared::VolumeLayout& layout = frame.density.volume->layout();
  frame.bounds =
      transformed(glm::mat4(frame.density.world_from_voxel), {layout.bounds_min, layout.bounds_max});
  // Of a ball, 2.2 standard deviations are the radius.
  const glm::dvec3 reach = 2.2 * frame.density.deviation + 1.0;
  const Box<float> core{glm::vec3(frame.density.mean - reach), glm::vec3(frame.density.mean + reach)};
  frame.core = transformed(glm::mat4(frame.density.world_from_voxel),
                           intersection(core, {layout.bounds_min, layout.bounds_max}));
  frame.z_is_up = is_z_up(density);
}

Result<std::shared_ptr<const VolumeFrame>> make_frame(const fs::path& file, const grids::GridFile& grids,
                                                      const scene::VolumeOptions& options) {
  const auto density = choose_density(grids, options.density);
  if (!density) return density.failure();
  const auto heat = choose_grid(grids, options.heat, kHeatNames);
  if (!heat) return heat.failure();
  auto frame = std::make_shared<VolumeFrame>();
  const bool glows = *heat && *heat != *density;
  const bool alike = glows && (*heat)->world_from_index == (*density)->world_from_index;
  auto bricks = grids::make_brick_volume(**density, {.also = alike ? *heat : nullptr});
  if (!bricks) return bricks.failure();
  frame->density = std::move(*bricks);
  warn_of_level(file, **density, frame->density);
  if (glows) {
    auto hot = grids::make_brick_volume(**heat);
    if (!hot) return hot.failure();
    warn_of_level(file, **heat, *hot);
    if (hot->high > 0) frame->heat = std::move(*hot);
  }

  const auto color = choose_grid(grids, options.color, kColorNames, grids::is_color_grid);
  if (!color) return color.failure();
  if (*color) {
    auto colors = grids::make_color_bricks(**color, frame->density);
    if (!colors) return colors.failure();
    frame->colors = std::move(*colors);
  }
  for (const grids::Grid& grid : grids.grids) {
    if (is_number_grid(grid)) frame->number_grids.push_back(grid.name);
    if (grids::is_color_grid(grid)) frame->color_grids.push_back(grid.name);
  }
  measure_first_view(**density, *frame);
  return std::shared_ptr<const VolumeFrame>(std::move(frame));
}

std::array<std::string, 3> chosen_grids(const scene::VolumeOptions& options) {
  return {options.density, options.heat, options.color};
}

/// The number of the frame at a time, before missing ones are replaced.
std::int64_t number_at(const scene::VolumeOptions& options, std::int64_t first, std::int64_t last,
                       double seconds) {
  const double frames = (seconds - double{options.start}) * double{options.frame_rate};
  const auto passed = static_cast<std::int64_t>(std::floor(frames + 1e-6));
  const std::int64_t count = last - first + 1;
  if (!options.loop) return first + std::clamp<std::int64_t>(passed, 0, count - 1);
  return first + (passed % count + count) % count;
}

}  // namespace

glm::mat4 world_from_file(const scene::VolumeOptions& options) {
  glm::mat4 matrix = glm::translate(glm::mat4(1), options.position_world);
  for (const int axis : {2, 1, 0}) {
    glm::vec3 around(0);
    around[axis] = 1;
    matrix = glm::rotate(matrix, glm::radians(options.rotation[axis]), around);
  }
  return glm::scale(matrix, glm::vec3(options.scale));
}

glm::vec2 range_of(const scene::VolumeOptions& options, const VolumeFrame& first) {
  if (options.range) return *options.range;
  const float low = first.density.low, high = first.density.high;
  if (high > low) return {low, high};
  return {0, high > 0 ? high : 1};
}

scene::Volume place_of(const scene::VolumeOptions& options, const VolumeFrame& frame) {
  const glm::mat4 world = world_from_file(options);
  return {options.file.filename().string(), transformed(world, frame.bounds), transformed(world, frame.core)};
}

Result<std::shared_ptr<const VolumeFrame>> load_volume_frame(const fs::path& file,
                                                             const scene::VolumeOptions& options) {
  const std::string where = options.place.empty() ? "" : options.place + ": ";
  const auto grids = grids::load_grid_file(file);
  if (!grids) return Failure{grids.failure().code, where + grids.failure().message};
  auto frame = make_frame(file, *grids, options);
  if (!frame) return Failure{frame.failure().code, where + file.string() + ": " + frame.failure().message};
  if ((*frame)->density.high <= 0) log_warning(file.string() + ": nothing to see: no voxel is above 0");
  return frame;
}

Result<std::shared_ptr<Volumes>> Volumes::load(std::span<const scene::VolumeOptions> options) {
  auto volumes = std::make_shared<Volumes>();
  for (const scene::VolumeOptions& one : options) {
    auto files = files_of(one.file);
    if (!files)
      return Failure{files.failure().code,
                     (one.place.empty() ? "" : one.place + ": ") + files.failure().message};
    Sequence sequence{std::move(*files), nullptr, nullptr, 0, chosen_grids(one)};
    auto frame = load_volume_frame(sequence.files.begin()->second, one);
    if (!frame) return frame.failure();
    sequence.first = sequence.shown = std::move(*frame);
    sequence.shown_number = sequence.files.begin()->first;
    volumes->sequences_.push_back(std::move(sequence));
  }
  return volumes;
}

Result<void> Volumes::choose_grids(std::size_t volume, const scene::VolumeOptions& options) {
  Sequence& sequence = sequences_[volume];
  if (sequence.grids == chosen_grids(options)) return {};
  const auto& [number, file] = *sequence.files.begin();
  auto frame = load_volume_frame(file, options);
  if (!frame) return frame.failure();
  sequence.first = sequence.shown = std::move(*frame);
  sequence.shown_number = number;
  sequence.grids = chosen_grids(options);
  return {};
}

std::vector<VolumeAt> Volumes::at(std::span<const scene::VolumeOptions> options, double seconds) {
  BRUME_ASSERT(options.size() == sequences_.size(), std::to_string(options.size()));
  std::vector<VolumeAt> volumes;
  for (std::size_t i = 0; i < options.size(); ++i) {
    Sequence& sequence = sequences_[i];
    if (sequence.grids != chosen_grids(options[i]))
      if (const auto done = choose_grids(i, options[i]); !done) {
        log_warning(done.failure().message + "; the grids before are shown");
        sequence.grids = chosen_grids(options[i]);
      }
    const std::int64_t wanted =
        number_at(options[i], sequence.files.begin()->first, sequence.files.rbegin()->first, seconds);
    const auto [number, file] = *std::prev(sequence.files.upper_bound(wanted));
    if (number != sequence.shown_number) {
      auto frame = load_volume_frame(file, options[i]);
      if (frame) sequence.shown = std::move(*frame);
      if (!frame) log_warning(frame.failure().message + "; the frame before it is shown");
      sequence.shown_number = number;
    }
    VolumeAt at{sequence.shown};
    const glm::dmat4 world(world_from_file(options[i]));
    at.world_from_density = glm::mat4(world * at.frame->density.world_from_voxel);
    if (at.frame->heat) at.world_from_heat = glm::mat4(world * at.frame->heat->world_from_voxel);
    volumes.push_back(std::move(at));
  }
  return volumes;
}

std::vector<fs::path> Volumes::files() const {
  std::vector<fs::path> files;
  for (const Sequence& sequence : sequences_)
    for (const auto& [number, file] : sequence.files) files.push_back(file);
  return files;
}

}  // namespace brume::scenario
