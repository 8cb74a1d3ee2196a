#include "grids/files/slice_atlas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "core/file.hpp"
#include "core/utf8.hpp"
#include "grids/check.hpp"
#include "grids/files/json.hpp"
#include "grids/suffix.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAtlasFormat = "brume slice atlas";
constexpr int kAtlasVersion = 1;
constexpr std::array kLetters{"R", "G", "B", "A"};
constexpr std::array kDepths{AtlasDepth::unorm8, AtlasDepth::unorm16, AtlasDepth::half, AtlasDepth::float32};

bool is_png(AtlasDepth depth) {
  return depth == AtlasDepth::unorm8 || depth == AtlasDepth::unorm16;
}

/// The greatest number of a texel; 0: floats.
std::uint32_t steps_of(AtlasDepth depth) {
  return depth == AtlasDepth::unorm8 ? 255 : depth == AtlasDepth::unorm16 ? 65535 : 0;
}

/// The values of a level: means of the voxels that a texel of it covers.
DenseGrid level_values(const DenseGrid& grid, const SliceLayout& layout, std::uint32_t level) {
  if (level == 0) return grid;
  const SliceLayout smaller = level_of(layout, level);
  const glm::uvec3 part = layout.size / smaller.size;
  DenseGrid result{grid.name, smaller.size, grid.box, {}};
  result.values.reserve(std::size_t{smaller.size.x} * smaller.size.y * smaller.size.z);
  for (glm::uvec3 at(0); at.z < smaller.size.z; ++at.z)
    for (at.y = 0; at.y < smaller.size.y; ++at.y)
      for (at.x = 0; at.x < smaller.size.x; ++at.x) {
        double sum = 0;
        for (glm::uvec3 in(0); in.z < part.z; ++in.z)
          for (in.y = 0; in.y < part.y; ++in.y)
            for (in.x = 0; in.x < part.x; ++in.x)
              sum += static_cast<double>(grid.values[grid.index(at * part + in)]);
        result.values.push_back(static_cast<float>(sum / (part.x * part.y * part.z)));
      }
  return result;
}

/// The texel that padding shows: mirrored, so that the mean of two texels beside the rim is the mean of the
/// two inside of it, in levels that an engine makes.
std::uint32_t mirrored(std::int64_t at, std::uint32_t edge) {
  if (at < 0) at = -1 - at;
  if (at >= edge) at = 2 * std::int64_t{edge} - 1 - at;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, edge - 1));
}

/// The image of a grid of the layout's size, rows from the top; `nothing` where there is no tile.
std::vector<float> to_texels(const DenseGrid& grid, const SliceLayout& layout, float nothing) {
  const glm::uvec2 size = layout.image_size(), tile = layout.tile(), place = tile + 2 * layout.padding;
  std::vector<float> texels(std::size_t{size.x} * size.y, nothing);
  for (std::uint32_t slice = 0; slice < layout.tiles(); ++slice) {
    const glm::uvec2 first = glm::uvec2(slice % layout.columns, slice / layout.columns) * place;
    for (glm::uvec2 at(0); at.y < place.y; ++at.y)
      for (at.x = 0; at.x < place.x; ++at.x) {
        const glm::uvec2 in_tile(mirrored(std::int64_t{at.x} - layout.padding, tile.x),
                                 mirrored(std::int64_t{at.y} - layout.padding, tile.y));
        texels[first.x + at.x + std::size_t{size.x} * (first.y + at.y)] =
            grid.values[grid.index(layout.voxel(slice, in_tile))];
      }
  }
  return texels;
}

/// The values back, in the order of DenseGrid.
std::vector<float> to_voxels(const std::vector<float>& texels, const SliceLayout& layout) {
  std::vector<float> values(std::size_t{layout.size.x} * layout.size.y * layout.size.z);
  const glm::uvec2 size = layout.image_size(), tile = layout.tile();
  for (std::uint32_t slice = 0; slice < layout.tiles(); ++slice)
    for (glm::uvec2 at(0); at.y < tile.y; ++at.y)
      for (at.x = 0; at.x < tile.x; ++at.x) {
        const glm::uvec2 texel = layout.texel(slice, at);
        const glm::uvec3 voxel = layout.voxel(slice, at);
        values[voxel.x + std::size_t{layout.size.x} * (voxel.y + std::size_t{layout.size.y} * voxel.z)] =
            texels[texel.x + std::size_t{size.x} * texel.y];
      }
  return values;
}

/// The nearest number in [0, steps] to a value.
std::uint16_t encode(float value, const AtlasRange& range, std::uint32_t steps) {
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  const double position = (static_cast<double>(value) - low) / (high - low);
  // NaN fails both comparisons.
  return static_cast<std::uint16_t>(std::lround(steps * (position > 0 ? std::min(position, 1.0) : 0.0)));
}

/// The value that a number stands for.
float decode(std::uint16_t code, const AtlasRange& range, std::uint32_t steps) {
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  return static_cast<float>(low + (high - low) * code / steps);
}

// Writes an atlas: an image of each level, and a description.

image::NumberImage make_png(const SliceAtlas& atlas, std::uint32_t level) {
  const SliceLayout layout = level_of(atlas.layout, level);
  const glm::uvec2 size = layout.image_size();
  const auto stored = static_cast<std::uint32_t>(atlas.channels.size());
  // PNG has no images of two channels of colour.
  image::NumberImage image{
      size.x, size.y, stored == 2 ? 3 : stored, atlas.depth == AtlasDepth::unorm8 ? 8u : 16u, {}};
  image.values.resize(std::size_t{size.x} * size.y * image.channels);
  const std::uint32_t steps = steps_of(atlas.depth);
  for (std::size_t channel = 0; channel < stored; ++channel) {
    const AtlasRange& range = atlas.ranges[channel];
    const std::vector<float> texels =
        to_texels(level_values(atlas.channels[channel], atlas.layout, level), layout, range.low);
    for (std::size_t i = 0; i < texels.size(); ++i)
      image.values[i * image.channels + channel] = encode(texels[i], range, steps);
  }
  return image;
}

image::LayeredImage make_exr(const SliceAtlas& atlas, std::uint32_t level) {
  const SliceLayout layout = level_of(atlas.layout, level);
  const glm::uvec2 size = layout.image_size();
  image::LayeredImage image{size.x, size.y, {}};
  for (std::size_t channel = 0; channel < atlas.channels.size(); ++channel) {
    std::vector<float> texels =
        to_texels(level_values(atlas.channels[channel], atlas.layout, level), layout, 0);
    if (atlas.depth == AtlasDepth::float32) {
      image.layers.push_back({kLetters[channel], std::move(texels)});
      continue;
    }
    std::vector<std::uint16_t> halves(texels.size());
    std::ranges::transform(texels, halves.begin(), [](float value) { return glm::packHalf1x16(value); });
    image.layers.push_back({kLetters[channel], std::move(halves)});
  }
  // Readers of colours, such as Godot's, refuse a file with two of them.
  if (image.layers.size() == 2) {
    image.layers.push_back(image.layers.front());
    image.layers.back().name = kLetters[2];
    std::visit([](auto& values) { values.assign(values.size(), 0); }, image.layers.back().values);
  }
  return image;
}

Json make_description(const SliceAtlas& atlas, const std::vector<std::string>& images) {
  const SliceLayout& layout = atlas.layout;
  const glm::uvec2 tile = layout.tile(), size = layout.image_size();
  Json channels = Json::array();
  for (std::size_t i = 0; i < atlas.channels.size(); ++i)
    channels.push_back({{"name", atlas.channels[i].name},
                        {"in", kLetters[i]},
                        {"range", {atlas.ranges[i].low, atlas.ranges[i].high}}});
  const Box<double>& box = atlas.channels.front().box;
  Json json{{"format", kAtlasFormat},
            {"version", kAtlasVersion},
            {"images", images},
            {"depth", name_of(atlas.depth)},
            {"image_size", {size.x, size.y}},
            {"tile", {tile.x, tile.y}},
            {"tiles", layout.tiles()},
            {"columns", layout.columns},
            {"padding", layout.padding},
            {"axes", to_text(layout.axes)},
            {"size", {layout.size.x, layout.size.y, layout.size.z}},
            {"box", {{"low", to_json(box.low)}, {"high", to_json(box.high)}}},
            {"channels", channels}};
  if (atlas.world_from_box != glm::dmat4(1)) json["world_from_box"] = to_json(atlas.world_from_box);
  return json;
}

// Reads it back.

/// Contents of a description.
struct AtlasDescription {
  SliceAtlas atlas;  ///< Without values.
  std::vector<std::string> images;
  glm::ivec2 image_size{0}, tile{0};
  std::int64_t tiles = 0;
};

std::optional<glm::ivec2> to_pair(const Json& list) {
  if (!list.is_array() || list.size() != 2) return std::nullopt;
  const auto x = to_integer(list[0], 1, image::kMaxAxis), y = to_integer(list[1], 1, image::kMaxAxis);
  if (!x || !y) return std::nullopt;
  return glm::ivec2(*x, *y);
}

bool set_images(AtlasDescription& to, const Json& list) {
  if (!list.is_array() || list.empty() || list.size() > 32) return false;
  for (const Json& name : list) {
    if (!name.is_string()) return false;
    to.images.push_back(name.get<std::string>());
    // In the same folder: a description may come from elsewhere.
    const fs::path path = to_path(to.images.back());
    if (path.empty() || path.filename() != path) return false;
  }
  return true;
}

bool set_box(SliceAtlas& to, const Json& box) {
  if (!box.is_object() || box.size() != 2 || !box.contains("low") || !box.contains("high")) return false;
  const auto low = to_point(box["low"]), high = to_point(box["high"]);
  if (!low || !high || !glm::all(glm::lessThan(*low, *high))) return false;
  to.channels.resize(1);
  to.channels.front().box = {*low, *high};
  return glm::all(glm::lessThan(*high - *low, glm::dvec3(1e30)));
}

bool set_channels(AtlasDescription& to, const Json& list) {
  if (!list.is_array() || list.empty() || list.size() > kMostAtlasChannels) return false;
  to.atlas.channels.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Json& one = list[i];
    if (!one.is_object() || one.size() != 3 || !one.contains("name") || !one["name"].is_string() ||
        !one.contains("in") || one["in"] != kLetters[i] || !one.contains("range"))
      return false;
    const Json& range = one["range"];
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number())
      return false;
    to.atlas.channels[i].name = one["name"].get<std::string>();
    to.atlas.ranges.push_back({range[0].get<float>(), range[1].get<float>()});
  }
  return true;
}

// False unless the value is what the key takes.
bool set_layout_member(AtlasDescription& to, const std::string& key, const Json& value) {
  SliceLayout& layout = to.atlas.layout;
  if (key == "axes") {
    const auto axes = value.is_string() ? parse_axes(value.get<std::string>()) : std::nullopt;
    if (axes) layout.axes = *axes;
    return axes.has_value();
  }
  if (key == "size") {
    const auto size = to_integers(value, 1, image::kMaxAxis);
    if (size) layout.size = glm::uvec3(*size);
    return size.has_value();
  }
  if (key == "columns" || key == "padding") {
    const auto number = to_integer(value, key == "columns" ? 1 : 0, image::kMaxAxis);
    if (number) (key == "columns" ? layout.columns : layout.padding) = static_cast<std::uint32_t>(*number);
    return number.has_value();
  }
  if (key == "tiles") {
    to.tiles = to_integer(value, 1, image::kMaxAxis).value_or(0);
    return to.tiles > 0;
  }
  const auto pair = to_pair(value);
  if (pair) (key == "tile" ? to.tile : to.image_size) = *pair;
  return pair.has_value();
}

bool set_member(AtlasDescription& to, const std::string& key, const Json& value) {
  if (key == "format") return value == kAtlasFormat;
  if (key == "version") return value == kAtlasVersion;
  if (key == "images") return set_images(to, value);
  if (key == "box") return true;  // set_box, after the channels
  if (key == "channels") return set_channels(to, value);
  if (key == "depth") {
    const auto depth = std::ranges::find_if(kDepths, [&](AtlasDepth one) { return value == name_of(one); });
    if (depth == kDepths.end()) return false;
    to.atlas.depth = *depth;
    return true;
  }
  if (key == "world_from_box") {
    const auto m = to_transform(value);
    if (m) to.atlas.world_from_box = *m;
    return m && std::abs(glm::determinant(glm::dmat3(*m))) > 0;
  }
  for (const char* one : {"axes", "size", "columns", "padding", "tiles", "tile", "image_size"})
    if (key == one) return set_layout_member(to, key, value);
  return false;
}

/// What an engine reads must be what the volume is read from.
std::optional<std::string> contradiction_in(const AtlasDescription& d) {
  const SliceLayout& layout = d.atlas.layout;
  if (layout.tiles() != d.tiles)
    return "\"tiles\" is " + std::to_string(d.tiles) + ", but \"size\" has " +
           std::to_string(layout.tiles()) + " voxels along the last of \"axes\"";
  if (glm::ivec2(layout.tile()) != d.tile)
    return "\"tile\" differs from \"size\" along the first two of \"axes\"";
  if (glm::ivec2(layout.image_size()) != d.image_size)
    return "\"image_size\" differs from what \"tile\", \"columns\" and \"padding\" give";
  if (d.images.size() > level_count(layout)) return "\"images\" has more levels than the tiles can be halved";
  return std::nullopt;
}

Result<AtlasDescription> read_atlas_description(const fs::path& path) {
  const auto json = read_json_object(path);
  if (!json) return json.failure();
  AtlasDescription d;
  for (const auto& [key, value] : json->items())
    if (!set_member(d, key, value))
      return bad_description(path, "\"" + key + "\" is unknown or has a wrong value");
  for (const char* key : {"format", "version", "images", "depth", "image_size", "tile", "tiles", "columns",
                          "padding", "axes", "size", "box", "channels"})
    if (!json->contains(key)) return bad_description(path, std::string("\"") + key + "\" is missing");
  SliceAtlas boxed;
  if (!set_box(boxed, (*json)["box"]))
    return bad_description(path, "\"box\" is unknown or has a wrong value");
  for (DenseGrid& channel : d.atlas.channels) {
    channel.box = boxed.channels.front().box;
    channel.size = d.atlas.layout.size;
  }
  if (const auto fault = fault_of(d.atlas)) return bad_description(path, *fault);
  if (const auto fault = contradiction_in(d)) return bad_description(path, *fault);
  return d;
}

Failure wrong_size(const fs::path& image, const fs::path& json, std::uint32_t width, std::uint32_t height,
                   glm::uvec2 expected) {
  return bad_description(image, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                    " texels; " + json.string() + " describes " + std::to_string(expected.x) +
                                    " x " + std::to_string(expected.y));
}

Result<void> read_png(const fs::path& path, const fs::path& json, std::span<const std::byte> bytes,
                      SliceAtlas& atlas) {
  const auto image = image::decode_png_numbers(bytes, path.string());
  if (!image) return image.failure();
  const glm::uvec2 size = atlas.layout.image_size();
  if (glm::uvec2(image->width, image->height) != size)
    return wrong_size(path, json, image->width, image->height, size);
  const std::uint32_t bits = atlas.depth == AtlasDepth::unorm8 ? 8 : 16;
  if (image->bits != bits)
    return bad_description(path, "has " + std::to_string(image->bits) + " bits per channel; " +
                                     json.string() + " describes " + std::to_string(bits));
  if (image->channels < atlas.channels.size())
    return bad_description(path, "has " + std::to_string(image->channels) + " channels; " + json.string() +
                                     " describes " + std::to_string(atlas.channels.size()));
  const std::uint32_t steps = steps_of(atlas.depth);
  for (std::size_t channel = 0; channel < atlas.channels.size(); ++channel) {
    std::vector<float> texels(std::size_t{size.x} * size.y);
    for (std::size_t i = 0; i < texels.size(); ++i)
      texels[i] = decode(image->values[i * image->channels + channel], atlas.ranges[channel], steps);
    atlas.channels[channel].values = to_voxels(texels, atlas.layout);
  }
  return {};
}

Result<void> read_exr(const fs::path& path, const fs::path& json, std::span<const std::byte> bytes,
                      SliceAtlas& atlas) {
  const auto image = image::decode_exr(bytes, path.string());
  if (!image) return image.failure();
  const glm::uvec2 size = atlas.layout.image_size();
  if (glm::uvec2(image->width, image->height) != size)
    return wrong_size(path, json, image->width, image->height, size);
  for (std::size_t channel = 0; channel < atlas.channels.size(); ++channel) {
    const auto layer = std::ranges::find(image->layers, kLetters[channel], &image::Layer::name);
    if (layer == image->layers.end())
      return bad_description(path, std::string("has no channel ") + kLetters[channel] + ", which " +
                                       json.string() + " describes");
    std::vector<float> texels(std::size_t{size.x} * size.y);
    if (const auto* halves = std::get_if<0>(&layer->values))
      std::ranges::transform(*halves, texels.begin(),
                             [](std::uint16_t half) { return glm::unpackHalf1x16(half); });
    else
      texels = std::get<1>(layer->values);
    atlas.channels[channel].values = to_voxels(texels, atlas.layout);
  }
  return {};
}

}  // namespace

const char* name_of(AtlasDepth depth) {
  constexpr std::array kNames{"unorm8", "unorm16", "half", "float32"};
  return kNames.at(static_cast<std::size_t>(depth));
}

AtlasRange range_of(const DenseGrid& grid) {
  float low = 0, high = 0;
  for (const float value : grid.values) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  if (low >= 0 && high <= 1) return {0, 1};
  return {low, high};
}

std::optional<std::string> fault_of(const SliceAtlas& atlas) {
  if (auto fault = fault_of(atlas.layout)) return fault;
  if (atlas.channels.empty() || atlas.channels.size() > kMostAtlasChannels)
    return std::to_string(atlas.channels.size()) + " channels; an image holds 1 to 4";
  BRUME_ASSERT(atlas.ranges.size() == atlas.channels.size(), "");
  const Box<double>& box = atlas.channels.front().box;
  if (!glm::all(glm::lessThan(box.low, box.high)) ||
      !glm::all(glm::lessThan(box.high - box.low, glm::dvec3(1e30))))
    return "its box is empty or infinite";
  for (std::size_t i = 0; i < atlas.channels.size(); ++i) {
    const DenseGrid& grid = atlas.channels[i];
    BRUME_ASSERT(grid.size == atlas.layout.size && grid.box == box, grid.name);
    const auto [low, high] = atlas.ranges[i];
    if (!std::isfinite(low) || !std::isfinite(high) || !(low < high) || !std::isfinite(high - low))
      return "the range of channel \"" + grid.name +
             "\" is empty or infinite; its low end lies below its high";
    // A float holds 24 bits: a step of the range is then at least four of the floats' own.
    const float largest = std::max(std::abs(low), std::abs(high));
    if (const auto steps = static_cast<float>(steps_of(atlas.depth));
        largest * steps > (high - low) * 0x1p22f)
      return "the range of channel \"" + grid.name + "\" is too narrow beside its values for " +
             name_of(atlas.depth) + "; store floats in an .exr file";
  }
  return std::nullopt;
}

fs::path atlas_image_path(const fs::path& json, AtlasDepth depth, std::uint32_t level) {
  fs::path path = json;
  path.replace_extension();
  if (level > 0) path += to_path("_mip" + std::to_string(level));
  path += is_png(depth) ? ".png" : ".exr";
  return path;
}

Result<void> save_slice_atlas(const fs::path& json, const SliceAtlas& atlas, std::uint32_t levels) {
  if (const auto fault = fault_of(atlas)) return bad_description(json, *fault);
  BRUME_ASSERT(levels >= 1 && levels <= level_count(atlas.layout), std::to_string(levels));
  std::vector<std::string> images;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const fs::path path = atlas_image_path(json, atlas.depth, level);
    images.push_back(path.filename().string());
    const auto saved = is_png(atlas.depth) ? image::save_png(path, make_png(atlas, level))
                                           : image::save_exr(path, make_exr(atlas, level));
    if (!saved) return saved;
  }
  const std::string text =
      make_description(atlas, images).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return write_file_atomic(json, text);
}

Result<bool> is_slice_atlas(const fs::path& path) {
  const auto json = read_json_object(path);
  if (!json) return json.failure();
  return json->contains("format") && (*json)["format"] == kAtlasFormat;
}

Result<std::optional<SliceLayout>> read_slice_layout(const fs::path& json) {
  const auto is_atlas = is_slice_atlas(json);
  if (!is_atlas) return is_atlas.failure();
  if (!*is_atlas) return std::optional<SliceLayout>();
  const auto description = read_atlas_description(json);
  if (!description) return description.failure();
  return std::optional(description->atlas.layout);
}

Result<std::vector<fs::path>> read_atlas_images(const fs::path& json) {
  const auto description = read_atlas_description(json);
  if (!description) return description.failure();
  std::vector<fs::path> images;
  for (const std::string& name : description->images) images.push_back(json.parent_path() / to_path(name));
  return images;
}

Result<SliceAtlas> load_slice_atlas(const fs::path& json, const GridLimits& limits) {
  auto description = read_atlas_description(json);
  if (!description) return description.failure();
  SliceAtlas& atlas = description->atlas;
  const glm::uvec3 size = atlas.layout.size;
  const std::uint64_t voxels = std::uint64_t{size.x} * size.y * size.z;
  if (auto fits = check_memory(voxels * atlas.channels.size() * sizeof(float), limits); !fits)
    return Failure{fits.failure().code, json.string() + ": " + fits.failure().message};
  const fs::path image = json.parent_path() / to_path(description->images.front());
  const auto bytes = read_file(image, limits.bytes);
  if (!bytes) return bytes.failure();
  const auto read =
      is_png(atlas.depth) ? read_png(image, json, *bytes, atlas) : read_exr(image, json, *bytes, atlas);
  if (!read) return read.failure();
  return std::move(atlas);
}

GridFile to_grids(const SliceAtlas& atlas) {
  GridFile file;
  for (const DenseGrid& channel : atlas.channels)
    file.grids.push_back(to_grid(channel, atlas.world_from_box));
  return file;
}

}  // namespace brume::grids
