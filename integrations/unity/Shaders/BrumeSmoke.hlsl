// For a Custom Function node of a shader graph, BrumeSmoke, of a mesh that covers the screen. Copy smoke.hlsl and
// smoke_march.hlsl of shaders/export beside it. Textures, constants and lights are globals (Shader.SetGlobal...).
#ifndef BRUME_SMOKE_UNITY_HLSL
#define BRUME_SMOKE_UNITY_HLSL

#define BRUME_DECLARED
Texture3D<float4> brume_density;
Texture3D<float4> brume_displacement;
Texture3D<uint4> brume_pages;
Texture3D<uint4> brume_cells;
Texture2D<uint4> brume_boundary;
Texture2D<uint4> brume_corners;
Texture2D<float4> brume_holes;
Texture2D<float4> brume_masks;
Texture3D<float4> brume_noise;
Texture3D<float4> brume_detail;
Texture3D<float4> brume_light_volume;
float4 brume_constants[10];

// Unity makes samplers by these words in their names.
SamplerState brume_linear_clamp;
SamplerState brume_linear_repeat;
#define brume_density_sampler brume_linear_clamp
#define brume_displacement_sampler brume_linear_clamp
#define brume_masks_sampler brume_linear_clamp
#define brume_light_volume_sampler brume_linear_clamp
#define brume_noise_sampler brume_linear_repeat
#define brume_detail_sampler brume_linear_repeat

#include "smoke.hlsl"

// The lights of TextureLight's list, in the level: a light's position [m] and 1, and its irradiance at one metre; the
// direction towards a sun and 0, and its irradiance.
float4 brume_light_positions[15];
float4 brume_light_colors[15];
float4 brume_ambient;  // radiance of the sky; w: fraction of it, and of the suns' light, that walls and ground reflect

float3 brume_light(float3 position, float3 texel, float3 direction) {
  const float3 albedo = float3(0.92, 0.92, 0.92);
  const float g = 0.2;
  float2 sky = brume_sky_at(texel);
  float3 sum = float3(0.0, 0.0, 0.0);
  float3 on_ground = float3(0.0, 0.0, 0.0);
  for (int i = 0; i < BRUME_LIGHT_COUNT; ++i) {
    float3 to = brume_light_positions[i].xyz - brume_light_positions[i].w * position;
    float square = max(dot(to, to), 0.01);
    float3 towards = to * rsqrt(square);
    float2 reach = brume_light_at(texel, i);
    float3 arriving = brume_light_colors[i].rgb / square * reach.y;
    sum += arriving * brume_scattered(reach.x, dot(towards, direction), albedo, g, sky.x);
    on_ground += (1.0 - brume_light_positions[i].w) * arriving * max(towards.y, 0.0);
  }
  float3 reflected = brume_ambient.w * (brume_ambient.rgb + on_ground / 3.14159265);
  return sum + brume_scattered_sky(sky, brume_ambient.rgb, reflected, albedo, g);
}

#include "smoke_march.hlsl"

// Eye and direction are Unity's; the level's z points the other way. The level needs a sky (TexturesParams.Sky).
// Blend: color + (1 - alpha) * what is behind.
void BrumeSmoke_float(float3 Eye, float3 Direction, float Distance, float Jitter, float PixelWidth, out float3 Color,
                      out float Alpha) {
  const float3 mirrored = float3(1.0, 1.0, -1.0);
  float4 smoke = brume_march(Eye * mirrored, Direction * mirrored, Distance, Jitter, PixelWidth);
  Color = smoke.rgb;
  Alpha = 1.0 - smoke.a;
}

#endif
