#include "apps/cli/flipbook_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/command_line/targets.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

using image::LightSide;
using image::Texels;

/// The value that this fraction of all stays below; 0 of none.
float quantile(std::vector<float> values, double fraction) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The brightness that 1 stands for in the maps of light, relative to a white surface. The brightest rims,
/// lit from behind, are clipped: all else would be dark for them.
float light_scale(const FlipbookSheets& sheets, bool is_straight) {
  constexpr float kLeastAlpha = 1 / 16.0f, kLeastLight = 1 / 64.0f;
  std::vector<float> values;
  for (const std::vector<float>& side : sheets.light)
    for (std::size_t i = 0; i < side.size(); ++i)
      if (const float alpha = sheets.color.rgba[i].a; alpha > kLeastAlpha)
        values.push_back(side[i] / (is_straight ? alpha : 1));
  return std::max(quantile(std::move(values), 0.99), kLeastLight);
}

/// The largest motion of what can be seen, along an axis [parts of a tile]; 1 stands for it.
float motion_scale(const FlipbookSheets& sheets) {
  constexpr float kLeastAlpha = 1 / 16.0f, kLeast = 1 / 1024.0f;
  std::vector<float> values;
  for (std::size_t i = 0; i < sheets.motion.rgba.size(); ++i)
    if (const glm::vec4 texel = sheets.motion.rgba[i]; texel.a > kLeastAlpha)
      values.push_back(std::max(std::abs(texel.x), std::abs(texel.y)));
  return std::max(quantile(std::move(values), 0.999), kLeast);
}

float emission_scale(const FlipbookSheets& sheets) {
  float most = 0;
  for (const glm::vec4& texel : sheets.emission.rgba)
    if (const float light = luminance(texel); std::isfinite(light)) most = std::max(most, light);
  return most;
}

image::LayeredImage layers_of(const Texels& texels) {
  image::LayeredImage image{texels.width, texels.height, {}};
  constexpr std::array kNames{"R", "G", "B", "A"};
  for (int channel = 0; channel < 4; ++channel) {
    std::vector<float> values(texels.rgba.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = texels.rgba[i][channel];
    image.layers.push_back({kNames[static_cast<std::size_t>(channel)], std::move(values)});
  }
  return image;
}

/// Numbers in [0, 1], as they are.
image::NumberImage bytes_of(const Texels& texels) {
  image::NumberImage image{texels.width, texels.height, 4, 8, {}};
  image.values.reserve(4 * texels.rgba.size());
  for (const glm::vec4& texel : texels.rgba)
    for (int channel = 0; channel < 4; ++channel)
      image.values.push_back(
          static_cast<std::uint16_t>(std::lround(255 * std::clamp(texel[channel], 0.0f, 1.0f))));
  return image;
}

void save_numbers(const std::filesystem::path& file, const Texels& texels) {
  if (scene::lower_extension(file) == ".exr")
    image::save_exr(file, layers_of(texels)).value_or_throw();
  else
    image::save_png(file, bytes_of(texels)).value_or_throw();
}

/// By tiles, so that none bleeds into its neighbour.
void fill_tiles(const image::FlipbookLayout& layout, Texels& sheet) {
  for (std::uint32_t tile = 0; tile < layout.tiles(); ++tile) {
    Texels one = image::tile_of(layout, tile, sheet);
    image::fill_transparent(one);
    image::set_tile(layout, tile, one, sheet);
  }
}

void save_colors(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  Texels colors = sheets.color;
  if (is_exr(plan)) {
    if (plan.is_straight) image::make_straight(colors);
    if (plan.is_straight) fill_tiles(plan.layout, colors);
    image::save_exr(plan.output, layers_of(colors)).value_or_throw();
    return;
  }
  colors = plan.is_straight ? image::displayed_straight(colors, sheets.display)
                            : image::displayed(colors, sheets.display);
  if (plan.is_straight) fill_tiles(plan.layout, colors);
  image::save_png(plan.output, image::to_colors(colors)).value_or_throw();
}

/// Three sides of light as R, G and B.
Texels light_map(const FlipbookPlan& plan, const FlipbookSheets& sheets,
                 const std::array<LightSide, 3>& sides, float scale) {
  Texels map = sheets.color;
  for (std::size_t i = 0; i < map.rgba.size(); ++i)
    for (int c = 0; c < 3; ++c)
      map.rgba[i][c] = sheets.light[static_cast<std::size_t>(sides[static_cast<std::size_t>(c)])][i] / scale;
  if (plan.is_straight) {
    image::make_straight(map);
    fill_tiles(plan.layout, map);
  }
  return map;
}

/// The maps of light, and what 1 stands for in them.
Json save_six_way(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  const float scale = is_exr(plan) ? 1 : light_scale(sheets, plan.is_straight), glow = emission_scale(sheets);
  save_numbers(map_file(plan, "_right_top_back"),
               light_map(plan, sheets, {LightSide::right, LightSide::top, LightSide::back}, scale));
  Texels others = light_map(plan, sheets, {LightSide::left, LightSide::bottom, LightSide::front}, scale);
  for (std::size_t i = 0; i < others.rgba.size(); ++i)
    others.rgba[i].a = glow > 0 ? luminance(sheets.emission.rgba[i]) / glow : 0;
  save_numbers(map_file(plan, "_left_bottom_front"), others);
  return {{"light", double{scale}}, {"emission", double{glow}}};
}

void save_normals(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  Texels map = sheets.color;
  for (std::size_t i = 0; i < map.rgba.size(); ++i) {
    glm::vec3 normal = image::normal_of(sheets.light, i);
    if (!plan.normals_up) normal.y = -normal.y;
    map.rgba[i] = glm::vec4(is_exr(plan) ? normal : 0.5f + 0.5f * normal, map.rgba[i].a);
  }
  save_numbers(map_file(plan, "_normals"), map);
}

void save_emission(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  Texels map = is_exr(plan) ? sheets.emission : image::displayed(sheets.emission, sheets.display);
  for (glm::vec4& texel : map.rgba) texel.a = 1;
  const std::filesystem::path file = map_file(plan, "_emission");
  if (is_exr(plan))
    save_numbers(file, map);
  else
    image::save_png(file, image::to_colors(map)).value_or_throw();
}

double save_motion(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  const float scale = is_exr(plan) ? 1 : motion_scale(sheets);
  Texels map = sheets.motion;
  for (glm::vec4& texel : map.rgba) {
    const glm::vec2 motion = glm::vec2(texel.x, plan.motion_up ? -texel.y : texel.y) / scale;
    // 128 is no motion, 1 and 255 are the scale.
    const glm::vec2 stored =
        is_exr(plan) ? motion : (128.0f + 127.0f * glm::clamp(motion, -1.0f, 1.0f)) / 255.0f;
    texel = glm::vec4(stored, 0, 1);
  }
  save_numbers(map_file(plan, "_motion"), map);
  return double{scale};
}

}  // namespace

float luminance(glm::vec4 texel) {
  return glm::dot(glm::vec3(texel), glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

Json save_sheets(const FlipbookPlan& plan, const FlipbookSheets& sheets) {
  Json scales = Json::object();
  save_colors(plan, sheets);
  if (plan.has_six_way) scales.set("six_way_scale", save_six_way(plan, sheets));
  if (plan.has_normals) save_normals(plan, sheets);
  if (plan.has_emission) save_emission(plan, sheets);
  if (plan.has_motion) scales.set("motion_scale", save_motion(plan, sheets));
  return scales;
}

}  // namespace brume::cli
