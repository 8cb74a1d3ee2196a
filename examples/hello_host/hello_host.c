// The smallest host of Brume's renderer: a smoke grenade floods a room, and the smoke comes out of its
// doorway. It draws off screen and writes a PNG. offscreen.h is the program without Brume. Guide:
// docs/start/your-renderer.md.
//
//   hello_host [hello.png]
#include <brume/brume_vulkan.h>

#include "offscreen.h"

enum { kFrames = 6, kTicksPerFrame = 40, kTicksPerSecond = 64 };
static const float kVoxel = 0.25f;  // m

// Ends the program when a call of Brume fails, and prints the reason.
static void check(brume_result result) {
  if (result == BRUME_OK) return;
  fprintf(stderr, "hello_host: %s\n", brume_last_error());
  exit(1);
}

// The room and the yard as voxels of 25 cm: 8 m x 3.5 m x 14 m, the low corner at (-4, -0.25, -6). A game
// creates its level from its collision mesh instead: brume_level_create_from_triangles.
static brume_level* make_level(brume_context* context) {
  enum { kX = 32, kY = 14, kZ = 56 };
  static uint8_t bits[kX * kY * kZ / 8];
  for (int i = 0; i < kX * kY * kZ; ++i) {
    const int x = i % kX, y = i / kX % kY, z = i / (kX * kY);
    const int doorway = x >= 14 && x < 18 && y < 10;
    const int wall = x < 4 || x >= 28 || y == kY - 1 || z == 0 || (z == 23 && !doorway);
    if (y == 0 || (z < 24 && wall)) bits[i / 8] |= (uint8_t)(1 << i % 8);
  }
  brume_voxels_params params = brume_voxels_defaults();
  params.layout = (brume_layout){{kX, kY, kZ}, kVoxel, {-4, -0.25f, -6}};
  params.bits = bits;
  params.byte_count = sizeof bits;
  brume_level* level = NULL;
  check(brume_level_create_from_voxels(context, &params, &level));
  return level;
}

// A player in the yard throws a grenade through the doorway into the middle of the room.
static void throw_grenade(brume_world* world) {
  brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, 0);
  check(brume_position_from_metres(0, 1.5, 3, &event.u.smoke.from));
  check(brume_position_from_metres(0, 0.3, -2, &event.u.smoke.at));
  event.u.smoke.voxels = brume_smoke_voxels(118.75, kVoxel);  // the room holds 103 m^3, the rest comes out
  check(brume_world_append(world, &event, 1));
}

static brume_renderer* make_renderer(brume_context* context, const Offscreen* o) {
  brume_device_params host = brume_device_defaults();
  host.get_instance_proc_addr = vkGetInstanceProcAddr;
  host.instance = o->instance;
  host.physical_device = o->gpu;
  host.device = o->device;
  brume_device* device = NULL;
  check(brume_device_create(context, &host, &device));
  brume_renderer_params params = brume_renderer_defaults();
  params.width = kWidth;
  params.height = kHeight;
  const brume_light sun = {BRUME_LIGHT_SUN, {0, 0, 0}, {-1, -1.5f, -2}, {3, 2.8f, 2.4f}, 0, 0};
  params.lights = &sun;
  params.light_count = 1;
  brume_renderer* renderer = NULL;
  check(brume_renderer_create(device, &params, &renderer));
  return renderer;
}

// Adds the smoke to a frame whose surfaces are drawn.
static void record_smoke(brume_renderer* renderer, const brume_field* field, const Offscreen* o,
                         uint64_t frame, uint32_t tick) {
  const brume_light light = {BRUME_LIGHT_POINT, {-0.8f, 2.5f, -1.5f}, {0, -1, 0}, {60, 30, 10}, 0, 0};
  brume_frame_params params = brume_frame_defaults();
  params.commands = o->commands;
  params.frame_number = frame;
  params.completed_frame = frame - 1;  // finish_frame waits for the device
  params.camera.position = (brume_point){kEyeX, kEyeY, kEyeZ};
  params.camera.vertical_fov = kFov;
  params.depth = (brume_depth){o->depth.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kNear, INFINITY, 1};
  params.picture = (brume_picture){o->picture.view, VK_FORMAT_R8G8B8A8_SRGB, 1};
  params.seconds = (double)tick / kTicksPerSecond;
  params.jitter_index = (uint32_t)frame;
  params.lights = &light;
  params.light_count = 1;
  check(brume_renderer_record(renderer, field, &params));
}

int main(int argc, char** argv) {
  const Offscreen o = make_offscreen(brume_vulkan_features());
  brume_context* context = NULL;
  brume_world* world = NULL;
  brume_field* field = NULL;
  check(brume_context_create(NULL, &context));
  brume_level* level = make_level(context);
  check(brume_world_create(level, NULL, &world));
  check(brume_field_create(level, NULL, &field));
  brume_renderer* renderer = make_renderer(context, &o);
  throw_grenade(world);

  for (uint32_t frame = 1; frame <= kFrames; ++frame) {
    const uint32_t tick = frame * kTicksPerFrame;
    brume_state* state = NULL;
    check(brume_world_advance_to(world, tick));
    check(brume_world_state(world, &state));
    check(brume_field_update(field, state));
    check(brume_state_destroy(state));
    draw_room(&o);
    record_smoke(renderer, field, &o, frame, tick);
    finish_frame(&o);
  }
  save_picture(&o, argc > 1 ? argv[1] : "hello.png");
  return 0;  // a program that continues destroys all objects, the renderer before its device
}
