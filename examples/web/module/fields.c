// What a player sees: the changed densities for a texture, the holes, and lines of sight.
#include <math.h>
#include <string.h>

#include "parts.h"

enum { kMostBricks = 4096, kBrick = 8, kBrickVoxels = 512, kMostHoles = 128 };

// A hole in what the shader reads: an axis, and how far it is open at the state's tick.
typedef struct web_hole {
  float origin[3], radius;
  float forward[3], depth;
  float age, stay, mask, pad;
} web_hole;

static brume_voxel g_bricks[kMostBricks];
static uint8_t g_densities[kMostBricks * kBrickVoxels];
static web_hole g_holes[kMostHoles];

const int32_t* web_bricks(void) { return &g_bricks[0].x; }
const uint8_t* web_densities(void) { return g_densities; }
const float* web_hole_numbers(void) { return g_holes[0].origin; }

static int32_t lesser(int32_t a, int32_t b) { return a < b ? a : b; }

// The densities of a brick, of which the level may have only a part.
static brume_result read_brick(const brume_field* field, brume_voxel brick, uint8_t* out) {
  const brume_voxel size = g_match.layout.size;
  const brume_voxel low = {brick.x * kBrick, brick.y * kBrick, brick.z * kBrick};
  const brume_voxel high = {lesser(low.x + kBrick, size.x), lesser(low.y + kBrick, size.y),
                            lesser(low.z + kBrick, size.z)};
  const int32_t nx = high.x - low.x, ny = high.y - low.y, nz = high.z - low.z;
  if (nx == kBrick && ny == kBrick && nz == kBrick)
    return brume_field_densities(field, low, high, out, kBrickVoxels);
  uint8_t part[kBrickVoxels];
  const brume_result result = brume_field_densities(field, low, high, part, (size_t)(nx * ny * nz));
  memset(out, 0, kBrickVoxels);
  for (int32_t z = 0; z < nz; ++z)
    for (int32_t y = 0; y < ny; ++y)
      memcpy(out + kBrick * (y + kBrick * z), part + nx * (y + ny * z), (size_t)nx);
  return result;
}

int32_t web_update(uint32_t player) {
  const brume_state* state = g_match.states[player];
  const brume_field* field = g_match.fields[player];
  if (!state) return 0;
  if (brume_field_update(g_match.fields[player], state) != BRUME_OK) return -1;
  size_t count = 0;
  if (brume_field_changed_bricks(field, g_bricks, kMostBricks, &count) != BRUME_OK) return -1;
  for (size_t i = 0; i < count; ++i)
    if (read_brick(field, g_bricks[i], g_densities + kBrickVoxels * i) != BRUME_OK) return -1;
  return (int32_t)count;
}

int32_t web_holes(uint32_t player) {
  static brume_hole holes[kMostHoles];
  size_t count = 0;
  brume_state_info info;
  if (!g_match.states[player]) return 0;
  if (brume_state_describe(g_match.states[player], &info) != BRUME_OK) return -1;
  if (brume_state_holes(g_match.states[player], holes, kMostHoles, &count) != BRUME_OK) return -1;
  for (size_t i = 0; i < count; ++i) {
    const brume_hole* from = &holes[i];
    web_hole* hole = &g_holes[i];
    const double x = from->toward.x - from->origin.x, y = from->toward.y - from->origin.y,
                 z = from->toward.z - from->origin.z, length = sqrt(x * x + y * y + z * z);
    hole->origin[0] = (float)from->origin.x / 1024;
    hole->origin[1] = (float)from->origin.y / 1024;
    hole->origin[2] = (float)from->origin.z / 1024;
    hole->forward[0] = (float)(x / length);
    hole->forward[1] = (float)(y / length);
    hole->forward[2] = (float)(z / length);
    hole->radius = (float)from->radius_1024 / 1024;
    hole->depth = (float)from->distance_1024 / 1024;
    hole->age = (float)(info.tick - from->tick) / kTicksPerSecond;
    hole->stay = from->shape == BRUME_HOLE_MASK ? 6.0f : 1.6f;
    hole->mask = from->shape == BRUME_HOLE_MASK ? (float)from->mask_index : -1.0f;
  }
  return (int32_t)count;
}

float web_depth(uint32_t player, const float* a, const float* b) {
  const brume_segment line = {point_of(a), point_of(b)};
  float depth = -1;
  return brume_field_optical_depths(g_match.fields[player], &line, 1, &depth) == BRUME_OK ? depth : -1;
}

int32_t web_sees(uint32_t player, const float* a, const float* b, uint32_t drawn) {
  const brume_field* field = g_match.fields[player];
  const brume_segment line = {point_of(a), point_of(b)};
  uint8_t free_of_walls = 0, visible = 0;
  if (brume_field_visible(field, &line, 1, INFINITY, &free_of_walls) != BRUME_OK) return -1;
  if (!free_of_walls) return 2;
  const brume_result result = drawn ? brume_field_drawn_visible(field, NULL, &line, 1, 3.0f, &visible)
                                    : brume_field_visible(field, &line, 1, 3.0f, &visible);
  return result == BRUME_OK ? visible : -1;
}
