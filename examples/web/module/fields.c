// What a player sees: the smoke as textures, and lines of sight.
#include <brume/brume_textures.h>
#include <math.h>
#include <stddef.h>

#include "parts.h"

// JavaScript reads these structs as words, in the order of their members.
_Static_assert(sizeof(brume_texture) == 20, "five words");
_Static_assert(sizeof(brume_region) == 40 && offsetof(brume_region, texels) == 32, "ten words");

static brume_textures* g_textures[kPlayers];
static brume_texture g_list[BRUME_TEXTURE_COUNT];
static const brume_region* g_regions;
static size_t g_region_count;
static float g_constants[BRUME_CONSTANTS];
static brume_texture_light g_smoke_lights[BRUME_MAX_TEXTURE_LIGHTS];
static uint32_t g_smoke_light_count;

const uint32_t* web_texture_list(void) {
  return &g_list[0].format;
}
const uint32_t* web_regions(void) {
  return &g_regions->texture;
}
uint32_t web_region_count(void) {
  return (uint32_t)g_region_count;
}
const float* web_constants(void) {
  return g_constants;
}

int web_add_texture_light(const float* at, uint32_t is_directional) {
  if (g_smoke_light_count == BRUME_MAX_TEXTURE_LIGHTS) return BRUME_ERROR_LIMIT;
  g_smoke_lights[g_smoke_light_count++] = (brume_texture_light){is_directional, point_of(at)};
  return 0;
}

// The look of scenes/demo.toml.
static brume_drawn_params look(void) {
  brume_drawn_params params = brume_drawn_defaults();
  params.erosion = 0.8f;
  params.noise_size = 1.6f;
  params.hole_rim = 0.02f;
  return params;
}

static int make_textures(uint32_t player) {
  const brume_drawn_params drawn = look();
  brume_textures_params params = brume_textures_defaults();
  params.look = &drawn;
  params.noise_spacing = 2;
  params.light_count = g_smoke_light_count;
  params.sky = 1;
  return (int)brume_textures_create(g_match.fields[player], &params, &g_textures[player]);
}

void web_renew(void) {
  for (int player = 0; player < kPlayers; ++player) {
    brume_textures_destroy(g_textures[player]);
    g_textures[player] = NULL;
  }
}

int web_update(uint32_t player, double seconds, float light_fraction) {
  if (!g_textures[player]) TRY(make_textures(player));
  if (g_match.states[player]) TRY(brume_field_update(g_match.fields[player], g_match.states[player]));
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.seconds = seconds;
  frame.lights = g_smoke_lights;
  frame.light_update_fraction = light_fraction;
  TRY(brume_textures_update(g_textures[player], g_match.fields[player], &frame));
  TRY(brume_textures_list(g_textures[player], g_list, BRUME_TEXTURE_COUNT));
  TRY(brume_textures_regions(g_textures[player], &g_regions, &g_region_count));
  return (int)brume_textures_constants(g_textures[player], g_constants, BRUME_CONSTANTS);
}

float web_depth(uint32_t player, const float* a, const float* b) {
  const brume_segment line = {point_of(a), point_of(b)};
  float depth = -1;
  return brume_field_optical_depths(g_match.fields[player], &line, 1, &depth) == BRUME_OK ? depth : -1;
}

int32_t web_sees(uint32_t player, const float* a, const float* b, uint32_t drawn) {
  const brume_field* field = g_match.fields[player];
  const brume_segment line = {point_of(a), point_of(b)};
  const brume_drawn_params noise = look();
  uint8_t is_free = 0, visible = 0;
  if (brume_field_visible(field, &line, 1, INFINITY, &is_free) != BRUME_OK) return -1;
  if (!is_free) return 2;
  const brume_result result = drawn ? brume_field_drawn_visible(field, &noise, &line, 1, 3.0f, &visible)
                                    : brume_field_visible(field, &line, 1, 3.0f, &visible);
  return result == BRUME_OK ? visible : -1;
}
