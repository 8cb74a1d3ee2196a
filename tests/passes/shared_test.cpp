#include "brume_test_shaders.hpp"
#include "shared/accumulate.h"
#include "shared/frame.h"
#include "shared/gbuffer.h"
#include "shared/hole.h"
#include "shared/light.h"
#include "shared/noise.h"
#include "shared/resolve.h"
#include "shared/smoke_light.h"
#include "shared/smoke_shadow.h"
#include "tests/gpu/gpu_test.hpp"

namespace brume::passes {
namespace {

using gpu::GpuTest;

/// first, first + 1, ... as the shader wrote them.
template <typename V>
void expect_counted(const V& v, float first) {
  for (int i = 0; i < V::length(); ++i) EXPECT_EQ(static_cast<float>(v[i]), first + static_cast<float>(i));
}

class SharedStructs : public GpuTest {
 protected:
  template <typename T>
  static T one(const gpu::Buffer& buffer) {
    return read_back<T>(buffer, 1)[0];
  }
};

TEST_F(SharedStructs, EveryMemberIsWhereBothLanguagesSeeIt) {
  const gpu::ComputePipeline pipeline(
      context(), shaders::echo_comp,
      {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
       gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
       gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
      0, {1, 1, 1});
  std::vector<gpu::Buffer> out;
  for (const std::size_t size :
       {sizeof(shared::FrameConstants), sizeof(shared::Light), sizeof(shared::Hole),
        sizeof(shared::BoundaryCell), sizeof(shared::DrawConstants), sizeof(shared::Vertex),
        sizeof(shared::NoiseParams), sizeof(shared::SmokeLightParams), sizeof(shared::SmokeShadowParams),
        sizeof(shared::ShadowView), sizeof(shared::RayEnds), sizeof(shared::SmokeShadowFace),
        sizeof(shared::MarchList), sizeof(shared::AccumulateParams), sizeof(shared::AccumulatedPixel),
        sizeof(shared::TexelList), sizeof(shared::ShadowRays), sizeof(shared::LightGather)}) {
    out.emplace_back(context(), size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  }
  runner().run([&](gpu::Recorder& recorder) {
    recorder.bind(pipeline, {gpu::write(out[0]), gpu::write(out[1]), gpu::write(out[2]), gpu::write(out[3]),
                             gpu::write(out[4]), gpu::write(out[5]), gpu::write(out[6]), gpu::write(out[7]),
                             gpu::write(out[8]), gpu::write(out[9]), gpu::write(out[10]), gpu::write(out[11]),
                             gpu::write(out[12]), gpu::write(out[13]), gpu::write(out[14]),
                             gpu::write(out[15]), gpu::write(out[16]), gpu::write(out[17])});
    recorder.dispatch_threads(pipeline, 1);
  });

  const auto frame = one<shared::FrameConstants>(out[0]);
  for (int i = 0; i < 4; ++i)
    expect_counted(frame.camera.clip_from_world[i], 100.0f + 4.0f * static_cast<float>(i));
  expect_counted(frame.camera.eye_world, 120);
  EXPECT_EQ(frame.camera.near_z, 123);
  expect_counted(frame.camera.forward, 124);
  expect_counted(frame.camera.right, 127);
  expect_counted(frame.camera.up, 130);
  expect_counted(frame.sky.zenith, 140);
  expect_counted(frame.sky.horizon, 143);
  expect_counted(frame.sky.ambient, 146);
  EXPECT_EQ(frame.sky.stars, 149);
  EXPECT_EQ(frame.sky.bounce, 189);
  expect_counted(frame.look.albedo, 150);
  const float look[] = {frame.look.extinction,  frame.look.step_length,        frame.look.opaque_transmittance,
                        frame.look.erosion,     frame.look.noise_period,       frame.look.rise,
                        frame.look.swirl,        frame.look.swirl_width,         frame.look.multiple_scattering,
                        frame.look.hole_rim,    frame.look.phase.g_hg,         frame.look.phase.g_draine,
                        frame.look.phase.alpha, frame.look.phase.draine_weight};
  for (int i = 0; i < 14; ++i) EXPECT_EQ(look[i], 153.0f + static_cast<float>(i));
  expect_counted(frame.volume.origin_world, 170);
  EXPECT_EQ(frame.volume.voxel_size, 173);
  expect_counted(frame.volume.window_origin, 174);
  expect_counted(frame.volume.window_size, 177);
  expect_counted(frame.volume.atlas_bricks, 180);
  expect_counted(frame.volume.bounds_min, 183);
  expect_counted(frame.volume.bounds_max, 186);
  expect_counted(frame.caster_bounds_min, 210);
  expect_counted(frame.caster_bounds_max, 213);
  expect_counted(frame.solid.origin_world, 200);
  EXPECT_EQ(frame.solid.texel_size, 203);
  expect_counted(frame.solid.size, 204);
  expect_counted(frame.size_px, 190);
  EXPECT_EQ(frame.light_count, 192u);
  EXPECT_EQ(frame.holes.count, 193u);
  EXPECT_EQ(frame.holes.tiles_across, 198u);
  EXPECT_EQ(frame.holes.entries_at, 199u);
  EXPECT_EQ(frame.holes.cells_at, 200u);
  EXPECT_EQ(frame.frame_index, 194u);
  EXPECT_EQ(frame.time, 195);
  EXPECT_EQ(frame.exposure, 196);
  EXPECT_EQ(frame.march_scale, 197u);
  EXPECT_EQ(frame.resolve_error, 201);

  const auto light = one<shared::Light>(out[1]);
  expect_counted(light.position_world, 1);
  EXPECT_EQ(light.range, 4);
  expect_counted(light.intensity, 5);
  EXPECT_EQ(light.kind, 8u);
  expect_counted(light.direction, 9);
  EXPECT_EQ(light.cos_inner, 12);
  EXPECT_EQ(light.cos_outer, 13);
  EXPECT_EQ(light.shadow_layer, 14u);
  expect_counted(light.padding, 15);

  const auto hole = one<shared::Hole>(out[2]);
  expect_counted(hole.origin_world, 1);
  EXPECT_EQ(hole.radius, 4);
  expect_counted(hole.forward, 5);
  EXPECT_EQ(hole.distance_to_far, 8);
  expect_counted(hole.right, 9);
  EXPECT_EQ(hole.time_start, 12);
  expect_counted(hole.up, 13);
  EXPECT_EQ(hole.time_to_reach_far, 16);
  EXPECT_EQ(hole.time_to_expand, 17);
  EXPECT_EQ(hole.time_to_stay_open, 18);
  EXPECT_EQ(hole.time_to_fade, 19);
  EXPECT_EQ(hole.shape, 20u);
  expect_counted(hole.uv_min, 21);
  expect_counted(hole.uv_max, 23);

  const auto cell = one<shared::BoundaryCell>(out[3]);
  EXPECT_EQ(cell.plane0, 1u);
  EXPECT_EQ(cell.plane1, 2u);
  EXPECT_EQ(cell.plane2, 3u);
  EXPECT_EQ(cell.first_set, 4u);

  const auto draw = one<shared::DrawConstants>(out[4]);
  expect_counted(draw.row0, 1);
  expect_counted(draw.row1, 5);
  expect_counted(draw.row2, 9);
  expect_counted(draw.material.base_color, 13);
  EXPECT_EQ(draw.material.roughness, 16);
  expect_counted(draw.material.emission, 17);
  EXPECT_EQ(draw.material.metallic, 20);
  EXPECT_EQ(draw.material.alpha_cutoff, 21);

  const auto vertex = one<shared::Vertex>(out[5]);
  expect_counted(vertex.position, 1);
  expect_counted(vertex.normal, 4);
  expect_counted(vertex.tangent, 7);
  expect_counted(vertex.uv, 11);

  const auto noise = one<shared::NoiseParams>(out[6]);
  EXPECT_EQ(noise.size, 1u);
  EXPECT_EQ(noise.coarse_cells, 2u);
  EXPECT_EQ(noise.seed, 3u);

  const auto smoke_light = one<shared::SmokeLightParams>(out[7]);
  EXPECT_EQ(smoke_light.first, 1u);
  EXPECT_EQ(smoke_light.count, 2u);
  EXPECT_EQ(smoke_light.threads, 3u);
  const auto light_row = one<shared::TexelList>(out[15]);
  EXPECT_EQ(light_row.slot, 1u);
  EXPECT_EQ(light_row.row, 2u);
  EXPECT_EQ(light_row.by_phase, 3u);
  EXPECT_EQ(light_row.had_list, 4u);
  EXPECT_EQ(light_row.first_change, 5u);
  EXPECT_EQ(light_row.change_count, 6u);
  const auto light_pair = one<shared::ShadowRays>(out[16]);
  EXPECT_EQ(light_pair.slot, 1u);
  EXPECT_EQ(light_pair.row, 2u);
  EXPECT_EQ(light_pair.light, 3u);
  EXPECT_EQ(light_pair.block, 4u);
  EXPECT_EQ(light_pair.texels, 5u);
  const auto light_brick = one<shared::LightGather>(out[17]);
  EXPECT_EQ(light_brick.slot, 1u);
  EXPECT_EQ(light_brick.row, 2u);
  EXPECT_EQ(light_brick.sky_page, 3u);
  EXPECT_EQ(light_brick.first_light, 4u);
  EXPECT_EQ(light_brick.light_count, 5u);
  EXPECT_EQ(light_brick.texels, 6u);

  const auto smoke_shadow = one<shared::SmokeShadowParams>(out[8]);
  EXPECT_EQ(smoke_shadow.face_count, 1u);
  EXPECT_EQ(smoke_shadow.step_length, 2);
  EXPECT_EQ(smoke_shadow.spread, 3u);
  expect_counted(smoke_shadow.first, 4);

  const auto face = one<shared::SmokeShadowFace>(out[11]);
  EXPECT_EQ(face.scale, 1);
  expect_counted(face.offset, 2);
  EXPECT_EQ(face.first_block, 4u);
  expect_counted(face.first_texel, 5);
  expect_counted(face.size, 7);

  const auto list = one<shared::MarchList>(out[12]);
  expect_counted(list.groups, 1);
  EXPECT_EQ(list.count, 4u);
  const auto accumulate = one<shared::AccumulateParams>(out[13]);
  for (int i = 0; i < 4; ++i)
    expect_counted(accumulate.past_clip_from_world[i], 1.0f + 4.0f * static_cast<float>(i));
  EXPECT_EQ(accumulate.has_past, 17u);
  const auto pixel = one<shared::AccumulatedPixel>(out[14]);
  EXPECT_EQ(pixel.distance_in_smoke, 1);
  EXPECT_EQ(pixel.frames, 2);

  const auto ends = one<shared::RayEnds>(out[10]);
  expect_counted(ends.position_px, 1);
  const float distances[] = {ends.near, ends.near_last, ends.far_first, ends.far};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(distances[i], 3.0f + static_cast<float>(i));

  const auto view = one<shared::ShadowView>(out[9]);
  for (int i = 0; i < 4; ++i) {
    expect_counted(view.clip_from_world[i], 1.0f + 4.0f * static_cast<float>(i));
    expect_counted(view.world_from_clip[i], 17.0f + 4.0f * static_cast<float>(i));
  }
}

}  // namespace
}  // namespace brume::passes
