// A match on a server: a minimal program on libbrume-sim, in C, without Vulkan, window or scene files.
//
//   brume_server [--seconds N] [--realtime]
//
// Twelve bots run around in two rooms with a door in between, throw smokes and shoot through them. Each
// second it prints the tick, the number of pairs that see each other, and the state hash: the same on every
// machine.
#define _POSIX_C_SOURCE 200809L
#include <brume/brume.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { kBots = 12, kPairs = kBots * (kBots - 1) / 2, kTicksPerSecond = 64 };
enum { kSizeX = 65, kSizeY = 10, kSizeZ = 32 };
static const float kVoxel = 0.5f;  // m

// Ends the program when a call fails, and prints the reason.
static void check(brume_result result) {
  if (result == BRUME_OK) return;
  fprintf(stderr, "brume_server: %s\n", brume_last_error());
  exit(1);
}

// Two rooms of 16 x 5 x 16 m with half-metre voxels, and a door between them.
static brume_level* make_level(brume_context* context) {
  static uint8_t bits[(kSizeX * kSizeY * kSizeZ + 7) / 8];
  for (int z = 0; z < kSizeZ; ++z)
    for (int y = 0; y < kSizeY; ++y) {
      const int i = 32 + kSizeX * (y + kSizeY * z);
      if (z < 14 || z > 17 || y > 4) bits[i / 8] |= (uint8_t)(1u << i % 8);
    }
  brume_voxels_params params = brume_voxels_defaults();
  params.layout.size = (brume_voxel){kSizeX, kSizeY, kSizeZ};
  params.layout.voxel_size = kVoxel;
  params.bits = bits;
  params.byte_count = sizeof bits;
  brume_level* level = NULL;
  check(brume_level_create_from_voxels(context, &params, &level));
  return level;
}

// A bot's feet [1/1024 m]: it walks along its own lane to the other room and back.
static brume_position bot_at(uint32_t bot, uint32_t tick) {
  const uint32_t walked = (tick * 48 + bot * 6000) % 60000;
  const int32_t along = (int32_t)(walked < 30000 ? walked : 60000 - walked);
  return (brume_position){1024 + along, 0, 1024 + (int32_t)bot * 1200};
}

// A bot's eyes, 1.6 m above its feet.
static brume_position eyes_of(uint32_t bot, uint32_t tick) {
  brume_position position = bot_at(bot, tick);
  position.y += (int32_t)brume_length(1.6);
  return position;
}

// The input of a tick, with positions in 1/1024 m; in a real match it comes from the network.
static void take_input(brume_world* world, uint32_t tick) {
  brume_event events[5];
  size_t count = 0;
  const uint32_t bot = tick / 16 % kBots;
  const brume_position eyes = eyes_of(bot, tick);

  brume_event* event = &events[count++];
  *event = brume_event_defaults(BRUME_EVENT_MOVE, tick);
  event->u.move.body = bot;
  event->u.move.to = bot_at(bot, tick);
  if (tick % 192 == 0) {
    event = &events[count++];
    *event = brume_event_defaults(BRUME_EVENT_SMOKE, tick);
    event->u.smoke.from = eyes;
    event->u.smoke.at = (brume_position){16000, 512, 15872};
    event->u.smoke.voxels = brume_smoke_voxels(225, kVoxel);  // m^3
  }
  if (tick % 40 == 0) {
    event = &events[count++];
    *event = brume_event_defaults(BRUME_EVENT_SHOT, tick);
    event->u.shot.origin = eyes;
    event->u.shot.toward = (brume_position){16000, 1600, 15872};
  }
  if (tick % 640 == 500) {
    event = &events[count++];
    *event = brume_event_defaults(BRUME_EVENT_BLAST, tick);
    event->u.blast.at = (brume_position){14000, 1024, 15872};
  }
  if (tick % 320 == 0) {  // The door opens or closes.
    event = &events[count++];
    *event = brume_event_defaults(BRUME_EVENT_EDIT, tick);
    event->u.edit.low = (brume_voxel){32, 0, 14};
    event->u.edit.high = (brume_voxel){33, 5, 18};
    event->u.edit.solid = tick % 640 == 320;
  }
  check(brume_world_append(world, events, count));
}

static brume_point metres(brume_position position) {
  return (brume_point){(float)position.x / 1024, (float)position.y / 1024, (float)position.z / 1024};
}

// The number of pairs of bots that see each other past the current walls and smoke.
static int count_visible_pairs(const brume_field* field, uint32_t tick) {
  brume_segment pairs[kPairs];
  int count = 0;
  for (uint32_t a = 0; a < kBots; ++a)
    for (uint32_t b = a + 1; b < kBots; ++b)
      pairs[count++] = (brume_segment){metres(eyes_of(a, tick)), metres(eyes_of(b, tick))};
  uint8_t visible[kPairs];
  check(brume_field_visible(field, pairs, kPairs, 3, visible));
  int sum = 0;
  for (int i = 0; i < kPairs; ++i) sum += visible[i];
  return sum;
}

static void print_tick(const brume_state* state, int visible) {
  brume_state_info info;
  uint64_t hash = 0;
  check(brume_state_describe(state, &info));
  check(brume_state_hash(state, &hash));
  printf("tick %" PRIu32 ": %" PRIu32 " smokes, %" PRIu32
         " holes, %d pairs of bots see each other, state %016" PRIx64 "\n",
         info.tick, info.cloud_count, info.hole_count, visible, hash);
}

static void sleep_until(struct timespec start, uint32_t tick) {
  const uint64_t nanoseconds = (uint64_t)start.tv_nsec + UINT64_C(1000000000) / kTicksPerSecond * tick;
  const struct timespec at = {start.tv_sec + (time_t)(nanoseconds / 1000000000),
                              (long)(nanoseconds % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) == EINTR) {
  }
}

static void run_match(uint32_t seconds, int realtime) {
  brume_context* context = NULL;
  brume_world* world = NULL;
  brume_field* field = NULL;
  check(brume_context_create(NULL, &context));
  brume_level* level = make_level(context);
  check(brume_world_create(level, NULL, &world));
  check(brume_field_create(level, NULL, &field));

  struct timespec start;
  clock_gettime(CLOCK_MONOTONIC, &start);
  for (uint32_t tick = 0; tick <= seconds * kTicksPerSecond; ++tick) {
    if (realtime) sleep_until(start, tick);
    take_input(world, tick);
    check(brume_world_advance_to(world, tick));
    if (tick > kTicksPerSecond)  // Accept input that is up to one second late.
      check(brume_world_forget_before(world, tick - kTicksPerSecond));
    brume_state* state = NULL;
    check(brume_world_state(world, &state));
    check(brume_field_update(field, state));
    const int visible = count_visible_pairs(field, tick);
    if (tick % kTicksPerSecond == 0) print_tick(state, visible);
    check(brume_state_destroy(state));
  }

  check(brume_field_destroy(field));
  check(brume_world_destroy(world));
  check(brume_level_destroy(level));
  check(brume_context_destroy(context));
}

int main(int count, char** arguments) {
  long seconds = 30;
  int realtime = 0;
  for (int i = 1; i < count; ++i) {
    if (strcmp(arguments[i], "--realtime") == 0) {
      realtime = 1;
    } else if (strcmp(arguments[i], "--seconds") == 0 && i + 1 < count) {
      seconds = strtol(arguments[++i], NULL, 10);
      seconds = seconds < 1 ? 1 : seconds > 86400 ? 86400 : seconds;
    } else {
      fprintf(stderr, "usage: brume_server [--seconds N] [--realtime]\n");
      return 2;
    }
  }
  run_match((uint32_t)seconds, realtime);
  return 0;
}
