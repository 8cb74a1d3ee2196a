// The match: the server's world, and a player who gets its states from packets over a line that loses some.
#include <math.h>
#include <string.h>

#include "parts.h"

enum { kFlying = 64, kLatencyTicks = 4, kHashes = 256, kAskEvery = 8, kMostPacket = 1 << 16 };

// What is on its way to the player.
typedef struct Packet {
  uint32_t due, size;
  uint8_t bytes[kMostPacket];
} Packet;

web_match g_match;
static brume_mask_image g_images[kMasks];
static uint32_t g_mask_count;
static brume_sender* g_sender;
static brume_receiver* g_receiver;
static Packet g_flying[kFlying];
static uint32_t g_first, g_count;  // of those in flight
static uint64_t g_hashes[kHashes];
static uint32_t g_random = 1;
static web_report g_report;

const char* web_error(void) {
  return brume_last_error();
}

const web_report* web_report_of(void) {
  return &g_report;
}

int web_add_mask(uint32_t width, uint32_t height, const uint8_t* texels) {
  if (g_mask_count == kMasks) return BRUME_ERROR_LIMIT;
  g_images[g_mask_count++] = (brume_mask_image){width, height, texels};
  return 0;
}

// A fresh line: its first packet is a whole state.
static int connect_players(void) {
  brume_sender_destroy(g_sender);
  g_sender = NULL;
  g_count = 0;
  brume_state_destroy(g_match.states[kThere]);
  g_match.states[kThere] = NULL;
  TRY(brume_sender_create(g_match.context, NULL, &g_sender));
  return (int)brume_receiver_reset(g_receiver);
}

int web_create(const float* points, uint32_t point_count, const uint32_t* indices, uint32_t index_count,
               const float* origin, float voxel_size, const int32_t* size) {
  brume_context_params context = brume_context_defaults();
  context.thread_count = 1;
  TRY(brume_context_create(&context, &g_match.context));
  brume_triangles_params mesh = brume_triangles_defaults();
  mesh.layout.size = (brume_voxel){size[0], size[1], size[2]};
  mesh.layout.voxel_size = voxel_size;
  mesh.layout.origin = point_of(origin);
  mesh.points = (const brume_point*)points;
  mesh.point_count = point_count;
  mesh.indices = indices;
  mesh.index_count = index_count;
  TRY(brume_level_create_from_triangles(g_match.context, &mesh, &g_match.level));
  TRY(brume_level_layout(g_match.level, &g_match.layout));
  TRY(brume_masks_create(g_match.context, g_images, g_mask_count, &g_match.masks));

  brume_world_params world = brume_world_defaults();
  world.masks = g_match.masks;
  TRY(brume_world_create(g_match.level, &world, &g_match.world));
  brume_field_params field = brume_field_defaults();
  field.extinction = kExtinction;
  field.masks = g_match.masks;
  for (int player = 0; player < kPlayers; ++player)
    TRY(brume_field_create(g_match.level, &field, &g_match.fields[player]));
  TRY(brume_receiver_create(g_match.context, NULL, &g_receiver));
  TRY(connect_players());
  return web_go_to(0, 0);
}

// ---- Events ----

static brume_event event_now(uint32_t kind) {
  uint32_t tick = 0;
  brume_world_tick(g_match.world, &tick);
  return brume_event_defaults(kind, tick + 1);
}

static brume_result position_of(const float* xyz, brume_position* position) {
  return brume_position_from_metres((double)xyz[0], (double)xyz[1], (double)xyz[2], position);
}

int web_throw(const float* from, const float* at, float cubic_metres, float bloom_seconds) {
  brume_event event = event_now(BRUME_EVENT_SMOKE);
  TRY(position_of(from, &event.u.smoke.from));
  TRY(position_of(at, &event.u.smoke.at));
  event.u.smoke.voxels = brume_smoke_voxels((double)cubic_metres, (double)g_match.layout.voxel_size);
  event.u.smoke.bloom_ticks = brume_rounded((double)bloom_seconds * kTicksPerSecond, 1, 6400);
  return (int)brume_world_append(g_match.world, &event, 1);
}

int web_shoot(const float* from, const float* toward, float radius, float stay_seconds, int32_t mask) {
  brume_event event = event_now(BRUME_EVENT_SHOT);
  TRY(position_of(from, &event.u.shot.origin));
  TRY(position_of(toward, &event.u.shot.toward));
  event.u.shot.radius_1024 = brume_length((double)radius);
  event.u.shot.stay_open_ms = brume_rounded((double)stay_seconds * 1000, 0, 60000);
  if (mask >= 0) {
    event.u.shot.shape = BRUME_HOLE_MASK;
    event.u.shot.mask_index = (uint32_t)mask;
    event.u.shot.fade_ms = 700;
  }
  return (int)brume_world_append(g_match.world, &event, 1);
}

int web_blast(const float* at, float radius) {
  brume_event event = event_now(BRUME_EVENT_BLAST);
  TRY(position_of(at, &event.u.blast.at));
  event.u.blast.radius_1024 = brume_length((double)radius);
  return (int)brume_world_append(g_match.world, &event, 1);
}

int web_edit(const int32_t* low, const int32_t* high, uint32_t solid) {
  brume_event event = event_now(BRUME_EVENT_EDIT);
  event.u.edit.low = (brume_voxel){low[0], low[1], low[2]};
  event.u.edit.high = (brume_voxel){high[0], high[1], high[2]};
  event.u.edit.solid = solid;
  return (int)brume_world_append(g_match.world, &event, 1);
}

int web_clear(void) {
  return (int)brume_world_replace_from(g_match.world, 0, NULL, 0);
}

// ---- The line between the players ----

static int is_lost(float loss) {
  g_random ^= g_random << 13;
  g_random ^= g_random >> 17;
  g_random ^= g_random << 5;
  return (float)(g_random >> 8) < loss * 16777216.0f;
}

// Writes what `write` gives into a packet that arrives a little later.
static int send(uint32_t tick, float loss, int is_answer, const uint8_t* request, size_t request_size) {
  if (g_count == kFlying) return 0;  // the line is full: as good as lost
  Packet* packet = &g_flying[(g_first + g_count) % kFlying];
  size_t size = 0;
  if (is_answer)
    TRY(brume_sender_answer(g_sender, request, request_size, packet->bytes, kMostPacket, &size));
  else
    TRY(brume_sender_packet(g_sender, packet->bytes, kMostPacket, &size));
  g_report.packets += 1;
  g_report.answers += is_answer ? 1 : 0;
  g_report.bytes += (uint32_t)size;
  if (is_lost(loss)) {
    g_report.lost += 1;
    return 0;
  }
  packet->due = tick + kLatencyTicks;
  packet->size = (uint32_t)size;
  g_count += 1;
  return 0;
}

// What is due arrives; a player who misses a state asks for it, and questions are lost as well.
static int receive(uint32_t tick, float loss) {
  int has_arrived = 0;
  for (; g_count > 0 && g_flying[g_first].due <= tick; g_first = (g_first + 1) % kFlying, --g_count) {
    TRY(brume_receiver_receive(g_receiver, g_flying[g_first].bytes, g_flying[g_first].size, NULL));
    has_arrived = 1;
  }
  uint32_t behind = 0;
  TRY(brume_receiver_behind(g_receiver, &behind));
  if (behind && tick % kAskEvery == 0 && !is_lost(loss)) {
    uint8_t request[16];
    size_t size = 0;
    TRY(brume_receiver_request(g_receiver, request, sizeof request, &size));
    TRY(send(tick, loss, 1, request, size));
  }
  if (!has_arrived) return 0;
  brume_state* state = NULL;
  if (brume_receiver_state(g_receiver, &state) != BRUME_OK) return 0;  // nothing whole has arrived yet
  brume_state_destroy(g_match.states[kThere]);
  g_match.states[kThere] = state;
  return 0;
}

static int report(void) {
  for (int player = 0; player < kPlayers; ++player) {
    const brume_state* state = g_match.states[player];
    brume_state_info info = {0};
    uint64_t hash = 0;
    if (state) {
      TRY(brume_state_describe(state, &info));
      TRY(brume_state_hash(state, &hash));
    }
    g_report.tick[player] = info.tick;
    g_report.hash_low[player] = (uint32_t)hash;
    g_report.hash_high[player] = (uint32_t)(hash >> 32);
    if (player == kThere) {
      const uint64_t server = state ? g_hashes[info.tick % kHashes] : 0;
      g_report.server_hash_low = (uint32_t)server;
      g_report.server_hash_high = (uint32_t)(server >> 32);
      continue;
    }
    g_report.clouds = info.cloud_count;
    g_report.holes = info.hole_count;
    g_report.blasts = info.blast_count;
    brume_grenade grenades[8];
    size_t count = 0;
    if (info.grenade_count <= 8) TRY(brume_state_grenades(state, grenades, 8, &count));
    for (size_t i = 0; i < count; ++i) memcpy(g_report.grenade[i], &grenades[i].position, sizeof(float[3]));
    g_report.grenades = (uint32_t)count;
  }
  return 0;
}

// The world's state at its tick, to the sender as well.
static int take_state(uint32_t tick) {
  TRY(brume_world_advance_to(g_match.world, tick));
  brume_state_destroy(g_match.states[kHere]);
  g_match.states[kHere] = NULL;
  TRY(brume_world_state(g_match.world, &g_match.states[kHere]));
  TRY(brume_state_hash(g_match.states[kHere], &g_hashes[tick % kHashes]));
  return (int)brume_sender_push(g_sender, g_match.states[kHere]);
}

// Both players begin from a tick: the first packet, a whole state, arrives whatever is lost.
static int begin_at(uint32_t tick) {
  TRY(connect_players());
  TRY(take_state(tick));
  Packet* packet = &g_flying[g_first];
  size_t size = 0;
  TRY(brume_sender_packet(g_sender, packet->bytes, kMostPacket, &size));
  TRY(brume_receiver_receive(g_receiver, packet->bytes, size, NULL));
  return (int)brume_receiver_state(g_receiver, &g_match.states[kThere]);
}

int web_go_to(uint32_t tick, float loss) {
  uint32_t now = 0;
  TRY(brume_world_tick(g_match.world, &now));
  if (tick <= now) {
    TRY(begin_at(tick));
    return report();
  }
  while (now < tick) {
    TRY(take_state(++now));
    TRY(send(now, loss, 0, NULL, 0));
    TRY(receive(now, loss));
  }
  return report();
}
