#include <brume/brume_textures.h>

#include <algorithm>
#include <cmath>

#include "api/smoke_field.hpp"
#include "textures/smoke_textures.hpp"

struct brume_textures : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::textures;
  brume_textures(const brume_field& field, const brume::textures::SmokeTexturesSettings& texture_settings)
      : Handle(kKind, field.settings),
        level(field.level),
        masks(field.masks),
        textures(texture_settings, field.masks),
        light_count(texture_settings.light_count) {}

  std::shared_ptr<const brume::api::LevelData> level;
  std::shared_ptr<const brume::smoke::MaskAtlas> masks;
  brume::textures::SmokeTextures textures;
  std::uint32_t light_count;
  std::vector<brume_region> regions;  // regions of the last update
};

namespace brume::api {
namespace {

using textures::kSmokeTextures;
using textures::Texture;

static_assert(+kSmokeTextures == +BRUME_TEXTURE_COUNT && +textures::kLight == +BRUME_TEXTURE_LIGHT &&
              +textures::kHoles == +BRUME_TEXTURE_HOLES);
static_assert(static_cast<int>(textures::Format::rgba32ui) == BRUME_FORMAT_RGBA32UI);
static_assert(4 * textures::kConstantRows == BRUME_CONSTANTS);
static_assert(textures::kMostHoles == BRUME_MAX_TEXTURE_HOLES);
static_assert(textures::LightVolume::kMostLights == BRUME_MAX_TEXTURE_LIGHTS);

void create_textures(Call& call, const brume_field* field, const brume_textures_params* given,
                     brume_textures** textures) {
  const brume_field& source = call.handle(field);
  required(textures, "textures");
  const brume_textures_params params = params_or_defaults(given);
  require(params.swirl_seconds >= 0.1f && params.swirl_seconds <= 1000,
          "`swirl_seconds` must be from 0.1 to 1000");
  require(params.noise_spacing == 1 || params.noise_spacing == 2, "`noise_spacing` must be 1 or 2");
  require(params.light_count <= BRUME_MAX_TEXTURE_LIGHTS, "`light_count` must be at most 15");
  require(params.sky <= 1, "`sky` must be 0 or 1");
  textures::SmokeTexturesSettings settings;
  settings.noise = noise_look_of(params.look);
  settings.swirl_period = double{params.swirl_seconds};
  settings.noise_spacing = static_cast<int>(params.noise_spacing);
  settings.light_count = params.light_count;
  settings.sky = params.sky != 0;
  create(textures, source, settings);
}

std::vector<textures::Light> lights_of(const brume_textures_frame& frame, std::uint32_t count) {
  std::vector<textures::Light> lights;
  if (count > 0) required(frame.lights, "lights");
  for (std::uint32_t i = 0; i < count; ++i) {
    const brume_texture_light& light = frame.lights[i];
    const glm::vec3 at(light.at.x, light.at.y, light.at.z);
    const std::string name = "light " + std::to_string(i);
    if (light.directional > 1) refuse(name + ": `directional` must be 0 or 1");
    if (light.directional == 1 && !(std::abs(glm::length(at) - 1) < 1e-3f))
      refuse(name + ": `at` must be a unit vector towards the sun");
    if (!is_in_world(light.at)) refuse(name + ": `at` must be finite, within 16384 m of the world's origin");
    lights.push_back({light.directional == 1, at});
  }
  return lights;
}

/// What a caller uploads.
std::vector<brume_region> list_regions(const textures::TextureSet& set) {
  std::vector<brume_region> list;
  list.reserve(set.regions().size());
  for (const textures::Region& region : set.regions()) {
    const glm::uvec3 at(region.origin), size(region.size);
    list.push_back({region.texture, at.x, at.y, at.z, size.x, size.y, size.z, 0,
                    set.bytes().data() + region.first_byte, region.byte_count});
  }
  return list;
}

void update(brume_textures& textures, const brume_field& field, const brume_textures_frame& params) {
  if (field.level != textures.level || field.masks != textures.masks)
    fail(BRUME_ERROR_MISMATCH,
         "the field must have the level and the masks of the field that the textures are of");
  const std::vector<textures::Light> lights = lights_of(params, textures.light_count);
  const float fraction = params.light_update_fraction;
  textures.regions.clear();  // their texels go, also where the update fails
  textures.textures.update(field.field->smoke(),
                           {params.seconds, field.extinction, lights, fraction > 0 ? fraction : 1});
  textures.regions = list_regions(textures.textures.set());
}

}  // namespace
}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_textures_create(const brume_field* field, const brume_textures_params* params,
                                   brume_textures** textures) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { create_textures(call, field, params, textures); });
}

brume_result brume_textures_destroy(brume_textures* textures) BRUME_NOEXCEPT {
  return destroy(__func__, textures);
}

brume_result brume_textures_update(brume_textures* textures, const brume_field* field,
                                   const brume_textures_frame* frame) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_textures& object = call.handle(textures);
    const brume_field& source = call.handle(field);
    const brume_textures_frame params = required_params(frame, "frame");
    require(params.seconds >= 0 && params.seconds <= 1e7, "`seconds` must be from 0 to 10^7");
    require(params.light_update_fraction == 0 ||
                (params.light_update_fraction >= 1 / 16.0f && params.light_update_fraction <= 1),
            "`light_update_fraction` must be 0, or from 1/16 to 1");
    call.change(
        object, [&] { call.read(source, [&] { update(object, source, params); }); }, true);
  });
}

brume_result brume_textures_list(const brume_textures* textures, brume_texture* list,
                                 size_t capacity) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_textures& object = call.handle(textures);
    required(list, "list");
    require(capacity >= BRUME_TEXTURE_COUNT, "`capacity` must be at least BRUME_TEXTURE_COUNT");
    call.read(object, [&] {
      for (const Texture& texture : object.textures.set().textures()) {
        const glm::uvec3 size(texture.size);
        *list++ = {static_cast<std::uint32_t>(texture.format), size.x, size.y, size.z, texture.generation};
      }
    });
  });
}

brume_result brume_textures_regions(const brume_textures* textures, const brume_region** regions,
                                    size_t* count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_textures& object = call.handle(textures);
    required(regions, "regions");
    required(count, "count");
    call.read(object, [&] {
      *regions = object.regions.data();
      *count = object.regions.size();
    });
  });
}

brume_result brume_textures_constants(const brume_textures* textures, float* constants,
                                      size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_textures& object = call.handle(textures);
    required(constants, "constants");
    require(count == BRUME_CONSTANTS, "`count` must be BRUME_CONSTANTS");
    call.read(object, [&] {
      for (const glm::vec4& row : object.textures.constants())
        for (int i = 0; i < 4; ++i) *constants++ = row[i];
    });
  });
}

}  // extern "C"
