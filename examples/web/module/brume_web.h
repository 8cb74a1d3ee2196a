// What the page calls: flat functions with numbers and arrays over the C interface of the simulation. Each
// returns 0, or another number after which web_error() is the reason, unless it says otherwise. Lengths are
// metres.
#ifndef BRUME_WEB_H
#define BRUME_WEB_H

#include <stdint.h>

#include <emscripten.h>

#define WEB_API EMSCRIPTEN_KEEPALIVE

// The players: the server's own, and one who gets all from packets.
enum { kHere = 0, kThere = 1, kPlayers = 2 };

WEB_API const char* web_error(void);

// ---- The match (match.c) ----

/// Adds the image of a glyph, which a shot then cuts out by its number, from 0. Before web_create.
WEB_API int web_add_mask(uint32_t width, uint32_t height, const uint8_t* texels);
/// The level, from the triangles of a scene; `roles` may be null.
WEB_API int web_create(const float* points, uint32_t point_count, const uint32_t* indices,
                       uint32_t index_count, const float* origin, float voxel_size, const int32_t* size);
/// Events at the present tick. Points are three numbers.
WEB_API int web_throw(const float* from, const float* at, float cubic_metres, float bloom_seconds);
/// `mask` below 0: a round hole.
WEB_API int web_shoot(const float* from, const float* toward, float radius, float stay_seconds, int32_t mask);
WEB_API int web_blast(const float* at, float radius);
/// A box of voxels becomes a wall, or free.
WEB_API int web_edit(const int32_t* low, const int32_t* high, uint32_t solid);
/// Forgets all events.
WEB_API int web_clear(void);
/// Goes back, or forwards tick by tick with a packet for each, of which the fraction `loss` is lost.
WEB_API int web_go_to(uint32_t tick, float loss);

/// Numbers of the match, in this order.
typedef struct web_report {
  uint32_t tick[kPlayers];  // of the state that each has
  uint32_t hash_low[kPlayers], hash_high[kPlayers];
  uint32_t server_hash_low, server_hash_high;  // the server's, of the tick that the other has
  uint32_t packets, lost, answers, bytes;      // since the match began
  uint32_t clouds, holes, blasts, grenades;
  float grenade[8][3];
} web_report;
WEB_API const web_report* web_report_of(void);

// ---- What a player sees (fields.c) ----

/// A light of the smoke: its place, or the direction towards it. Before the first web_update.
WEB_API int web_add_texture_light(const float* at, uint32_t is_directional);
/// The device has lost its textures: the next updates hand out all of them again.
WEB_API void web_renew(void);
/// Takes over a player's state, drawn at a time, and makes the textures follow. Then: the list of textures,
/// five words each (brume_texture), the regions to upload, ten words each (brume_region), and the shader's
/// constants.
WEB_API int web_update(uint32_t player, double seconds, float light_fraction);
WEB_API const uint32_t* web_texture_list(void);
WEB_API const uint32_t* web_regions(void);
WEB_API uint32_t web_region_count(void);
WEB_API const float* web_constants(void);
/// The optical depth between two points, or -1.
WEB_API float web_depth(uint32_t player, const float* a, const float* b);
/// Whether two points see each other: 1 yes, 0 hidden by smoke, 2 by a wall, -1 an error. `drawn`: through
/// the smoke as it is drawn, with its noise.
WEB_API int32_t web_sees(uint32_t player, const float* a, const float* b, uint32_t drawn);

// ---- Light that is left at surfaces (light.c) ----

/// A light of the level: position, colour times intensity [W/sr], direction, cosines of the inner and outer
/// angle; the cosines are -2 for light in all directions.
WEB_API int web_add_light(const float* position, const float* color, const float* direction, float inner,
                          float outer);
/// Goes on through the cells: at most some `lines` lines of sight. Returns how many cells it did, or -1.
WEB_API int32_t web_light(uint32_t player, uint32_t lines);
/// A wall has changed: which lights reach a cell is found again.
WEB_API void web_light_restart(void);
/// Cells along each axis, and their texels: what smoke leaves of the light, for red, green and blue.
WEB_API const int32_t* web_light_size(void);
WEB_API const uint8_t* web_light_texels(uint32_t player);

#endif
