#include "volumes/volume_grids.hpp"

#include <algorithm>
#include <cctype>

#include "core/similar.hpp"
#include "grids/color_bricks.hpp"

namespace brume::volumes {
namespace {

/// The names that Blender, Houdini and EmberGen give, in order.
constexpr std::array kDensityNames{"density", "Density", "smoke", "fog", "soot", "surface"};
constexpr std::array kColorNames{"Cd", "color", "colour", "Color", "Colour"};
constexpr std::array kTemperatureNames{"temperature", "heat"};
constexpr std::array kFireNames{"flame", "flames", "fire", "burn"};

bool is_whole_numbers(const grids::Grid* grid) {
  return grid->type == grids::ValueType::int32 || grid->type == grids::ValueType::int64 ||
         grid->type == grids::ValueType::boolean;
}

/// The position of a grid among all of its name.
std::size_t number_of(GridList grids, const grids::Grid* grid) {
  std::size_t number = 0;
  for (const grids::Grid* one : grids) {
    if (one == grid) break;
    number += one->name == grid->name;
  }
  return number;
}

/// As OpenVDB tells grids of one name apart.
std::string title_of(GridList grids, const grids::Grid* grid) {
  const std::size_t number = number_of(grids, grid);
  if (number == 0) return grid->name;
  return grid->name + '[' + std::to_string(number) + ']';
}

/// The grid of a name, or of "NAME[2]" the third of that name; null: none.
const grids::Grid* named_grid(GridList grids, const std::string& name) {
  for (const grids::Grid* grid : grids)
    if (grid->name == name) return grid;
  for (const grids::Grid* grid : grids)
    if (grid->name + '[' + std::to_string(number_of(grids, grid)) + ']' == name) return grid;
  return nullptr;
}

/// The grid of a name; without one the first of the usual names; null: none.
Result<const grids::Grid*> choose_grid(GridList grids, const std::string& name,
                                       std::span<const char* const> usual,
                                       bool (*fits)(const grids::Grid*) = is_number_grid) {
  if (!name.empty()) {
    if (const grids::Grid* const grid = named_grid(grids, name)) return grid;
    const auto known = titles_of(grids, [](const grids::Grid*) { return true; });
    return Failure{ErrorCode::bad_input, "has no grid \"" + name + "\"" + suggestion(name, known, "\"")};
  }
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

/// The channels of a colour: NAME_r, NAME_g and NAME_b; null: it is missing.
ColorParts color_channels(GridList grids, const std::string& name) {
  ColorParts parts{};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const grids::Grid* grid : grids)
      if (!parts[i] && is_number_grid(grid) && grid->name == name + '_' + "rgb"[i]) parts[i] = grid;
  return parts;
}

bool is_whole(const ColorParts& parts) {
  return std::ranges::count(parts, nullptr) == 0;
}

/// A note that a colour is not drawn, as channels of it are missing; empty: all are there, or none.
std::string missing_channels(const ColorParts& parts, const std::string& name) {
  std::string there, missing;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string& list = parts[i] ? there : missing;
    list += (list.empty() ? "\"" : ", \"") + name + '_' + "rgb"[i] + '"';
  }
  if (there.empty() || missing.empty()) return "";
  return "the colour of " + there + " is not drawn, as the file has no " + missing;
}

/// Notes that the first of several grids with one name is drawn, unless the options number it.
void note_of_several(GridList grids, const grids::Grid* grid, const std::string& chosen_name,
                     std::vector<std::string>& notes) {
  if (!grid || (!chosen_name.empty() && chosen_name != grid->name)) return;
  const auto count = std::ranges::count(grids, grid->name, &grids::Grid::name);
  if (count < 2) return;
  const std::string other = grid->name + (number_of(grids, grid) == 0 ? "[1]" : "[0]");
  notes.push_back(std::to_string(count) + " grids are called \"" + grid->name + "\": \"" +
                  title_of(grids, grid) + "\" is drawn; name another, such as \"" + other + "\", to see it");
}

/// The grids of masks, and the density only if the options name one.
Result<ChosenGrids> choose_masks(GridList grids, const scene::VolumeOptions& options) {
  ChosenGrids chosen;
  for (const scene::VolumeMask& mask : options.masks) {
    const auto grid = choose_grid(grids, mask.grid, {});
    if (!grid) return grid.failure();
    chosen.masks.push_back(*grid);
  }
  for (const auto& [name, member] :
       {std::pair(options.density, &ChosenGrids::density), {options.heat, &ChosenGrids::heat}}) {
    if (name.empty() || (member == &ChosenGrids::heat && says_none(grids, name))) continue;
    const auto grid = choose_grid(grids, name, {});
    if (!grid) return grid.failure();
    chosen.*member = *grid;
  }
  chosen.names_heat = !options.heat.empty();
  return chosen;
}

/// A grid of vectors, else the channels of a colour.
Result<void> choose_colors(GridList grids, const std::string& name, ChosenGrids& chosen) {
  if (says_none(grids, name)) return {};
  const std::string stem = name.empty() ? kChannelName : name;
  const ColorParts parts = named_grid(grids, name) ? ColorParts{} : color_channels(grids, stem);
  const std::string missing = missing_channels(parts, stem);
  if (is_whole(parts)) chosen.channels = parts;
  if (is_whole(parts) && !name.empty()) return {};
  if (!missing.empty() && !name.empty()) return Failure{ErrorCode::bad_input, missing};
  const auto color = choose_grid(grids, name, kColorNames, is_color_vectors);
  if (!color) return color.failure();
  chosen.color = *color;
  if (chosen.color) chosen.channels = {};
  if (!chosen.color && !missing.empty()) chosen.notes.push_back(missing);
  return {};
}

Result<ChosenGrids> choose_shown(GridList grids, const scene::VolumeOptions& options) {
  if (!options.masks.empty()) return choose_masks(grids, options);
  const auto density = choose_density(grids, options.density);
  if (!density) return density.failure();
  const bool none = says_none(grids, options.heat);
  const auto heat = choose_grid(grids, none ? "" : options.heat, kTemperatureNames);
  if (!heat) return heat.failure();
  const grids::Grid* const fire = *choose_grid(grids, "", kFireNames);
  ChosenGrids chosen{.density = *density, .names_heat = !options.heat.empty()};
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

}  // namespace

bool is_number_grid(const grids::Grid* grid) {
  return grid->type == grids::ValueType::float32 || grid->type == grids::ValueType::float64;
}

bool is_color_vectors(const grids::Grid* grid) {
  return grids::is_color_grid(*grid);
}

std::vector<std::string> titles_of(GridList grids, bool (*fits)(const grids::Grid*)) {
  std::vector<std::string> titles;
  for (const grids::Grid* grid : grids)
    if (fits(grid)) titles.push_back(title_of(grids, grid));
  return titles;
}

bool has_color_channels(GridList grids) {
  return is_whole(color_channels(grids, kChannelName));
}

Result<ChosenGrids> choose_grids(GridList grids, const scene::VolumeOptions& options) {
  auto chosen = options.masks.empty() ? choose_shown(grids, options) : choose_masks(grids, options);
  if (!chosen) return chosen;
  note_of_several(grids, chosen->density, options.density, chosen->notes);
  note_of_several(grids, chosen->heat, options.heat, chosen->notes);
  note_of_several(grids, chosen->color, options.color, chosen->notes);
  return chosen;
}

}  // namespace brume::volumes
