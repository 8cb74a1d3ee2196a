// The media of a frame of several volumes, a block of steps of a ray at a time: one volume after the other adds what it
// has at each step, so that a ray keeps one of them in registers, however many there are. The includer defines the
// constant kBlockSteps, at most kMostBlockSteps: the more, the less often a volume's ray is set up, but a software
// rasteriser runs all of them for any.
#ifndef MEDIA_BLOCK_GLSL
#define MEDIA_BLOCK_GLSL
#include "lib/media_set.glsl"
#include "lib/medium_smoke.glsl"
#include "lib/medium_volumes.glsl"

const uint kMostBlockSteps = 4u;

/// The sums of the steps of a ray's block.
struct MediaBlock {
  VolumesSample steps[kMostBlockSteps];
};

// Between two blocks.
float next_of[kMaxVolumes];  // the first sample behind the empty space around the ray, else one that was
float next_smoke;

/// Before blocks in other places than those before.
void restart_blocks() {
  for (uint i = 0u; i < frame.media.volume_count; ++i) next_of[i] = -1e30;
  next_smoke = -1e30;
}

/// The first sample at or behind t that may be inside a medium.
float next_block(float t) {
  float next = kHasSmoke ? next_smoke : 1e30;
  for (uint i = 0u; i < frame.media.volume_count; ++i) next = min(next, next_of[i]);
  return max(t, next);
}

/// The samples from the one at t on, at most `most`, that come before the one at t_next.
uint steps_before(float t_next, float t, float ds, uint most) {
  return uint(clamp(ceil((t_next - t) / ds - 0.5), 1.0, float(most)));
}

/// Adds what volume i has at the samples of a span in one of its bricks: `first` and those behind it, before `end`.
void add_brick(uint i, WorldRay world, VoxelRay ray, BrickSpan span, float t, float ds, uint first, uint end,
               inout MediaBlock block, inout uint texture_samples) {
  const VolumeBrick brick = brick_of(i, ray, span);
  LightRay lit;
  if (kIsLit) lit = light_ray(i, world, ray);
  [[unroll]] for (uint step = 0u; step < kMostBlockSteps; ++step) {
    const float t_step = t + float(step) * ds;
    if (step < kBlockSteps && step >= first && step < end)
      add_volume_at(i, brick, lit, ray, ds, world.origin + world.direction * t_step, t_step,
                    block.steps[step], texture_samples);
  }
}

/// Adds volume i at the `count` samples from the one at t on.
void add_volume_block(uint i, WorldRay world, float t, float ds, uint count, inout MediaBlock block,
                      inout uint texture_samples) {
  if (next_of[i] > t + (float(count) - 0.5) * ds) return;
  const VolumeRay ray = volume_ray(i, world);
  for (uint step = 0u; step < count;) {
    const float t_step = t + float(step) * ds;
    const BrickSpan span = volume_span(i, ray, t_step, ds);
    const uint end = step + steps_before(span.t_next, t_step, ds, count - step);
    if (span.slot != kNoSlot) add_brick(i, world, ray.ray, span, t, ds, step, end, block, texture_samples);
    next_of[i] = span.slot == kNoSlot ? span.t_next : t;
    step = end;
  }
}

/// Adds the smoke at the `count` samples from the one at t on.
void add_smoke_block(WorldRay world, SmokeRay ray, float t, float ds, uint count, inout MediaBlock block,
                     inout uint texture_samples) {
  if (next_smoke > t + (float(count) - 0.5) * ds) return;
  SmokeSpan span;
  span.bricks.t_next = t;
  [[unroll]] for (uint step = 0u; step < kMostBlockSteps; ++step) {
    if (step >= kBlockSteps || step >= count) continue;
    const float t_step = t + float(step) * ds;
    if (t_step > span.bricks.t_next - 0.5 * ds) span = smoke_span(world, t_step, ds);
    if (t_step < span.bricks.t_first || t_step >= span.bricks.t_stop) continue;
    const SmokeSample here =
        sample_smoke(ray, span, world.origin + world.direction * t_step, t_step, 1.0, texture_samples);
    if (here.density <= 0.0) continue;
    const float extinction = frame.look.extinction * here.density;
    block.steps[step].light += extinction * frame.look.albedo * smoke_inscatter(span, here, texture_samples);
    block.steps[step].extinction += extinction;
  }
  next_smoke = span.bricks.slot == kNoSlot ? span.bricks.t_next : t;
}

/// Sums all media over the `count` samples from the one at t on.
MediaBlock sum_block(WorldRay world, SmokeRay smoke, float t, float ds, uint count, inout uint texture_samples) {
  MediaBlock block;
  [[unroll]] for (uint step = 0u; step < kMostBlockSteps; ++step)
    block.steps[step] = VolumesSample(0.0, vec3(0.0), vec3(0.0));
  for (uint i = 0u; i < frame.media.volume_count; ++i)
    add_volume_block(i, world, t, ds, count, block, texture_samples);
  if (kHasSmoke) add_smoke_block(world, smoke, t, ds, count, block, texture_samples);
  return block;
}

#endif
