// Random volumes as 3D textures and as slice atlases, and the probes that read both.
#pragma once

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "brume_test_shaders.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/passes/probes.h"
#include "tests/passes/volume_projection_probe.h"
#include "tests/reference/slice_atlas.hpp"

namespace brume::passes {

using reference::SliceAtlas, reference::TexelVolume;
using shared::ProjectionOutcome, shared::ProjectionParams;

using Byte4 = std::array<std::uint8_t, 4>;
constexpr VkFormat format_of(const Byte4&) {
  return VK_FORMAT_R8G8B8A8_UNORM;
}
constexpr VkFormat format_of(const Half4&) {
  return VK_FORMAT_R16G16B16A16_SFLOAT;
}
inline glm::dvec4 value_of(const Byte4& t) {
  return glm::dvec4(t[0], t[1], t[2], t[3]) / 255.0;
}
inline glm::dvec4 value_of(const Half4& t) {
  return glm::dvec4(from_half(t));
}
inline void set_texel(Byte4& texel, glm::vec4 value) {
  for (int i = 0; i < 4; ++i)
    texel[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * value[i]));
}
inline void set_texel(Half4& texel, glm::vec4 value) {
  texel = to_half(value);
}

struct Place {
  glm::vec3 dimensions{1}, center{0};
  glm::mat3 axes{1};
};

struct Case {
  SliceAtlas atlas;
  Place place;
  std::string name() const {
    return std::to_string(atlas.tile_texels.x) + "x" + std::to_string(atlas.tile_texels.y) + ", " +
           std::to_string(atlas.tile_count) + " tiles in " + std::to_string(atlas.columns) +
           " columns, padding " + std::to_string(atlas.padding);
  }
};

template <typename Texel>
struct Content {
  std::vector<Texel> texels;
  TexelVolume volume;
};

class VolumeProjectionFixture : public gpu::GpuTest {
 protected:
  /// Random texels in [low, high].
  template <typename Texel>
  Content<Texel> random_content(glm::ivec3 size, float low, float high) {
    std::uniform_real_distribution<float> value(low, high);
    Content<Texel> content;
    content.volume.size = size;
    content.texels.resize(static_cast<std::size_t>(size.x) * size.y * size.z);
    for (Texel& texel : content.texels) {
      set_texel(texel, {value(random_), value(random_), value(random_), value(random_)});
      content.volume.texels.push_back(value_of(texel));
    }
    return content;
  }

  template <typename Texel>
  gpu::Image upload_texels(const std::vector<Texel>& texels, glm::uvec3 size, bool three_dimensional,
                           std::uint32_t mip_levels = 1) {
    gpu::ImageInfo info;
    info.format = format_of(Texel{});
    info.size = size;
    info.three_dimensional = three_dimensional;
    info.mip_levels = mip_levels;
    info.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    gpu::Image image(context(), info);
    const gpu::Recorder::Region all{std::as_bytes(std::span(texels)), glm::ivec3(0), size};
    runner().run([&](gpu::Recorder& recorder) {
      recorder.upload(image, {&all, 1});
      if (mip_levels > 1) recorder.make_mip_levels(image);
    });
    return image;
  }

  /// Tiles with padding that mirrors them; ones where no tile is, so that a fetch of those shows.
  template <typename Texel>
  gpu::Image upload_atlas(const Content<Texel>& content, const SliceAtlas& atlas,
                          std::uint32_t mip_levels = 1) {
    const glm::ivec2 size = atlas.size(), tile_size = atlas.tile_texels;
    Texel one;
    set_texel(one, glm::vec4(1));
    std::vector<Texel> texels(static_cast<std::size_t>(size.x) * size.y, one);
    for (int tile = 0; tile < atlas.tile_count; ++tile)
      for (int y = -atlas.padding; y < tile_size.y + atlas.padding; ++y)
        for (int x = -atlas.padding; x < tile_size.x + atlas.padding; ++x) {
          const glm::ivec2 from(mirrored(x, tile_size.x), mirrored(y, tile_size.y));
          const glm::ivec2 to = atlas.first_texel(tile) + glm::ivec2(x, y);
          texels[static_cast<std::size_t>(to.x + size.x * to.y)] =
              content.texels[static_cast<std::size_t>(from.x + tile_size.x * (from.y + tile_size.y * tile))];
        }
    return upload_texels(texels, {size, 1}, false, mip_levels);
  }
  static int mirrored(int i, int size) {
    return std::clamp(i < 0 ? -1 - i : i < size ? i : 2 * size - 1 - i, 0, size - 1);
  }

  /// Points inside and around the box: random ones, faces, edges and corners, centres of tiles, and far away.
  std::vector<glm::vec4> points(const Case& one, std::size_t count) {
    const double n = one.atlas.tile_count;
    const std::array special{-0.5, 0.5,          -0.5 + 0.5 / n, 0.5 - 0.5 / n,
                             0.0,  -0.5 + 1 / n, -0.5000001,     0.5000001};
    std::uniform_real_distribution<double> near_box(-0.55, 0.55);
    std::vector<glm::vec4> all;
    while (all.size() < count) {
      glm::dvec3 at(near_box(random_), near_box(random_), near_box(random_));
      const bool snaps = all.size() % 4 == 0;
      if (snaps)
        for (int axis = 0; axis < 3; ++axis)
          if (random_() % 2 == 0) at[axis] = special[random_() % special.size()];
      if (snaps && random_() % 2 == 0) at.z = (int(random_() % 64) % one.atlas.tile_count + 0.5) / n - 0.5;
      const glm::dvec3 away = glm::dmat3(one.place.axes) * (at * glm::dvec3(one.place.dimensions));
      all.emplace_back(glm::vec3(glm::dvec3(one.place.center) + away), 0);
    }
    for (int i = 0; i < 64; ++i) {
      const glm::vec3 sides = glm::vec3(i % 4, i / 4 % 4, i / 16) - 1.5f;
      all[static_cast<std::size_t>(i)] = glm::vec4((i % 2 ? 1e30f : FLT_MAX / 1.5f) * sides, 0);
    }
    return all;
  }

  std::vector<ProjectionOutcome> project(const gpu::ComputePipeline& probe, const Case& one,
                                         const gpu::Buffer& points, std::size_t count,
                                         const gpu::Image& atlas, float lod = 0) {
    const glm::mat3& axes = one.place.axes;
    const ProjectionParams params{one.place.dimensions,
                                  lod,
                                  one.place.center,
                                  float(one.atlas.padding),
                                  axes[0],
                                  float(one.atlas.tile_count),
                                  axes[1],
                                  float(one.atlas.columns),
                                  axes[2],
                                  float(one.atlas.rows()),
                                  glm::vec2(one.atlas.tile_texels)};
    outcomes_ = gpu::Buffer(context(), count * sizeof(ProjectionOutcome),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe,
                    {{shared::kBindProbeIn, gpu::read(points)},
                     {shared::kBindProbeIn2, gpu::sampled(atlas, sampler_)},
                     {shared::kBindProbeOut, gpu::write(outcomes_)}},
                    params);
      recorder.dispatch_threads(probe, static_cast<std::uint32_t>(count));
    });
    return read_back<ProjectionOutcome>(outcomes_, count);
  }
  /// What the device makes of the 3D texture at the points projected last.
  std::vector<glm::vec4> filtered(const gpu::Image& volume, std::size_t count) {
    const gpu::Buffer values(context(), count * sizeof(glm::vec4),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(texture_probe_, {{shared::kBindProbeIn, gpu::read(outcomes_)},
                                     {shared::kBindProbeIn2, gpu::sampled(volume, sampler_)},
                                     {shared::kBindProbeOut, gpu::write(values)}});
      recorder.dispatch_threads(texture_probe_, static_cast<std::uint32_t>(count));
    });
    return read_back<glm::vec4>(values, count);
  }

  std::mt19937 random_{1234};
  gpu::ComputePipeline glsl_{context(), shaders::volume_projection_probe_comp};
  gpu::ComputePipeline hlsl_{context(), shaders::volume_projection_probe_hlsl};
  gpu::ComputePipeline texture_probe_{context(), shaders::volume_texture_probe_comp};
  gpu::Sampler sampler_{context(), {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, true, false}};
  gpu::Buffer outcomes_;
};

}  // namespace brume::passes
