#include "scenario/volumes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <regex>

#include "core/log.hpp"
#include "core/similar.hpp"
#include "grids/files.hpp"

namespace brume::scenario {
namespace {

namespace fs = std::filesystem;

/// The names that Blender, Houdini and EmberGen give, in order.
constexpr std::array kDensityNames{"density", "Density", "smoke", "fog", "soot", "surface"};
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

/// The files of a sequence's frames, by number.
Result<std::map<std::int64_t, fs::path>> files_of(const scene::VolumeOptions& options) {
  const fs::path& file = options.file;
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
  std::erase_if(found, [&](const auto& one) {
    return (options.first && one.first < *options.first) || (options.last && one.first > *options.last);
  });
  if (found.empty()) return Failure{ErrorCode::bad_input, file.string() + ": no such frames"};
  return found;
}

bool is_number_grid(const grids::Grid& grid) {
  return grid.type == grids::ValueType::float32 || grid.type == grids::ValueType::float64;
}

/// The grid of a name; without one the first of the usual names; null: none.
Result<const grids::Grid*> choose_grid(const grids::GridFile& file, const std::string& name,
                                       std::span<const char* const> usual) {
  std::vector<std::string> known;
  for (const grids::Grid& grid : file.grids) {
    if (!name.empty() && grid.name == name) return &grid;
    known.push_back(grid.name);
  }
  if (!name.empty())
    return Failure{ErrorCode::bad_input, "has no grid \"" + name + "\"" + suggestion(name, known, "\"")};
  for (const char* const one : usual)
    for (const grids::Grid& grid : file.grids)
      if (grid.name == one && is_number_grid(grid)) return &grid;
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

  // What a first view is made from.
  const double voxel = std::abs(glm::determinant(glm::dmat3((*density)->world_from_index)));
  const auto active = static_cast<double>(count_active(**density));
  frame->filled_volume = active * voxel;
  frame->mean_density = active > 0 ? frame->density.sum * std::exp2(3 * frame->density.level) / active : 0;
  const shared::VolumeLayout& layout = frame->density.volume->layout();
  frame->bounds =
      transformed(glm::mat4(frame->density.world_from_voxel), {layout.bounds_min, layout.bounds_max});
  // Of a ball, 2.2 standard deviations are the radius.
  const glm::dvec3 reach = 2.2 * frame->density.deviation + 1.0;
  const Box<float> core{glm::vec3(frame->density.mean - reach), glm::vec3(frame->density.mean + reach)};
  frame->core = transformed(glm::mat4(frame->density.world_from_voxel),
                            intersection(core, {layout.bounds_min, layout.bounds_max}));
  frame->z_is_up = is_z_up(**density);
  return std::shared_ptr<const VolumeFrame>(std::move(frame));
}

/// The number of the frame at a time, before missing ones are replaced; empty: none is shown.
std::optional<std::int64_t> number_at(const scene::VolumeOptions& options, std::int64_t first,
                                      std::int64_t last, double seconds) {
  // A frame whose start and rate are rounded to float32, within the first hours, does not show the one
  // before.
  constexpr double kRounding = 2e-3;
  const double frames = (seconds - double{options.start}) * double{options.frame_rate};
  const auto passed = static_cast<std::int64_t>(std::floor(frames + kRounding));
  const std::int64_t count = last - first + 1;
  const auto repeated = [&](std::int64_t period) { return (passed % period + period) % period; };
  if (options.clip && (passed < 0 || passed >= count)) return std::nullopt;
  if (options.loop) return first + repeated(count);
  if (options.ping_pong) {
    const std::int64_t period = std::max<std::int64_t>(2 * count - 2, 1);
    return first + std::min(repeated(period), period - repeated(period));
  }
  return first + std::clamp<std::int64_t>(passed, 0, count - 1);
}

/// Around the voxels of a brick and its apron that are not 0, and the filter's reach: a voxel from their
/// centres [voxel space].
Box<float> dense_box(const volume::SparseVolume& volume, std::uint32_t slot) {
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  const glm::vec3 apron = glm::vec3(shared::kBrickVoxels * volume.brick_of(slot) - 1);
  Box<float> box = kEmptyBox;
  for (int i = 0; i < static_cast<int>(shared::kTexelsPerBrick); ++i) {
    if (texels[static_cast<std::size_t>(i)] == 0) continue;
    constexpr int kEdge = shared::kBrickTexels;
    const glm::vec3 low = apron + glm::vec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)) - 0.5f;
    box = united(box, {low, low + 2.0f});
  }
  return box;
}

/// Whether the axes of a volume span space.
bool has_inverse(const scene::VolumeOptions& options) {
  const glm::dmat3 axes(options.x_axis, options.y_axis, options.z_axis);
  const double product = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return std::abs(glm::determinant(axes)) > 1e-9 * product;
}

}  // namespace

glm::mat4 world_from_file(const scene::VolumeOptions& options) {
  glm::mat4 matrix = glm::translate(glm::mat4(1), options.position_world);
  for (const int axis : {2, 1, 0}) {
    glm::vec3 around(0);
    around[axis] = 1;
    matrix = glm::rotate(matrix, glm::radians(options.rotation[axis]), around);
  }
  const glm::mat3 axes(options.x_axis, options.y_axis, options.z_axis);
  return glm::scale(matrix, glm::vec3(options.scale)) * glm::mat4(axes);
}

scene::Volume place_of(const scene::VolumeOptions& options, const VolumeFrame& frame) {
  const glm::mat4 world = world_from_file(options);
  return {options.file.filename().string(), transformed(world, frame.bounds), transformed(world, frame.core)};
}

std::vector<glm::vec3> corners_of(const scene::VolumeOptions& options, const VolumeFrame& frame) {
  const volume::SparseVolume& volume = *frame.density.volume;
  const glm::dmat4 world = glm::dmat4(world_from_file(options)) * frame.density.world_from_voxel;
  std::vector<glm::vec3> corners;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    // A brick inside of others, whose aprons reach its corners, is inside of their hull.
    const volume::NeighbourSlots around = volume.slots_around(volume.brick_of(slot));
    if (std::ranges::find(around, volume::SparseVolume::kNoSlot) == around.end()) continue;
    const Box<float> box = dense_box(volume, slot);
    if (box.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p = glm::mix(box.low, box.high, glm::bvec3(corner & 1, corner & 2, corner & 4));
      const glm::vec3 inside = glm::clamp(p, volume.layout().bounds_min, volume.layout().bounds_max);
      corners.emplace_back(world * glm::dvec4(inside, 1));
    }
  }
  return corners;
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
    const std::string where = one.place.empty() ? "" : one.place + ": ";
    if (!has_inverse(one))
      return Failure{ErrorCode::bad_input,
                     where + one.file.string() + ": its axes lie in a plane; expected three that span space"};
    auto files = files_of(one);
    if (!files) return Failure{files.failure().code, where + files.failure().message};
    Sequence sequence{std::move(*files), nullptr, nullptr, 0};
    auto frame = load_volume_frame(sequence.files.begin()->second, one);
    if (!frame) return frame.failure();
    sequence.first = sequence.shown = std::move(*frame);
    sequence.shown_number = sequence.files.begin()->first;
    volumes->sequences_.push_back(std::move(sequence));
  }
  return volumes;
}

std::vector<VolumeAt> Volumes::at(std::span<const scene::VolumeOptions> options, double seconds) {
  BRUME_ASSERT(options.size() == sequences_.size(), std::to_string(options.size()));
  std::vector<VolumeAt> volumes;
  for (std::size_t i = 0; i < options.size(); ++i) {
    Sequence& sequence = sequences_[i];
    const auto& files = sequence.files;
    const auto wanted = number_at(options[i], options[i].first.value_or(files.begin()->first),
                                  options[i].last.value_or(files.rbegin()->first), seconds);
    if (!wanted) {
      volumes.emplace_back();
      continue;
    }
    const auto after = files.upper_bound(*wanted);
    const auto [number, file] = after == files.begin() ? *after : *std::prev(after);
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
