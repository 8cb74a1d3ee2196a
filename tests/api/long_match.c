/* A match of 6,000 ticks for programs in other languages, and what it gives in C. Prints one item a line:
 *
 *   point X Y Z, triangle A B C             the collision mesh [m]
 *   event KIND TICK NUMBERS...              the members of the event's struct, in their order
 *   line AX AY AZ BX BY BZ                  lines of sight [m]
 *   play TICKS EVERY                        the end of the input: results follow, every so many ticks
 *   hash TICK HASH                          brume_world_hash
 *   depths TICK BITS...                     the optical depth of each line, the bits of a float
 *   visible TICK 0110...                    whether the ends of each line see each other, at threshold 3
 *
 * Coordinates are multiples of 1/8 m: exact in any language. Events are appended at their tick. */
#include <brume/brume.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kBoxes = 9, kLines = 48, kTicks = 6000, kEvery = 120 };

static void check(brume_result result) {
  if (result == BRUME_OK) return;
  fprintf(stderr, "long_match: %s\n", brume_last_error());
  exit(1);
}

/* The generator of Park and Miller: in [0, n). */
static uint32_t below(uint32_t n) {
  static uint64_t state = 20;
  state = state * 48271 % 2147483647;
  return (uint32_t)(state % n);
}

/* A hall of 24 x 6 x 20 m with two rooms, a beam and a crate: low and high corners in 1/8 m. */
static const float kHall[kBoxes][6] = {
    {0, -4, 0, 192, 0, 160},   {0, 48, 0, 192, 52, 160},  {-4, 0, 0, 0, 48, 160},
    {192, 0, 0, 196, 48, 160}, {0, 0, -4, 192, 48, 0},    {0, 0, 160, 192, 48, 164},
    {92, 0, 0, 100, 48, 68},   {92, 0, 92, 100, 48, 160}, {40, 0, 70, 58, 13, 90},
};

static brume_level* make_level(brume_context* context) {
  static const uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  static brume_point points[kBoxes * 8];
  static uint32_t indices[kBoxes * 36];
  for (uint32_t box = 0; box < kBoxes; ++box) {
    const float* b = kHall[box];
    for (uint32_t i = 0; i < 8; ++i) {
      const brume_point point = {b[i & 1 ? 3 : 0] / 8, b[i & 2 ? 4 : 1] / 8, b[i & 4 ? 5 : 2] / 8};
      points[box * 8 + i] = point;
      printf("point %g %g %g\n", point.x, point.y, point.z);
    }
    for (uint32_t i = 0; i < 36; ++i) indices[box * 36 + i] = box * 8 + faces[i];
  }
  for (uint32_t i = 0; i < kBoxes * 36; i += 3)
    printf("triangle %" PRIu32 " %" PRIu32 " %" PRIu32 "\n", indices[i], indices[i + 1], indices[i + 2]);
  brume_triangles_params mesh = brume_triangles_defaults();
  mesh.points = points;
  mesh.point_count = kBoxes * 8;
  mesh.indices = indices;
  mesh.index_count = kBoxes * 36;
  brume_level* level;
  check(brume_level_create_from_triangles(context, &mesh, &level));
  return level;
}

/* A place in the hall, 1/1024 m. */
static brume_position place(void) {
  brume_position position;
  position.x = (int32_t)(1024 + below(22 * 1024));
  position.y = (int32_t)(512 + below(4 * 1024));
  position.z = (int32_t)(1024 + below(18 * 1024));
  return position;
}

static brume_event shot(uint32_t tick) {
  brume_event event = brume_event_defaults(BRUME_EVENT_SHOT, tick);
  event.u.shot.origin = place();
  event.u.shot.toward = place();
  event.u.shot.stay_open_ms = 500 + below(3000);
  event.u.shot.shape = below(4) == 0 ? BRUME_HOLE_BOX : BRUME_HOLE_CYLINDER;
  event.u.shot.roll_65536 = below(65536);
  return event;
}

/* What happens at a tick: at most one event. */
static uint32_t event_at(uint32_t tick, brume_event* event) {
  if (tick % 400 == 30) {
    *event = brume_event_defaults(BRUME_EVENT_SMOKE, tick);
    event->u.smoke.from = place();
    event->u.smoke.at = place();
    event->u.smoke.voxels = 600 + below(1200);
  } else if (tick % 700 == 200) {
    *event = brume_event_defaults(BRUME_EVENT_BLAST, tick);
    event->u.blast.at = place();
  } else if (tick % 900 == 500) {
    /* A door between the rooms, shut and opened. */
    *event = brume_event_defaults(BRUME_EVENT_EDIT, tick);
    const brume_edit_event door = {{26, 3, 20}, {28, 8, 26}, tick / 900 % 2 == 0};
    event->u.edit = door;
  } else if (tick % 20 == 7) {
    *event = shot(tick);
  } else if (tick % 20 == 13) {
    *event = brume_event_defaults(BRUME_EVENT_MOVE, tick);
    event->u.move.body = below(3);
    event->u.move.to = place();
  } else {
    return 0;
  }
  return 1;
}

static void print_event(const brume_event* event) {
  static const uint32_t sizes[] = {0,
                                   sizeof(brume_smoke_event),
                                   sizeof(brume_shot_event),
                                   sizeof(brume_blast_event),
                                   sizeof(brume_move_event),
                                   sizeof(brume_edit_event)};
  printf("event %" PRIu32 " %" PRIu32, event->kind, event->tick);
  for (uint32_t i = 0; i < sizes[event->kind] / 4; ++i) {
    int32_t number;
    memcpy(&number, &event->u.reserved[i], sizeof number);
    printf(" %" PRId32, number);
  }
  printf("\n");
}

static brume_point seen_point(void) {
  const brume_point point = {(float)below(192) / 8, 0.5f + (float)below(32) / 8, (float)below(160) / 8};
  return point;
}

static void print_results(const brume_world* world, brume_field* field, const brume_segment* lines,
                          uint32_t tick) {
  uint64_t hash;
  brume_state* state;
  float depths[kLines];
  uint8_t visible[kLines];
  check(brume_world_hash(world, &hash));
  check(brume_world_state(world, &state));
  check(brume_field_update(field, state));
  check(brume_state_destroy(state));
  check(brume_field_optical_depths(field, lines, kLines, depths));
  check(brume_field_visible(field, lines, kLines, 3.0f, visible));
  printf("hash %" PRIu32 " %016" PRIx64 "\ndepths %" PRIu32, tick, hash, tick);
  for (uint32_t i = 0; i < kLines; ++i) {
    uint32_t bits;
    memcpy(&bits, &depths[i], sizeof bits);
    printf(" %08" PRIx32, bits);
  }
  printf("\nvisible %" PRIu32 " ", tick);
  for (uint32_t i = 0; i < kLines; ++i) putchar('0' + visible[i]);
  putchar('\n');
}

int main(void) {
  static brume_event events[kTicks + 1];
  brume_segment lines[kLines];
  brume_context* context;
  brume_world* world;
  brume_field* field;
  check(brume_context_create(NULL, &context));
  brume_level* level = make_level(context);
  check(brume_world_create(level, NULL, &world));
  check(brume_field_create(level, NULL, &field));
  uint32_t count = 0;
  for (uint32_t tick = 0; tick < kTicks; ++tick)
    if (event_at(tick, &events[count])) print_event(&events[count++]);
  for (uint32_t i = 0; i < kLines; ++i) {
    lines[i].a = seen_point();
    lines[i].b = seen_point();
    printf("line %g %g %g %g %g %g\n", lines[i].a.x, lines[i].a.y, lines[i].a.z, lines[i].b.x, lines[i].b.y,
           lines[i].b.z);
  }
  printf("play %d %d\n", kTicks, kEvery);
  for (uint32_t tick = 0, next = 0; tick <= kTicks; ++tick) {
    for (; next < count && events[next].tick == tick; ++next)
      check(brume_world_append(world, &events[next], 1));
    check(brume_world_advance_to(world, tick));
    if (tick % kEvery == 0) print_results(world, field, lines, tick);
    check(brume_world_forget_before(world, tick));
  }
  check(brume_field_destroy(field));
  check(brume_world_destroy(world));
  check(brume_level_destroy(level));
  check(brume_context_destroy(context));
  return 0;
}
