// volume_projection_probe.comp in HLSL. Its numbers of bindings are those of probes.h.
#include "export/volume_projection.hlsl"

struct ProjectionParams {
  float3 dimensions;
  float lod;
  float3 center;
  float padding;
  float3 axis_u;
  float tile_count;
  float3 axis_v;
  float columns;
  float3 axis_slice;
  float rows;
  float2 tile_texels;
};
struct ProjectionOutcome {
  float4 uvs;
  float4 value;
  float3 adjusted_position;
  float blend_mask;
  float3 trilinear_uvw;
  float volume_mask;
};

[[vk::binding(50)]] Texture2D atlas;
[[vk::binding(50)]] SamplerState atlas_sampler;
[[vk::binding(48)]] StructuredBuffer<float4> positions;
[[vk::binding(49)]] RWStructuredBuffer<ProjectionOutcome> outcomes;
[[vk::push_constant]] cbuffer Push { ProjectionParams params; };

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
  uint count, stride;
  positions.GetDimensions(count, stride);
  if (id.x >= count) return;
  VolumeSlices slices;
  slices.tile_texels = params.tile_texels;
  slices.padding = params.padding;
  slices.tile_count = params.tile_count;
  slices.columns = params.columns;
  slices.rows = params.rows;
  float3 adjusted = volume_adjusted_position(positions[id.x].xyz, params.center, params.axis_u, params.axis_v,
                                             params.axis_slice);
  VolumeProjection projection = volume_projection(params.dimensions, adjusted, slices);

  ProjectionOutcome outcome;
  outcome.uvs = float4(projection.uv1, projection.uv2);
  outcome.value = volume_sample(atlas, atlas_sampler, projection, params.lod);
  outcome.adjusted_position = adjusted;
  outcome.blend_mask = projection.blend_mask;
  outcome.trilinear_uvw = adjusted / params.dimensions + 0.5;
  outcome.volume_mask = projection.volume_mask;
  outcomes[id.x] = outcome;
}
