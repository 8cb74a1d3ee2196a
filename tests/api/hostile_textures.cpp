// The calls of brume_textures.h, and those that write defaults.
#include "tests/api/hostile_calls.hpp"

namespace brume::api {

void Hostile::textures_create() {
  if (!textures_.empty() && !chance(0.15)) return;
  brume_textures_params params = brume_textures_defaults();
  params.noise_spacing = number(3);
  params.light_count = chance(0.9) ? below(3) : number(20);
  params.sky = chance(0.9) ? below(2) : number(3);
  if (chance(0.1)) params.swirl_seconds = real(12);
  brume_drawn_params look = brume_drawn_defaults();
  look.erosion = real(1);
  params.look = chance(0.5) ? nullptr : spoiled(look);
  // `spoiled` has room for one struct: the second is as it should be.
  auto out = output<brume_textures*>();
  keep("brume_textures_create",
       brume_textures_create(handle(fields_), chance(0.03) ? nullptr : &params, out.pointer()), out,
       textures_, brume_textures_destroy);
}

void Hostile::textures_update() {
  std::array<brume_texture_light, BRUME_MAX_TEXTURE_LIGHTS> lights{};
  for (brume_texture_light& light : lights) {
    light.directional = chance(0.9) ? 0 : number(3);
    light.at = light.directional == 1 && chance(0.9) ? brume_point{0, 1, 0} : point(10);
  }
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.seconds = chance(0.9) ? number(500) / 64.0 : real(1e7f);
  frame.lights = chance(0.03) ? nullptr : lights.data();
  frame.light_update_fraction = chance(0.5) ? 1 / 16.0f : real(1);
  checked("brume_textures_update", brume_textures_update(handle(textures_), handle(fields_), spoiled(frame)),
          true);
}

void Hostile::textures_read() {
  std::array<brume_texture, BRUME_TEXTURE_COUNT> list;
  const std::size_t capacity = chance(0.9) ? list.size() : below(11);
  checked("brume_textures_list",
          brume_textures_list(handle(textures_), chance(0.03) ? nullptr : list.data(), capacity), true);
  std::array<float, BRUME_CONSTANTS> constants;
  checked("brume_textures_constants",
          brume_textures_constants(handle(textures_), chance(0.03) ? nullptr : constants.data(),
                                   chance(0.9) ? constants.size() : count(40)),
          true);
  auto regions = output<const brume_region*>();
  auto region_count = output<std::size_t>();
  const brume_result result =
      brume_textures_regions(handle(textures_), regions.pointer(), region_count.pointer());
  if (!checked("brume_textures_regions", result, regions.untouched() && region_count.untouched())) return;
  for (std::size_t i = 0; i < region_count.value(); ++i) {
    const brume_region& region = regions.value()[i];
    EXPECT_LT(region.texture, unsigned{BRUME_TEXTURE_COUNT});
    EXPECT_NE(region.texels, nullptr);
  }
}

void Hostile::textures_destroy() {
  end("brume_textures_destroy", textures_, brume_textures_destroy);
}

void Hostile::defaults() {
  write_defaults("brume_context_params_init", brume_context_params_init);
  write_defaults("brume_voxels_params_init", brume_voxels_params_init);
  write_defaults("brume_triangles_params_init", brume_triangles_params_init);
  write_defaults("brume_world_params_init", brume_world_params_init);
  write_defaults("brume_sender_params_init", brume_sender_params_init);
  write_defaults("brume_receiver_params_init", brume_receiver_params_init);
  write_defaults("brume_field_params_init", brume_field_params_init);
  write_defaults("brume_drawn_params_init", brume_drawn_params_init);
  write_defaults("brume_textures_params_init", brume_textures_params_init);
  write_defaults("brume_textures_frame_init", brume_textures_frame_init);
  auto event = output<brume_event>();
  checked("brume_event_init", brume_event_init(event.pointer(), number(6), number(400)), event.untouched());
}

}  // namespace brume::api
