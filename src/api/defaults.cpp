#include "api/defaults.hpp"

#include <brume/brume_textures.h>

namespace brume::api {

template <>
brume_context_params defaults() {
  brume_context_params params{};
  params.struct_size = sizeof(brume_context_params);
  return params;
}

template <>
brume_voxels_params defaults() {
  brume_voxels_params params{};
  params.struct_size = sizeof(brume_voxels_params);
  params.layout.voxel_size = 0.5f;
  return params;
}

template <>
brume_triangles_params defaults() {
  brume_triangles_params params{};
  params.struct_size = sizeof(brume_triangles_params);
  params.layout.voxel_size = 0.5f;
  params.margin = 2;
  return params;
}

template <>
brume_world_params defaults() {
  brume_world_params params{};
  params.struct_size = sizeof(brume_world_params);
  params.ticks_per_second = 64;
  return params;
}

template <>
brume_sender_params defaults() {
  brume_sender_params params{};
  params.struct_size = sizeof(brume_sender_params);
  params.history = 128;
  return params;
}

template <>
brume_receiver_params defaults() {
  brume_receiver_params params{};
  params.struct_size = sizeof(brume_receiver_params);
  params.max_bytes = 16777216u;
  params.max_voxels = 67108864u;
  params.max_items = 1048576u;
  return params;
}

template <>
brume_field_params defaults() {
  brume_field_params params{};
  params.struct_size = sizeof(brume_field_params);
  params.extinction = 3.0f;
  return params;
}

template <>
brume_drawn_params defaults() {
  brume_drawn_params params{};
  params.struct_size = sizeof(brume_drawn_params);
  params.erosion = 0.5f;
  params.noise_size = 1.5f;
  params.detail = 1.0f;
  params.hole_rim = 0.06f;
  params.swirl = 0.2f;
  params.rise = 0.12f;
  return params;
}

template <>
brume_textures_params defaults() {
  brume_textures_params params{};
  params.struct_size = sizeof(brume_textures_params);
  params.swirl_seconds = 12.0f;
  params.noise_spacing = 1;
  return params;
}

template <>
brume_textures_frame defaults() {
  brume_textures_frame frame{};
  frame.struct_size = sizeof(brume_textures_frame);
  return frame;
}

namespace {

brume_event event_of(std::uint32_t kind, std::uint32_t tick) {
  brume_event event{};
  event.struct_size = sizeof(brume_event);
  event.kind = kind;
  event.tick = tick;
  if (kind == BRUME_EVENT_SMOKE) {
    event.u.smoke.voxels = brume_smoke_voxels(225.0, 0.5);
    event.u.smoke.bloom_ticks = 64;
    event.u.smoke.hold_ticks = 18 * 64;
    event.u.smoke.dissolve_ticks = 3 * 64;
  } else if (kind == BRUME_EVENT_SHOT) {
    event.u.shot.radius_1024 = brume_length(0.2);
    event.u.shot.reach_far_ms = 250;
    event.u.shot.expand_ms = 50;
    event.u.shot.stay_open_ms = 1000;
    event.u.shot.fade_ms = 350;
  } else if (kind == BRUME_EVENT_BLAST) {
    event.u.blast.radius_1024 = brume_length(5.0);
    event.u.blast.speed_1024 = brume_length(32.0);
    event.u.blast.remaining_255 = 5;
    event.u.blast.refill_rim_ms = 500;
    event.u.blast.refill_middle_ms = 5000;
  }
  return event;
}

}  // namespace
}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_context_params_init(brume_context_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_voxels_params_init(brume_voxels_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_triangles_params_init(brume_triangles_params* params,
                                         uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_event_init(brume_event* event, uint32_t kind, uint32_t tick) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) { required(event, "event") = event_of(kind, tick); });
}

brume_result brume_world_params_init(brume_world_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_sender_params_init(brume_sender_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_receiver_params_init(brume_receiver_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_field_params_init(brume_field_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_drawn_params_init(brume_drawn_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_textures_params_init(brume_textures_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_textures_frame_init(brume_textures_frame* frame, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, frame, struct_size);
}

}  // extern "C"
