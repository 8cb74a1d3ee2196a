#include "scenario/volume_frame.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "core/log.hpp"
#include "core/similar.hpp"
#include "grids/color_bricks.hpp"
#include "grids/coverage.hpp"
#include "grids/files.hpp"
#include "grids/mask_bricks.hpp"
#include "grids/metadata.hpp"

namespace brume::scenario {
namespace {

namespace fs = std::filesystem;

/// The names that Blender, Houdini and EmberGen give, in order.
constexpr std::array kDensityNames{"density", "Density", "smoke", "fog", "soot", "surface"};
constexpr std::array kColorNames{"Cd", "color", "colour", "Color", "Colour"};
/// Of colours in channels, as Mantaflow names them: color_r, color_g, color_b.
constexpr const char* kChannelName = "color";
constexpr std::array kTemperatureNames{"temperature", "heat"};
constexpr std::array kFireNames{"flame", "flames", "fire", "burn"};

bool is_number_grid(const grids::Grid* grid) {
  return grid->type == grids::ValueType::float32 || grid->type == grids::ValueType::float64;
}

bool is_whole_numbers(const grids::Grid* grid) {
  return grid->type == grids::ValueType::int32 || grid->type == grids::ValueType::int64 ||
         grid->type == grids::ValueType::boolean;
}

bool is_colors(const grids::Grid* grid) {
  return grids::is_color_grid(*grid);
}

/// Voxels of a tank at most: with colours 20 bytes each on the device.
constexpr std::uint64_t kMostTankVoxels = std::uint64_t{1} << 25;

/// The grid of a name; without one the first of the usual names; null: none.
using GridList = std::span<const grids::Grid* const>;
Result<const grids::Grid*> choose_grid(GridList grids, const std::string& name,
                                       std::span<const char* const> usual,
                                       bool (*fits)(const grids::Grid*) = is_number_grid) {
  std::vector<std::string> known;
  for (const grids::Grid* grid : grids) {
    if (!name.empty() && grid->name == name) return grid;
    known.push_back(grid->name);
  }
  if (!name.empty())
    return Failure{ErrorCode::bad_input, "has no grid \"" + name + "\"" + suggestion(name, known, "\"")};
  for (const char* const one : usual)
    for (const grids::Grid* grid : grids)
      if (grid->name == one && fits(grid)) return grid;
  return static_cast<const grids::Grid*>(nullptr);
}

/// Whether "dens" is in a name, in any case.
bool names_density(const std::string& name) {
  const auto is_same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  constexpr std::string_view kPart = "dens";
  return std::search(name.begin(), name.end(), kPart.begin(), kPart.end(), is_same) != name.end();
}

Result<const grids::Grid*> choose_density(GridList grids, const std::string& name) {
  auto grid = choose_grid(grids, name, kDensityNames);
  if (!grid || *grid) return grid;
  for (const grids::Grid* one : grids)
    if (is_number_grid(one) && names_density(one->name)) return one;
  for (const auto fits : {is_number_grid, is_whole_numbers})
    if (const auto first = std::ranges::find_if(grids, fits); first != grids.end()) return *first;
  std::string names;
  for (const grids::Grid* one : grids)
    names += (names.empty() ? "\"" : ", \"") + one->name + "\" (" + std::string(name_of(one->type)) + ")";
  return Failure{ErrorCode::bad_input,
                 "has no grid of numbers to render" +
                     (names.empty() ? "" : ", only " + names + "; name one of vectors to see its lengths")};
}

/// Whether a name is kNoGrid, and no grid's.
bool says_none(GridList grids, const std::string& name) {
  return name == kNoGrid &&
         std::ranges::none_of(grids, [](const grids::Grid* grid) { return grid->name == kNoGrid; });
}

/// Red, green and blue as a grid of numbers each.
using ColorParts = std::array<const grids::Grid*, 3>;

/// The channels of a colour: NAME_r, NAME_g and NAME_b; nulls where one is missing.
ColorParts color_channels(GridList grids, const std::string& name) {
  ColorParts parts{};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const grids::Grid* grid : grids)
      if (!parts[i] && is_number_grid(grid) && grid->name == name + '_' + "rgb"[i]) parts[i] = grid;
  return std::ranges::count(parts, nullptr) > 0 ? ColorParts{} : parts;
}

/// What is rendered of a file.
struct Chosen {
  const grids::Grid* density = nullptr;
  const grids::Grid* heat = nullptr;   ///< Null: nothing glows.
  const grids::Grid* fire = nullptr;   ///< A grid that says where it burns; null: none.
  bool names_heat = false;             ///< Whether the options do.
  const grids::Grid* color = nullptr;  ///< Null: no colours, or in channels.
  ColorParts channels = {};            ///< Of colours; null: none.
  std::vector<const grids::Grid*> masks = {};

  bool has(const grids::Grid* grid) const {
    return grid == density || grid == heat || grid == fire || grid == color ||
           std::ranges::find(channels, grid) != channels.end() ||
           std::ranges::find(masks, grid) != masks.end();
  }
};
/// The grids of masks, and the density only if the options name one.
Result<Chosen> choose_masks(GridList grids, const scene::VolumeOptions& options) {
  Chosen chosen;
  for (const scene::VolumeMask& mask : options.masks) {
    const auto grid = choose_grid(grids, mask.grid, {});
    if (!grid) return grid.failure();
    chosen.masks.push_back(*grid);
  }
  for (const auto& [name, member] :
       {std::pair(options.density, &Chosen::density), {options.heat, &Chosen::heat}}) {
    if (name.empty() || (member == &Chosen::heat && says_none(grids, name))) continue;
    const auto grid = choose_grid(grids, name, {});
    if (!grid) return grid.failure();
    chosen.*member = *grid;
  }
  chosen.names_heat = !options.heat.empty();
  return chosen;
}

/// A grid of vectors, else the channels of a colour.
Result<void> choose_colors(GridList grids, const std::string& name, Chosen& chosen) {
  if (says_none(grids, name)) return {};
  const bool has_name = std::ranges::find(grids, name, &grids::Grid::name) != grids.end();
  if (!has_name) chosen.channels = color_channels(grids, name.empty() ? kChannelName : name);
  if (chosen.channels[0] && !name.empty()) return {};
  const auto color = choose_grid(grids, name, kColorNames, is_colors);
  if (!color) return color.failure();
  chosen.color = *color;
  if (chosen.color) chosen.channels = {};
  return {};
}

Result<Chosen> choose(GridList grids, const scene::VolumeOptions& options) {
  if (!options.masks.empty()) return choose_masks(grids, options);
  const auto density = choose_density(grids, options.density);
  if (!density) return density.failure();
  const bool none = says_none(grids, options.heat);
  const auto heat = choose_grid(grids, none ? "" : options.heat, kTemperatureNames);
  if (!heat) return heat.failure();
  const grids::Grid* const fire = *choose_grid(grids, "", kFireNames);
  Chosen chosen{.density = *density, .names_heat = !options.heat.empty()};
  if (auto colors = choose_colors(grids, options.color, chosen); !colors) return colors.failure();
  if (none) return chosen;
  if (chosen.names_heat) {
    chosen.heat = *heat;
    return chosen;
  }
  // One grid is both only if the options say so.
  const auto hot = *heat ? *heat : fire;
  chosen.heat = hot == *density ? nullptr : hot;
  chosen.fire = fire;
  return chosen;
}

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
bool glows(const Chosen& chosen, const scene::VolumeOptions& options, VolumeFrame& frame) {
  if (!chosen.heat) return false;
  const std::string name = '"' + chosen.heat->name + '"';
  frame.heat_is_kelvin = any_above(*chosen.heat, double{kMostFactor});
  if (chosen.names_heat && !any_above(*chosen.heat, 0)) {
    frame.heat_note = name + " does not glow: none of its values is above 0";
    return false;
  }
  if (!chosen.names_heat && chosen.fire && !any_above(*chosen.fire, 0)) {
    frame.heat_note = name + " does not glow, as nothing of \"" + chosen.fire->name + "\" burns";
    return false;
  }
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
        add(grids::number_of(grid.type, grid.values_of(i).data() + voxel * bytes));
  for (const grids::Tile& tile : grid.tiles)
    if (tile.active) add(grids::number_of(grid.type, tile.value.data()));
  if (!(low < -kRounding * high)) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "\" has values below 0, down to %.4g, which count as 0: a range from below 0 with an opacity "
                "curve draws them",
                low);
  return '"' + grid.name + text;
}

/// Those of a vector grid or of channels. Blender's solver saves these multiplied by the density, which files
/// that other programs wrote again do not say.
Result<std::unique_ptr<volume::SparseVolume>> color_bricks(const Chosen& chosen,
                                                           const grids::BrickVolume& density) {
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

/// Where heat is in the voxels of a density of another transform.
std::optional<grids::Grid> coverage_of_heat(const fs::path& file, const grids::Grid* heat,
                                            const grids::Grid& density) {
  if (!heat || heat->world_from_index == density.world_from_index) return std::nullopt;
  auto covered = grids::coverage_of(*heat, density.world_from_index);
  if (!covered)
    log_warning(file.string() + ": \"" + heat->name + "\" is not drawn beyond the voxels of \"" +
                density.name + "\", which are too small for that");
  return covered;
}

Result<std::shared_ptr<VolumeFrame>> make_frame(const fs::path& file, const grids::GridFile& grids,
                                                const scene::VolumeOptions& options, const VolumeRoom& room) {
  std::vector<const grids::Grid*> list;
  for (const grids::Grid& grid : grids.grids) list.push_back(&grid);
  const auto chosen = choose(list, options);
  if (!chosen) return chosen.failure();
  const std::vector<const grids::Grid*>& masks = chosen->masks;
  auto frame = std::make_shared<VolumeFrame>();
  const grids::Grid* density = chosen->density;
  const bool has_colors = chosen->color || chosen->channels[0];
  const grids::Grid* const heat = glows(*chosen, options, *frame) ? chosen->heat : nullptr;
  grids::Grid joined;
  if (!masks.empty()) {
    auto all = grids::joined_masks(masks);
    if (!all) return all.failure();
    joined = std::move(*all);
    if (!density) density = &joined;
  }
  const auto covered = masks.empty() ? coverage_of_heat(file, heat, *density) : std::nullopt;
  // Heat has the same room as the density.
  const auto part = [&, has_heat = heat != nullptr](std::uint64_t of, std::uint32_t fewest,
                                                    std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(has_heat ? of / 2 : of, fewest, most));
  };
  const std::uint32_t max_bricks = part(room.bricks, grids::kFewestVolumeBricks, grids::kMostVolumeBricks);
  const std::uint32_t max_pages = part(room.pages, grids::kFewestVolumePages, grids::kMostVolumePages);
  // Bricks of colours and masks have the slots of the density's, which reach wherever a mask does.
  const grids::Grid* also = density != &joined && !masks.empty() ? &joined : nullptr;
  if (covered) also = &*covered;
  if (heat && heat->world_from_index == density->world_from_index) also = heat;
  const auto shift = density == &joined ? std::nullopt : shift_of(options);
  auto bricks = grids::make_brick_volume(
      *density, {max_bricks, max_pages, also, !has_colors && masks.empty(), false, shift});
  if (!bricks) return bricks.failure();
  const bool is_chosen = !options.opacity.empty() && options.range && options.range->x < 0;
  if (density != &joined && !is_chosen) frame->value_note = note_of_negative(*density);
  frame->density = std::move(*bricks);
  warn_of_level(file, *density, frame->density);
  warn_of_odd(file, *density, frame->density);
  if (heat)
    if (auto done = add_heat(file, *heat, {.max_bricks = max_bricks, .max_pages = max_pages}, *frame); !done)
      return done.failure();
  if (has_colors) {
    auto colors = color_bricks(*chosen, frame->density);
    if (!colors) return colors.failure();
    frame->colors = std::move(*colors);
  }
  if (!masks.empty()) {
    frame->colors = grids::make_mask_bricks(masks, frame->density);
    if (auto done = find_mask_glow(masks, *frame); !done) return done.failure();
  }
  frame->density_name = density->name;
  measure_first_view(*density, *frame);
  return frame;
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
  const auto chosen = choose(list, {});
  if (!chosen) return chosen.failure();
  VolumeFrame frame;
  glows(*chosen, {}, frame);
  const std::string color = chosen->color ? ", coloured by \"" + chosen->color->name + '"'
                            : chosen->channels[0]
                                ? std::string(", coloured by \"color_r\", \"color_g\", \"color_b\"")
                                : "";
  return '"' + chosen->density->name + '"' + color + (frame.heat_note.empty() ? "" : "; " + frame.heat_note);
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
                                                             grids::GridReader read) {
  const std::string where = options.place.empty() ? "" : options.place + ": ";
  std::vector<std::string> number_grids, color_grids;
  const auto grids = read(file, {.tank_voxels = kMostTankVoxels, .stopped = stopped},
                          [&](GridList heads) -> Result<std::vector<std::size_t>> {
                            for (const grids::Grid* head : heads) {
                              if (is_number_grid(head)) number_grids.push_back(head->name);
                              if (is_colors(head)) color_grids.push_back(head->name);
                            }
                            if (color_channels(heads, kChannelName)[0]) color_grids.push_back(kChannelName);
                            const auto chosen = choose(heads, options);
                            if (!chosen) return chosen.failure();
                            std::vector<std::size_t> positions;
                            for (std::size_t i = 0; i < heads.size(); ++i)
                              if (chosen->has(heads[i])) positions.push_back(i);
                            return positions;
                          });
  if (!grids) return Failure{grids.failure().code, where + grids.failure().message};
  if (stopped && *stopped) return Failure{ErrorCode::internal, file.string() + ": stopped"};
  auto frame = make_frame(file, *grids, options, room);
  if (!frame) return Failure{frame.failure().code, where + file.string() + ": " + frame.failure().message};
  (*frame)->number_grids = std::move(number_grids);
  (*frame)->color_grids = std::move(color_grids);
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

}  // namespace brume::scenario
