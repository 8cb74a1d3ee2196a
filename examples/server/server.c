// A match on a server: a minimal program on libbrume-sim, in C, without Vulkan, window or scene files.
//
//   brume_server [--seconds N]
//
// A sniper aims through a doorway, between two rooms in which twelve bots run around. Each second the program
// prints what the sniper sees and the state hash, the same on every machine (docs/start/your-server.md).
#include <brume/brume.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kBots = 12, kPairs = kBots * (kBots - 1) / 2, kTicksPerSecond = 64 };
static const float kVoxel = 0.5f;                                 // m
static const float kThreshold = 3.0f;                             // optical depth: 5 % of the light passes
static const brume_segment kAim = {{2, 1.6f, 8}, {30, 1.6f, 8}};  // from the sniper to the target [m]

// Ends the program when a call fails, and prints the reason.
static void check(brume_result result) {
  if (result == BRUME_OK) return;
  fprintf(stderr, "brume_server: %s\n", brume_last_error());
  exit(1);
}

// Two rooms of 16 x 5 x 16 m, and a wall with a doorway between them: three rectangles of the collision mesh.
static brume_level* make_level(brume_context* context) {
  static const float x = 16.25f;
  const brume_point points[] = {
      {x, 0, 0},         {x, 5, 0},     {x, 5, 6.75f}, {x, 0, 6.75f},       // left of the doorway
      {x, 0, 9.25f},     {x, 5, 9.25f}, {x, 5, 16},    {x, 0, 16},          // right of it
      {x, 2.75f, 6.75f}, {x, 5, 6.75f}, {x, 5, 9.25f}, {x, 2.75f, 9.25f}};  // above it
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10, 8, 10, 11};
  brume_triangles_params mesh = brume_triangles_defaults();
  mesh.layout.size = (brume_voxel){65, 10, 32};  // a box that smoke does not leave
  mesh.layout.voxel_size = kVoxel;
  mesh.points = points;
  mesh.point_count = sizeof points / sizeof points[0];
  mesh.indices = indices;
  mesh.index_count = sizeof indices / sizeof indices[0];
  brume_level* level = NULL;
  check(brume_level_create_from_triangles(context, &mesh, &level));
  return level;
}

static brume_position position(brume_point metres) {
  brume_position position;
  check(brume_position_from_metres(metres.x, metres.y, metres.z, &position));
  return position;
}

// The input of a tick, every ten seconds the same; in a real match from the network and the game's physics.
static void take_input(brume_world* world, uint32_t tick) {
  const uint32_t now = tick % 640;
  if (now == 60) {  // The game's physics has flown a grenade, which detonates now.
    brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, tick);
    event.u.smoke.at = position((brume_point){14, 0.25f, 8});
    event.u.smoke.from = event.u.smoke.at;
    event.u.smoke.voxels = brume_smoke_voxels(200, kVoxel);  // m^3
    check(brume_world_append(world, &event, 1));
  }
  if (now == 186) {  // The sniper's shot arrives a quarter of a second late: it was fired at tick 170.
    brume_event event = brume_event_defaults(BRUME_EVENT_SHOT, tick - 16);
    event.u.shot.origin = position(kAim.a);
    event.u.shot.toward = position(kAim.b);
    check(brume_world_append(world, &event, 1));
  }
  if (now == 320 || now == 384) {  // The door closes, then opens.
    brume_event event = brume_event_defaults(BRUME_EVENT_EDIT, tick);
    event.u.edit.low = (brume_voxel){32, 0, 14};
    event.u.edit.high = (brume_voxel){33, 5, 18};
    event.u.edit.solid = now == 320;
    check(brume_world_append(world, &event, 1));
  }
  if (now == 500) {
    brume_event event = brume_event_defaults(BRUME_EVENT_BLAST, tick);
    event.u.blast.at = position((brume_point){14, 1, 8});
    check(brume_world_append(world, &event, 1));
  }
}

// A bot's eyes [m]: it walks along its own lane to the other room and back.
static brume_point eyes_of(uint32_t bot, uint32_t tick) {
  const uint32_t walked = (tick * 48 + bot * 6000) % 60000;
  const uint32_t along = walked < 30000 ? walked : 60000 - walked;
  return (brume_point){1 + (float)along / 1024, 1.6f, 1 + (float)bot * 1.25f};
}

// The number of pairs of bots that see each other past the current walls and smoke.
static int count_visible_pairs(const brume_field* field, uint32_t tick) {
  brume_segment pairs[kPairs];
  int count = 0;
  for (uint32_t a = 0; a < kBots; ++a)
    for (uint32_t b = a + 1; b < kBots; ++b)
      pairs[count++] = (brume_segment){eyes_of(a, tick), eyes_of(b, tick)};
  uint8_t visible[kPairs];
  check(brume_field_visible(field, pairs, kPairs, kThreshold, visible));
  int sum = 0;
  while (count > 0) sum += visible[--count];
  return sum;
}

// Sends a state to a client, which in a real match is another machine. Returns the size of the packet.
static size_t send_state(brume_sender* sender, brume_receiver* client, const brume_state* state,
                         int is_lost) {
  static uint8_t packet[65536], request[16];
  size_t size = 0, request_size = 0, answer_size = 0;
  uint32_t behind = 0;
  check(brume_sender_push(sender, state));
  check(brume_sender_packet(sender, packet, sizeof packet, &size));
  if (is_lost) return size;
  check(brume_receiver_receive(client, packet, size, NULL));
  check(brume_receiver_behind(client, &behind));
  if (behind) {
    check(brume_receiver_request(client, request, sizeof request, &request_size));
    check(brume_sender_answer(sender, request, request_size, packet, sizeof packet, &answer_size));
    check(brume_receiver_receive(client, packet, answer_size, NULL));
  }
  return size;
}

static void print_tick(const brume_state* state, const brume_receiver* client, const brume_field* field,
                       size_t packet_size) {
  brume_state_info info;
  uint64_t hash = 0, client_hash = 0;
  check(brume_state_describe(state, &info));
  check(brume_state_hash(state, &hash));
  brume_state* received = NULL;
  check(brume_receiver_state(client, &received));
  check(brume_state_hash(received, &client_hash));
  check(brume_state_destroy(received));

  uint8_t visible = 0;
  float depth = 0;
  brume_wall wall;
  check(brume_field_visible(field, &kAim, 1, kThreshold, &visible));
  check(brume_field_optical_depths(field, &kAim, 1, &depth));
  check(brume_field_first_walls(field, &kAim, 1, &wall));
  printf("%4u  %6u  %5u  ", info.tick, info.cloud_count, info.hole_count);
  printf("%-6s  %5.1f  ", visible ? "target" : wall.hit ? "wall" : "smoke", (double)depth);
  printf("%2d/%d  %6zu  ", count_visible_pairs(field, info.tick), kPairs, packet_size);
  printf("%016" PRIx64 "%s\n", hash, hash == client_hash ? "" : "  client differs");
}

static void run_match(uint32_t seconds) {
  brume_context* context = NULL;
  brume_world* world = NULL;
  brume_field* field = NULL;
  brume_sender* sender = NULL;
  brume_receiver* client = NULL;
  check(brume_context_create(NULL, &context));
  brume_level* level = make_level(context);
  check(brume_world_create(level, NULL, &world));
  check(brume_field_create(level, NULL, &field));
  check(brume_sender_create(context, NULL, &sender));
  check(brume_receiver_create(context, NULL, &client));

  printf("tick  smokes  holes  sniper  depth  pairs  packet  state\n");
  for (uint32_t tick = 0; tick <= seconds * kTicksPerSecond; ++tick) {
    take_input(world, tick);
    check(brume_world_advance_to(world, tick));
    if (tick > kTicksPerSecond)  // Accept input that is up to one second late.
      check(brume_world_forget_before(world, tick - kTicksPerSecond));
    brume_state* state = NULL;
    check(brume_world_state(world, &state));
    check(brume_field_update(field, state));
    const size_t size = send_state(sender, client, state, tick % 64 == 10);  // one in 64 is lost
    if (tick % kTicksPerSecond == 0) print_tick(state, client, field, size);
    check(brume_state_destroy(state));
  }

  check(brume_receiver_destroy(client));
  check(brume_sender_destroy(sender));
  check(brume_field_destroy(field));
  check(brume_world_destroy(world));
  check(brume_level_destroy(level));
  check(brume_context_destroy(context));
}

int main(int count, char** arguments) {
  long seconds = 30;
  if (count == 3 && strcmp(arguments[1], "--seconds") == 0) {
    seconds = strtol(arguments[2], NULL, 10);
    seconds = seconds < 1 ? 1 : seconds > 86400 ? 86400 : seconds;
  } else if (count != 1) {
    fprintf(stderr, "usage: brume_server [--seconds N]\n");
    return 2;
  }
  run_match((uint32_t)seconds);
  return 0;
}
