#include "volumes/volume_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/log.hpp"
#include "grids/color_bricks.hpp"
#include "grids/coverage.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/mask_bricks.hpp"
#include "grids/metadata.hpp"
#include "volumes/stray_note.hpp"
#include "volumes/volume_grids.hpp"

namespace brume::volumes {
namespace {

namespace fs = std::filesystem;

/// Voxels of a tank at most: with colours 20 bytes each on the device.
constexpr std::uint64_t kMostTankVoxels = std::uint64_t{1} << 25;

/// Whether the file says so: Blender's solver names the resolution of its domain.
bool is_z_up(const grids::Grid& grid) {
  return std::ranges::any_of(grid.metadata, [](const grids::Metadata& one) {
    return one.name == "file_base_resolution" || one.name.starts_with("blender");
  });
}

void warn_of_level(const fs::path& file, const grids::Grid& grid, const grids::BrickVolume& volume) {
  if (volume.level == 0) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": grid %s is shown at 1/%d of its resolution, off by %.2g of its largest value on average; "
                "it is too large for the device or --volume-memory",
                grid.name.c_str(), 1 << volume.level,
                volume.rms_error / std::max(double{volume.high}, 1e-30));
  log_warning(file.string() + text);
}

/// What a first view is made from.
void measure_first_view(const grids::Grid& density, VolumeFrame& frame) {
  const auto active = static_cast<double>(count_active(density));
  frame.mean_density = active > 0 ? frame.density.sum * std::exp2(3 * frame.density.level) / active : 0;
  const shared::VolumeLayout& layout = frame.density.volume->layout();
  frame.bounds =
      transformed(glm::mat4(frame.density.world_from_voxel), {layout.bounds_min, layout.bounds_max});
  frame.z_is_up = is_z_up(density);
  frame.is_extinction = grids::is_extinction_per_metre(density);
}

/// What glows of each mask.
Result<void> find_mask_glow(std::span<const grids::Grid* const> masks, VolumeFrame& frame) {
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const auto mask = grids::make_brick_volume(*masks[i]);
    if (!mask) return mask.failure();
    const double voxel = std::abs(glm::determinant(glm::dmat3(mask->world_from_voxel)));
    for (const grids::GlowBall& ball : grids::find_glow(*mask, frame.density, grids::GlowPower::linear))
      frame.mask_glow.push_back({i, glm::dvec3(mask->world_from_voxel * glm::dvec4(ball.middle, 1)),
                                 ball.radius * std::cbrt(voxel), ball.power * double{mask->unit} * voxel});
  }
  return {};
}

/// What is colder does not glow for the eye [K].
constexpr double kColdest = 600;

/// Whether the heat of a file glows, and what to say about it. Solvers of smoke keep a temperature that lifts
/// it: without a fire beside it that is no glow, unless the options give it a name or kelvin of its own, or
/// it is in kelvin.
bool glows(const ChosenGrids& chosen, const scene::VolumeOptions& options, VolumeFrame& frame) {
  if (!chosen.heat) return false;
  const std::string name = '"' + chosen.heat->name + '"';
  frame.heat_is_kelvin = frame.heat_is_kelvin || any_above(*chosen.heat, double{kMostFactor});
  // Nothing in the heat or the fire.
  if (chosen.names_heat && !any_above(*chosen.heat, 0)) {
    frame.heat_note = name + " does not glow: none of its values is above 0";
    return false;
  }
  if (!chosen.names_heat && chosen.fire && !any_above(*chosen.fire, 0)) {
    frame.heat_note = name + " does not glow, as nothing of \"" + chosen.fire->name + "\" burns";
    return false;
  }
  // A temperature that lifts smoke, or one too cold to see.
  const bool has_kelvin = options.kelvin != scene::VolumeOptions().kelvin;
  if (!chosen.names_heat && !chosen.fire && !has_kelvin && !frame.heat_is_kelvin) {
    frame.heat_note =
        name +
        " counts as what lifts smoke, and does not glow: no grid of fire is beside it; name it, with "
        "`heat` or --heat, to see it glow";
    return false;
  }
  if (!chosen.names_heat && !has_kelvin && frame.heat_is_kelvin && !any_above(*chosen.heat, kColdest)) {
    char text[96];
    std::snprintf(text, sizeof text, " does not glow: as kelvin, none of its values is above %g", kColdest);
    frame.heat_note = name + text;
    return false;
  }
  const float kelvin = kelvin_of(options, frame);
  char text[64];
  std::snprintf(text, sizeof text, "1 is %g K", static_cast<double>(kelvin));
  frame.heat_note =
      name + " glows: " + (frame.heat_is_kelvin && kelvin == 1 ? "its values are kelvin" : text);
  return true;
}

void warn_of_odd(const fs::path& file, const grids::Grid& grid, const grids::BrickVolume& volume) {
  if (volume.odd == 0) return;
  log_warning(
      file.string() + ": grid " + grid.name + ": " + std::to_string(volume.odd) +
      (volume.odd == 1 ? " value is" : " values are") +
      " NaN, infinite or far beyond the others: NaN counts as 0, the rest as the largest of the others");
}

/// About values below 0, but for those that are rounding.
std::string note_of_negative(const grids::Grid& grid) {
  constexpr double kRounding = 0.01;
  if (grids::is_level_set(grid)) return "";
  double low = 0, high = 0;
  const auto add = [&](double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  const std::size_t bytes = grids::bytes_of(grid.type);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i)
    for (std::size_t voxel = 0; voxel < grids::kBrickVoxels; ++voxel)
      if (grid.bricks[i].is_active(voxel))
        add(grids::to_number(grid.type, grid.values_of(i).data() + voxel * bytes));
  for (const grids::Tile& tile : grid.tiles)
    if (tile.active) add(grids::to_number(grid.type, tile.value.data()));
  if (!(low < -kRounding * high)) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "\" has values below 0, down to %.4g, which count as 0: a range from below 0 with an opacity "
                "curve draws them",
                low);
  return '"' + grid.name + text;
}

/// Around the active voxels of a grid.
Box<double> world_box(const grids::Grid& grid) {
  const Box<double> active = active_bounds(grid);
  Box<double> box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (int corner = 0; corner < 8 && !active.empty(); ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    const glm::dvec3 p(grid.world_from_index * glm::dvec4(glm::mix(active.low, active.high, high), 1));
    box = united(box, {p, p});
  }
  return box;
}

/// Colours of a vector grid or of channels. Blender's solver saves them multiplied by the density, which
/// files that other programs wrote again do not say.
Result<std::unique_ptr<volume::SparseVolume>> color_bricks(const fs::path& file, const ChosenGrids& chosen,
                                                           const grids::BrickVolume& density) {
  const grids::Grid& first = chosen.color ? *chosen.color : *chosen.channels[0];
  if (intersection(world_box(first), world_box(*chosen.density)).empty())
    log_warning(file.string() + ": \"" + first.name + "\" colours nothing: it lies nowhere where \"" +
                chosen.density->name + "\" is");
  if (chosen.color) return grids::make_color_bricks(*chosen.color, density);
  const bool multiplied = is_z_up(*chosen.density) || grids::are_multiplied(chosen.channels, *chosen.density);
  return grids::make_color_bricks(
      grids::ColorChannels{chosen.channels, multiplied ? chosen.density : nullptr}, density);
}

/// What glows; `options` hold the room for it.
Result<void> add_heat(const fs::path& file, const grids::Grid& heat, grids::BrickVolumeOptions options,
                      VolumeFrame& frame) {
  options.glows = true;
  auto hot = grids::make_brick_volume(heat, options);
  if (!hot) return hot.failure();
  warn_of_level(file, heat, *hot);
  warn_of_odd(file, heat, *hot);
  if (!(hot->high > 0)) return {};
  frame.heat = std::move(*hot);
  frame.glow = grids::find_glow(*frame.heat, frame.density);
  return {};
}

/// Entries of a page table for the voxels in a box, at least.
double pages_of(const Box<double>& box) {
  const glm::dvec3 nodes = glm::ceil((box.high - box.low) / 64.0);
  return box.empty() ? 0 : nodes.x * nodes.y * nodes.z;
}

/// Where heat is, in voxels of the density: what BrickVolumeOptions::also needs; null where it takes so much
/// of the page table that the density would have no room at its own resolution. `covered` holds it where the
/// voxels of both differ.
const grids::Grid* reach_of(const grids::Grid& heat, const grids::Grid& density, std::uint32_t max_pages,
                            std::optional<grids::Grid>& covered) {
  const bool is_same = heat.world_from_index == density.world_from_index;
  if (!is_same) covered = grids::make_coverage(heat, density.world_from_index);
  const grids::Grid* const reach = is_same ? &heat : covered ? &*covered : nullptr;
  const Box<double> own = active_bounds(density);
  const double most = max_pages;
  if (reach && (pages_of(own) > most || pages_of(united(own, active_bounds(*reach))) <= most)) return reach;
  return nullptr;
}

/// What the grids of a frame are made into.
struct FrameMaker {
  const fs::path& file;
  const ChosenGrids& chosen;
  const scene::VolumeOptions& options;
  const VolumeRoom& room;
  VolumeFrame& frame;
  const grids::Grid* density = chosen.density;
  const grids::Grid* heat = nullptr;
  bool is_cut = false;  ///< Whether the heat is drawn only where the density is.
  grids::Grid joined = {};

  bool has_colors() const { return chosen.color || chosen.channels[0]; }
  /// Heat has the same room as the density.
  std::uint32_t part(std::uint64_t total, std::uint32_t fewest, std::uint32_t most) const {
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(heat ? total / 2 : total, fewest, most));
  }
  std::uint32_t max_bricks() const {
    return part(room.bricks, grids::kFewestVolumeBricks, grids::kMostVolumeBricks);
  }
  std::uint32_t max_pages() const {
    return part(room.pages, grids::kFewestVolumePages, grids::kMostVolumePages);
  }
  Result<void> add_density();
  Result<void> add_colors_and_masks();
  void cut_heat();
};

Result<void> FrameMaker::add_density() {
  if (!chosen.masks.empty()) {
    auto all = grids::joined_masks(chosen.masks);
    if (!all) return all.failure();
    joined = std::move(*all);
    if (!density) density = &joined;
  }
  // Bricks of colours and masks have the slots of the density's, which reach wherever a mask does.
  const grids::Grid* also = density != &joined && !chosen.masks.empty() ? &joined : nullptr;
  std::optional<grids::Grid> covered;
  if (heat && (chosen.masks.empty() || heat->world_from_index == density->world_from_index)) {
    const grids::Grid* const reach = reach_of(*heat, *density, max_pages(), covered);
    is_cut = !reach;
    if (reach) also = reach;
  }
  const auto shift = density == &joined ? std::nullopt : shift_of(options);
  auto bricks = grids::make_brick_volume(
      *density, {max_bricks(), max_pages(), also, !has_colors() && chosen.masks.empty(), false, shift});
  if (!bricks) return bricks.failure();
  const bool is_chosen = !options.opacity.empty() && options.range && options.range->x < 0;
  if (density != &joined && !is_chosen) frame.value_note = note_of_negative(*density);
  frame.density = std::move(*bricks);
  frame.density_name = density->name;
  warn_of_level(file, *density, frame.density);
  warn_of_odd(file, *density, frame.density);
  return {};
}

Result<void> FrameMaker::add_colors_and_masks() {
  if (has_colors()) {
    auto colors = color_bricks(file, chosen, frame.density);
    if (!colors) return colors.failure();
    frame.colors = std::move(*colors);
  }
  if (chosen.masks.empty()) return {};
  frame.colors = grids::make_mask_bricks(chosen.masks, frame.density);
  return find_mask_glow(chosen.masks, frame);
}

/// Heat that is cut off at the bounds of the density, of which nothing may remain.
void FrameMaker::cut_heat() {
  if (!is_cut || !frame.heat) return;
  const shared::VolumeLayout& layout = frame.heat->volume->layout();
  const Box<float> place =
      transformed(glm::mat4(frame.heat->world_from_voxel), {layout.bounds_min, layout.bounds_max});
  const std::string name = '"' + heat->name + '"', dense = '"' + density->name + '"';
  if (!intersection(place, frame.bounds).empty()) {
    log_warning(file.string() + ": " + name + " is drawn only where " + dense +
                " is: beyond it takes more voxels of " + dense + " than one volume has");
    return;
  }
  frame.heat.reset();
  frame.glow.clear();
  frame.heat_note = name + " does not glow: it lies too far from " + dense + " to be drawn with it";
}

Result<std::shared_ptr<VolumeFrame>> make_frame(const fs::path& file, const ChosenGrids& chosen,
                                                const scene::VolumeOptions& options, const VolumeRoom& room,
                                                bool in_kelvin) {
  auto frame = std::make_shared<VolumeFrame>();
  frame->heat_is_kelvin = in_kelvin;
  FrameMaker maker{file, chosen, options, room, *frame};
  if (glows(chosen, options, *frame)) maker.heat = chosen.heat;
  if (auto done = maker.add_density(); !done) return done.failure();
  if (maker.heat)
    if (auto done = add_heat(file, *maker.heat,
                             {.max_bricks = maker.max_bricks(), .max_pages = maker.max_pages()}, *frame);
        !done)
      return done.failure();
  if (auto done = maker.add_colors_and_masks(); !done) return done.failure();
  measure_first_view(*maker.density, *frame);
  maker.cut_heat();
  return frame;
}

/// The grids to read, and for each pointer of `chosen` which of these it is.
std::vector<std::size_t> positions_of(GridList heads, ChosenGrids& chosen,
                                      std::vector<std::optional<std::size_t>>& read_positions) {
  std::vector<std::size_t> positions;
  const auto position_of = [&](const grids::Grid* grid) {
    return static_cast<std::size_t>(std::ranges::find(heads, grid) - heads.begin());
  };
  chosen.each([&](const grids::Grid* grid) {
    if (grid) positions.push_back(position_of(grid));
  });
  std::ranges::sort(positions);
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  read_positions.clear();
  chosen.each([&](const grids::Grid* grid) {
    read_positions.emplace_back();
    if (grid)
      read_positions.back() = static_cast<std::size_t>(
          std::ranges::lower_bound(positions, position_of(grid)) - positions.begin());
  });
  return positions;
}

}  // namespace

float kelvin_of(const scene::VolumeOptions& options, const VolumeFrame& frame) {
  return frame.heat_is_kelvin && options.kelvin == scene::VolumeOptions().kelvin ? 1 : options.kelvin;
}

std::optional<grids::ValueShift> shift_of(const scene::VolumeOptions& options) {
  if (options.opacity.empty() || !options.range || !(options.range->x < 0)) return std::nullopt;
  const glm::dvec2 range(*options.range);
  const double zero = std::min(-range.x / (range.y - range.x), 1.0);
  if (!(scene::opacity_integral(options.opacity, zero) > 0)) return std::nullopt;
  // The lowest value is not 0, where there is nothing.
  constexpr double kStep = 1.0 / 1024;
  return grids::ValueShift{options.range->x, static_cast<float>(range.x - kStep * (range.y - range.x))};
}

Result<std::string> shown_grids(const grids::GridFile& file) {
  std::vector<const grids::Grid*> list;
  for (const grids::Grid& grid : file.grids) list.push_back(&grid);
  const auto chosen = choose_grids(list, {});
  if (!chosen) return chosen.failure();
  VolumeFrame frame;
  glows(*chosen, {}, frame);
  const std::string color = chosen->color ? ", coloured by \"" + chosen->color->name + '"'
                            : chosen->channels[0]
                                ? std::string(", coloured by \"color_r\", \"color_g\", \"color_b\"")
                                : "";
  std::string text = '"' + chosen->density->name + '"' + color;
  if (!frame.heat_note.empty()) text += "; " + frame.heat_note;
  for (const std::string& note : chosen->notes) text += "; " + note;
  const auto strays = stray_note(*chosen->density);
  if (strays && !strays->empty()) text += "; " + *strays;
  return text;
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

Result<std::shared_ptr<const VolumeFrame>> load_volume_frame(const fs::path& file,
                                                             const scene::VolumeOptions& options,
                                                             const VolumeRoom& room,
                                                             const std::atomic<bool>* stopped,
                                                             grids::GridReader read, bool in_kelvin) {
  const std::string where = options.place.empty() ? "" : options.place + ": ";
  std::vector<std::string> number_grids, color_grids;
  // Files are read for the grids that were chosen by their heads.
  ChosenGrids chosen;
  std::vector<std::optional<std::size_t>> read_positions;
  const auto grids = read(file, {.tank_voxels = kMostTankVoxels, .stopped = stopped},
                          [&](GridList heads) -> Result<std::vector<std::size_t>> {
                            number_grids = titles_of(heads, is_number_grid);
                            color_grids = titles_of(heads, is_color_vectors);
                            if (has_color_channels(heads)) color_grids.push_back(kChannelName);
                            auto of_heads = choose_grids(heads, options);
                            if (!of_heads) return of_heads.failure();
                            chosen = std::move(*of_heads);
                            return positions_of(heads, chosen, read_positions);
                          });
  if (!grids) return Failure{grids.failure().code, where + grids.failure().message};
  if (stopped && *stopped) return Failure{ErrorCode::internal, file.string() + ": stopped"};
  std::size_t next = 0;
  chosen.each([&](const grids::Grid*& grid) {
    const auto position = read_positions[next++];
    grid = position ? &grids->grids[*position] : nullptr;
  });
  auto frame = make_frame(file, chosen, options, room, in_kelvin);
  if (!frame) return Failure{frame.failure().code, where + file.string() + ": " + frame.failure().message};
  (*frame)->number_grids = std::move(number_grids);
  (*frame)->color_grids = std::move(color_grids);
  (*frame)->grid_notes = std::move(chosen.notes);
  return std::shared_ptr<const VolumeFrame>(std::move(*frame));
}

VolumeRoom room_of(const VolumeFrame& frame) {
  VolumeRoom room{0, 0};
  const auto add = [&](const grids::BrickVolume& grid) {
    const volume::PageTable& pages = grid.volume->pages();
    room.bricks += grid.volume->slot_count();
    room.pages += pages.root().size() + pages.nodes().size();
  };
  add(frame.density);
  if (frame.heat) add(*frame.heat);
  return room;
}

std::shared_ptr<const VolumePreview> make_previews(const VolumeFrame& frame) {
  auto preview = std::make_shared<VolumePreview>();
  if (frame.density.volume->slot_count() > kPreviewBricks)
    preview->density = grids::make_preview(frame.density, kPreviewBricks);
  if (frame.heat && frame.heat->volume->slot_count() > kPreviewBricks)
    preview->heat = grids::make_preview(*frame.heat, kPreviewBricks, true);
  return preview;
}

}  // namespace brume::volumes
