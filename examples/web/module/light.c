// What smoke leaves of the light that reaches cells of two voxels per axis: lines of sight to each light,
// some in each frame. With it, surfaces behind smoke get darker.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"

enum { kLights = 12, kBatch = 256 };

// Irradiance of the sky, which smoke scatters more than it absorbs [W/m^2].
static const float kAmbient[3] = {0.027f, 0.036f, 0.055f};

typedef struct Light {
  brume_point position, direction;
  float color[3], inner, outer;
} Light;

// A pair of a cell and a light that may reach it.
typedef struct Pair {
  uint32_t cell;
  uint16_t light;
  uint8_t open;  // whether no wall is between them: 255 unknown
  float weight;  // intensity there [W/m^2], without smoke
} Pair;

static Light g_lights[kLights];
static uint32_t g_light_count;
static int32_t g_size[3];
static uint32_t g_cell_count, g_pair_count;
static Pair* g_pairs;              // by cell
static uint32_t* g_pairs_of_cell;  // where each cell's begin, and one more
static float* g_clear[kPlayers];   // of each pair, the optical depth between its ends
static uint8_t* g_texels[kPlayers];
static uint32_t g_next[kPlayers];  // cell

const int32_t* web_light_size(void) {
  return g_size;
}
const uint8_t* web_light_texels(uint32_t player) {
  return g_texels[player];
}

int web_add_light(const float* position, const float* color, const float* direction, float inner,
                  float outer) {
  if (g_light_count == kLights) return BRUME_ERROR_LIMIT;
  Light* light = &g_lights[g_light_count++];
  light->position = point_of(position);
  light->direction = point_of(direction);
  memcpy(light->color, color, sizeof light->color);
  light->inner = inner;
  light->outer = outer;
  return 0;
}

static brume_point middle_of(uint32_t cell) {
  const uint32_t nx = (uint32_t)g_size[0], ny = (uint32_t)g_size[1];
  const float edge = 2 * g_match.layout.voxel_size;
  const brume_point low = g_match.layout.origin;
  return (brume_point){low.x + edge * ((float)(cell % nx) + 0.5f),
                       low.y + edge * ((float)(cell / nx % ny) + 0.5f),
                       low.z + edge * ((float)(cell / nx / ny) + 0.5f)};
}

// Irradiance of a light at a point [W/m^2], without walls and smoke.
static float weight_of(const Light* light, brume_point at) {
  const float x = at.x - light->position.x, y = at.y - light->position.y, z = at.z - light->position.z;
  const float square = fmaxf(x * x + y * y + z * z, 0.05f);
  float weight = 1 / square;
  if (light->outer > -1.5f) {
    const float cosine =
        (x * light->direction.x + y * light->direction.y + z * light->direction.z) / sqrtf(square);
    const float t = fminf(fmaxf((cosine - light->outer) / (light->inner - light->outer), 0), 1);
    weight *= t * t * (3 - 2 * t);
  }
  return weight;
}

static float brightest(const float* color) {
  return fmaxf(color[0], fmaxf(color[1], color[2]));
}

// The pairs that matter: those whose light is not dim there.
static int make_pairs(void) {
  const brume_voxel size = g_match.layout.size;
  g_size[0] = (size.x + 1) / 2;
  g_size[1] = (size.y + 1) / 2;
  g_size[2] = (size.z + 1) / 2;
  g_cell_count = (uint32_t)(g_size[0] * g_size[1] * g_size[2]);
  g_pairs_of_cell = calloc(g_cell_count + 1, sizeof *g_pairs_of_cell);
  g_pairs = malloc((size_t)g_cell_count * g_light_count * sizeof *g_pairs);
  if (!g_pairs_of_cell || !g_pairs) return BRUME_ERROR_MEMORY;
  for (uint32_t cell = 0; cell < g_cell_count; ++cell) {
    g_pairs_of_cell[cell] = g_pair_count;
    const brume_point at = middle_of(cell);
    for (uint32_t light = 0; light < g_light_count; ++light) {
      const float weight = weight_of(&g_lights[light], at);
      if (weight * brightest(g_lights[light].color) < 0.04f) continue;
      g_pairs[g_pair_count++] = (Pair){cell, (uint16_t)light, 255, weight};
    }
  }
  g_pairs_of_cell[g_cell_count] = g_pair_count;
  for (int player = 0; player < kPlayers; ++player) {
    g_clear[player] = malloc(g_pair_count * sizeof(float));
    g_texels[player] = malloc((size_t)g_cell_count * 4);
    if (!g_clear[player] || !g_texels[player]) return BRUME_ERROR_MEMORY;
    memset(g_texels[player], 255, (size_t)g_cell_count * 4);
  }
  return 0;
}

void web_light_restart(void) {
  for (uint32_t i = 0; i < g_pair_count; ++i) g_pairs[i].open = 255;
}

// What reaches a surface through smoke of an optical depth: straight, and scattered many times. The latter is
// what brume_scattered of shaders/export/smoke.glsl has for this smoke, from half of all directions.
static float left_behind(float depth) {
  return fminf(expf(-depth) + 0.21f * expf(-0.33f * depth) * (1 - expf(-depth)), 1);
}

static void write_cell(uint32_t player, uint32_t cell) {
  float all[3], left[3];
  memcpy(all, kAmbient, sizeof all);
  memcpy(left, kAmbient, sizeof left);
  for (uint32_t i = g_pairs_of_cell[cell]; i < g_pairs_of_cell[cell + 1]; ++i) {
    const Pair* pair = &g_pairs[i];
    if (pair->open != 1) continue;
    for (int c = 0; c < 3; ++c) {
      const float arriving = pair->weight * g_lights[pair->light].color[c];
      all[c] += arriving;
      left[c] += arriving * left_behind(g_clear[player][i]);
    }
  }
  uint8_t* texel = g_texels[player] + 4 * (size_t)cell;
  for (int c = 0; c < 3; ++c) texel[c] = (uint8_t)(255 * left[c] / all[c]);
}

// Lines of some cells to their lights.
static int light_cells(uint32_t player, uint32_t first, uint32_t end) {
  static brume_segment lines[kBatch];
  static uint8_t open[kBatch];
  static float depths[kBatch];
  const brume_field* field = g_match.fields[player];
  for (uint32_t cell = first; cell < end; ++cell) {
    const uint32_t from = g_pairs_of_cell[cell], count = g_pairs_of_cell[cell + 1] - from;
    const brume_point at = middle_of(cell);
    for (uint32_t i = 0; i < count; ++i)
      lines[i] = (brume_segment){g_lights[g_pairs[from + i].light].position, at};
    if (count == 0) continue;
    if (g_pairs[from].open == 255) {
      TRY(brume_field_visible(field, lines, count, INFINITY, open));
      for (uint32_t i = 0; i < count; ++i) g_pairs[from + i].open = open[i];
    }
    TRY(brume_field_optical_depths(field, lines, count, depths));
    memcpy(g_clear[player] + from, depths, count * sizeof(float));
    write_cell(player, cell);
  }
  return 0;
}

int32_t web_light(uint32_t player, uint32_t lines) {
  if (!g_pairs && make_pairs() != 0) return -1;
  const uint32_t first = g_next[player];
  uint32_t end = first, work = 0;
  while (end < g_cell_count && work < lines)
    work += g_pairs_of_cell[end + 1] - g_pairs_of_cell[end] + 1, ++end;
  if (light_cells(player, first, end) != 0) return -1;
  g_next[player] = end == g_cell_count ? 0 : end;
  return (int32_t)(end - first);
}
