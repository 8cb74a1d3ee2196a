// Smoke in a shader of yours: density, transmittance and a march, from the textures and constants of brume_textures.h.
// The same in GLSL (4.0, ES 3.0) and HLSL. Guide: docs/start/your-engine.md.
//
//   #include "smoke.glsl"
//   vec3 brume_light(vec3 position, vec3 texel, vec3 direction) { ... }  // yours
//   #include "smoke_march.glsl"
//   vec4 smoke = brume_march(eye, direction, distance_to_surface, jitter, pixel_width);
//   color = smoke.rgb + smoke.a * color;  // radiance in front of the surface, and what of it is left
//
// Positions are in the world [m], with the axes of the level; directions are unit vectors. Where your renderer has
// other axes or units, convert both, and the distance to the surface. With BRUME_DECLARED defined, you declare textures
// and constants of these names, for example with bindings.
#ifndef BRUME_SMOKE_HLSL
#define BRUME_SMOKE_HLSL

#ifndef BRUME_DECLARED
Texture3D<float4> brume_density; SamplerState brume_density_sampler;
Texture3D<float4> brume_displacement; SamplerState brume_displacement_sampler;
Texture3D<uint4> brume_pages;
Texture3D<uint4> brume_cells;
Texture2D<uint4> brume_boundary;
Texture2D<uint4> brume_corners;
Texture2D<float4> brume_holes; SamplerState brume_holes_sampler;
Texture2D<float4> brume_masks; SamplerState brume_masks_sampler;
Texture3D<float4> brume_noise; SamplerState brume_noise_sampler;
Texture3D<float4> brume_detail; SamplerState brume_detail_sampler;
Texture3D<float4> brume_light_volume; SamplerState brume_light_volume_sampler;
cbuffer brume_constants_buffer { float4 brume_constants[10]; };
#endif

// ---- Constants of a frame ----

#define BRUME_ORIGIN brume_constants[0].xyz           // low corner of voxel (0, 0, 0) [m]
#define BRUME_VOXELS_PER_METRE brume_constants[0].w
#define BRUME_WINDOW_LOW brume_constants[1].xyz       // first brick of the pages [bricks]
#define BRUME_VOXEL_SIZE brume_constants[1].w         // [m]
#define BRUME_WINDOW_SIZE brume_constants[2].xyz      // [bricks]
#define BRUME_HOLE_COUNT int(brume_constants[2].w)
#define BRUME_ATLAS_BRICKS brume_constants[3].xyz     // bricks of the textures along each axis
#define BRUME_EXTINCTION brume_constants[3].w         // where density is 1 [1/m]
#define BRUME_LOW brume_constants[4].xyz              // all smoke is between these [m]
#define BRUME_STEP brume_constants[4].w               // length of a step of the march, at most [m]
#define BRUME_HIGH brume_constants[5].xyz
#define BRUME_EROSION brume_constants[5].w            // strength of the noise, [0, 1]
#define BRUME_NOISE_OFFSET brume_constants[6].xyz     // [tiles]
#define BRUME_NOISE_FREQUENCY brume_constants[6].w    // tiles of noise per metre
#define BRUME_DETAIL_OFFSET brume_constants[7].xyz
#define BRUME_DETAIL_FREQUENCY brume_constants[7].w
#define BRUME_DETAIL brume_constants[8].x             // strength of the detail, [0, 1]
#define BRUME_HOLE_RIM brume_constants[8].y           // how far noise frays the rims of holes [m]
#define BRUME_NOISE_POINTS brume_constants[8].z       // points of displacement in a brick, along each axis,
#define BRUME_POINTS_PER_VOXEL brume_constants[8].w
#define BRUME_LIGHT_GROUPS brume_constants[9].x       // of two lights each, the sky being the last
#define BRUME_LIGHT_COUNT int(brume_constants[9].y)   // without the sky
#define BRUME_HAS_SKY (brume_constants[9].z > 0.5)

// ---- Bricks of 8^3 voxels, and their places in the textures ----

// The place of a brick in the textures, in bricks; x is below 0 where there is no smoke.
int3 brume_place(int3 brick) {
  int3 at = brick - int3(BRUME_WINDOW_LOW);
  int3 size = int3(BRUME_WINDOW_SIZE);
  bool below = at.x < 0 || at.y < 0 || at.z < 0;
  if (below || at.x >= size.x || at.y >= size.y || at.z >= size.z) return int3(-1, 0, 0);
  int slot = int(brume_pages.Load(int4(at, 0)).r) - 1;
  if (slot < 0) return int3(-1, 0, 0);
  int3 atlas = int3(BRUME_ATLAS_BRICKS);
  return int3(slot % atlas.x, (slot / atlas.x) % atlas.y, slot / (atlas.x * atlas.y));
}

// ---- Cells that a surface runs through: smoke ends at the surface, not at a voxel ----

// On which side of a plane a point is, 1 or 0. The plane is an octahedral normal of 2 x 10 bits and an offset of 12
// bits from the middle of its cell; 0: there is none. Moves `off` to a voxel off the plane.
uint brume_side(uint plane, float3 from_middle, inout float3 off) {
  if (plane == 0u) return 0u;
  float2 e = float2(float(plane & 1023u), float((plane >> 10) & 1023u)) * (2.0 / 1022.0) - float2(1.0, 1.0);
  float3 n = float3(e.x, e.y, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  n = normalize(n);
  float height = dot(n, from_middle) - (float(plane >> 20) * (2.0 / 4094.0) - 1.0);
  off += n * ((height > 0.0 ? 1.0 : -1.0) * max(1.0 - abs(height), 0.0));
  return height > 0.0 ? 1u : 0u;
}

float4 brume_bytes(uint word) {
  float4 bytes = float4(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u), float(word >> 24));
  return bytes * (1.0 / 255.0);
}

// Smoke of a cell at `f`, from its low corner, each coordinate in [0, 1]: between the densities of its eight corners,
// as they are on the point's side of its planes. `number` is above 0.
float brume_cell_density(uint number, float3 f, inout float3 off) {
  int cell = int(number) - 1;
  uint4 boundary = brume_boundary.Load(int3(int2(cell % 256, cell / 256), 0));
  uint sides = brume_side(boundary.x, f - 0.5, off);
  sides |= brume_side(boundary.y, f - 0.5, off) << 1;
  sides |= brume_side(boundary.z, f - 0.5, off) << 2;
  int set = int(boundary.w + sides);
  uint2 corners = brume_corners.Load(int3(int2(set % 1024, set / 1024), 0)).rg;
  float4 layer = lerp(brume_bytes(corners.x), brume_bytes(corners.y), f.z);
  float2 row = lerp(layer.xy, layer.zw, f.y);
  return lerp(row.x, row.y, f.x);
}

// Density before noise and holes at a point of a brick, [0, 1]. `local`: from the brick's low corner [voxels]. `off`:
// how far from the point its light is to be read, so that none leaks through walls [voxels].
float brume_local_density(int3 place, float3 local, out float3 off) {
  off = float3(0.0, 0.0, 0.0);
  float3 uvw = (float3(place) * 10.0 + local + 1.0) / (BRUME_ATLAS_BRICKS * 10.0);
  float2 texel = brume_density.SampleLevel(brume_density_sampler, uvw, 0.0).rg;
  // A solid voxel beside it?
  if (texel.g > 0.998) return texel.r;
  int3 cell = clamp(int3(local + 0.5), int3(0, 0, 0), int3(8, 8, 8));
  uint number = brume_cells.Load(int4(place * 9 + cell, 0)).r;
  if (number == 0u) return texel.r;
  float density = brume_cell_density(number, local + 0.5 - float3(cell), off);
  off = clamp(local + off, -0.5, 8.5) - local;
  return density;
}

// ---- Noise ----

// How much wisps count beside billows: in very thin smoke as much.
float brume_wisps(float density) { return 0.5 * (1.0 - density) * (1.0 - density); }

// What noise removes: density below it.
float brume_threshold(float density, float2 noise) {
  float2 limited = clamp(noise, 0.0, 1.0);
  return BRUME_EROSION * (1.0 - lerp(limited.x, limited.y, brume_wisps(density)));
}

// Billows and wisps from a texel of the noise.
float2 brume_billows(float4 noise) {
  return float2(1.35 * dot(noise, float4(0.65, 0.1, 0.0, 0.25)) - 0.235,
              1.3 * dot(noise, float4(0.25, 0.0, 0.75, 0.0)) - 0.1);
}

// What erosion leaves of a density, before holes. `rim`: the noise of the rims of holes, [-1, 1].
float brume_erode(float density, float3 position, float3 displacement, float pixel, out float rim) {
  float3 p = position + displacement;
  float4 noise = brume_noise.SampleLevel(brume_noise_sampler, p * BRUME_NOISE_FREQUENCY + BRUME_NOISE_OFFSET, 0.0);
  float weight = BRUME_DETAIL * clamp(1.5 - 16.0 * BRUME_DETAIL_FREQUENCY * pixel, 0.0, 1.0);
  float2 detail = float2(0.0, 0.0);
  if (weight > 0.0) {
    float level = log2(max(128.0 * BRUME_DETAIL_FREQUENCY * pixel, 1.0));
    float3 at = p * BRUME_DETAIL_FREQUENCY + BRUME_DETAIL_OFFSET;
    float2 texel = brume_detail.SampleLevel(brume_detail_sampler, at, level).rg;
    detail = weight * 0.54 * (2.0 * texel - 1.0);
  }
  rim = clamp(2.0 * noise.g - 1.0 + 1.5 * detail.x, -1.0, 1.0);
  if (BRUME_EROSION <= 0.0) return density;
  float threshold = brume_threshold(density, brume_billows(noise) + detail);
  float above = 4.0 * (density - threshold) / max(1.0 - threshold, 0.05);
  above += BRUME_DETAIL * (above - 0.5);
  return clamp(above, 0.0, 1.0) * (1.0 + BRUME_EROSION * (0.7 * noise.r + 0.3 * noise.g - 0.5));
}

// ---- Holes ----

// What a hole leaves of the smoke at a point. `rim`: noise, [-1, 1].
float brume_after_hole(int hole, float3 position, float rim) {
  float4 origin = brume_holes.Load(int3(int2(0, hole), 0));   // w: radius
  float4 forward = brume_holes.Load(int3(int2(1, hole), 0));  // w: depth
  float3 from = position - origin.xyz;
  float z = dot(from, forward.xyz);
  float3 across = from - z * forward.xyz;
  float radius = origin.w + rim * min(BRUME_HOLE_RIM, 0.25 * origin.w);
  if (z < 0.0 || z > forward.w || dot(across, across) >= 2.0001 * radius * radius) return 1.0;

  // Its opening at this depth, since the front has passed.
  float4 right = brume_holes.Load(int3(int2(2, hole), 0));  // w: time since the shot
  float4 up = brume_holes.Load(int3(int2(3, hole), 0));     // w: time to the far end
  float4 times = brume_holes.Load(int3(int2(4, hole), 0));  // to expand, to stay open, to fade; w: shape
  float age = right.w - z / max(forward.w, 1e-6) * up.w;
  float strength = 1.0 - clamp((age - times.x - times.y) / max(times.z, 1e-6), 0.0, 1.0);
  if (age <= 0.0 || strength <= 0.0) return 1.0;
  radius *= clamp(age / max(times.x, 1e-6), 0.0, 1.0) * strength;

  // The place in its cross-section: a cylinder, a box, or an image.
  float x = dot(from, right.xyz);
  float y = dot(from, up.xyz);
  float from_axis = times.w < 0.5 ? sqrt(x * x + y * y) : max(abs(x), abs(y));
  if (from_axis >= radius) return 1.0;
  if (times.w < 1.5) return 1.0 - strength * smoothstep(0.0, 1.0, (radius - from_axis) / (0.4 * radius));
  float4 uv = brume_holes.Load(int3(int2(5, hole), 0));
  float2 at = clamp(float2(0.5 + 0.5 * x / radius, 0.5 - 0.5 * y / radius), 0.0, 1.0);
  return 1.0 - strength * brume_masks.SampleLevel(brume_masks_sampler, lerp(uv.xy, uv.zw, at), 0.0).r;
}

// Whether a line comes near a hole's axis.
bool brume_meets_hole(int hole, float3 origin, float3 direction) {
  float4 from = brume_holes.Load(int3(int2(0, hole), 0));
  float3 forward = brume_holes.Load(int3(int2(1, hole), 0)).xyz;
  float3 apart = origin - from.xyz;
  float3 normal = cross(direction, forward);
  float reach = 1.5 * (from.w + min(BRUME_HOLE_RIM, 0.25 * from.w));
  float crossing = dot(normal, normal);
  if (crossing < 1e-4) return length(apart - dot(apart, forward) * forward) < reach + 0.02 * length(apart);
  float height = dot(apart, normal);
  return height * height < reach * reach * crossing;
}

// The holes that a line may meet, a bit each.
uint4 brume_holes_of_ray(float3 origin, float3 direction) {
  uint4 bits = uint4(0u, 0u, 0u, 0u);
  for (int hole = 0; hole < BRUME_HOLE_COUNT; ++hole) {
    if (!brume_meets_hole(hole, origin, direction)) continue;
    uint bit = 1u << uint(hole & 31);
    int word = hole >> 5;
    if (word == 0) bits.x |= bit;
    if (word == 1) bits.y |= bit;
    if (word == 2) bits.z |= bit;
    if (word == 3) bits.w |= bit;
  }
  return bits;
}

float brume_after_word(uint bits, int first, float3 position, float rim) {
  float left = 1.0;
  int hole = first;
  while (bits != 0u && left > 0.0) {
    if ((bits & 1u) != 0u) left *= brume_after_hole(hole, position, rim);
    bits = bits >> 1;
    ++hole;
  }
  return left;
}

float brume_after_holes(uint4 bits, float3 position, float rim) {
  float left = brume_after_word(bits.x, 0, position, rim);
  if (bits.y != 0u) left *= brume_after_word(bits.y, 32, position, rim);
  if (bits.z != 0u) left *= brume_after_word(bits.z, 64, position, rim);
  if (bits.w != 0u) left *= brume_after_word(bits.w, 96, position, rim);
  return left;
}

// ---- Light, where the texture of light is filled ----

float2 brume_light_pair(float3 texel, int number) {
  float3 size = BRUME_ATLAS_BRICKS * 10.0;
  int group = number / 2;
  float3 at = float3(texel.xy, texel.z + float(group) * size.z) / float3(size.xy, size.z * BRUME_LIGHT_GROUPS);
  float4 pair = brume_light_volume.SampleLevel(brume_light_volume_sampler, at, 0.0);
  return number - 2 * group == 0 ? pair.xy : pair.zw;
}

// The optical depth of the smoke between a point and light `number`, and in y how much of the light walls let through.
// `texel`: as brume_light has it.
float2 brume_light_at(float3 texel, int number) {
  float2 pair = brume_light_pair(texel, number);
  return float2(-4.0 * log(max(pair.x, 1.0 / 512.0)), pair.y);
}

// The sky: what passes the smoke, the mean over all directions, and in y that times the radiance of a sky of 0.75 +
// 0.375 y in the direction (x, y, z) where no wall hides it. Where the texture of light has no sky, what is usual in
// smoke under an open sky.
float2 brume_sky_at(float3 texel) {
  if (!BRUME_HAS_SKY) return float2(0.3, 0.225);
  return brume_light_pair(texel, BRUME_LIGHT_COUNT);
}

// Henyey and Greenstein 1941 [1/sr].
float brume_phase(float g, float cosine) {
  float d = 1.0 + g * g - 2.0 * g * cosine;
  return 0.0795774715 * (1.0 - g * g) / (d * sqrt(d));
}

// What smoke scatters towards the eye of a light's irradiance [1/sr], once and many times, the way of Brume's renderer
// (docs/how/light.md). `depth`: x of brume_light_at; `cosine`: between the directions towards the light and of the ray;
// `escape`: x of brume_sky_at, or 0.3; `g`: mean cosine of the phase function.
float3 brume_scattered(float depth, float cosine, float3 albedo, float g, float escape) {
  float forward = max(g, 0.0);
  float3 again = albedo * (1.0 - escape);
  float3 decay = 1.05 * sqrt((1.0 - 0.951 * albedo) * (1.0 - forward * albedo));
  float3 fraction = 0.788 * exp(-0.481 * forward) * again / (1.0 - 0.775 * again);
  float even = forward / (1.0 + exp(3.409 - 4.663 * forward));
  float3 often = fraction * exp(-decay * depth) * brume_phase(even, cosine);
  return albedo * (exp(-depth) * brume_phase(g, cosine) + often);
}

// What smoke scatters of a sky of `ambient` and of the surfaces that hide it, which send `reflected`: a fifth, say, of
// the sum of the ambient light and of the suns' irradiance on level ground, divided by pi. `sky`: of brume_sky_at.
float3 brume_scattered_sky(float2 sky, float3 ambient, float3 reflected, float3 albedo, float g) {
  float escape = max(sky.x, 0.002);
  float3 arriving = ambient * sky.y + reflected * max(escape - sky.y / 0.75, 0.0);
  float3 spread = pow(float3(escape, escape, escape), sqrt((1.0 - albedo) * (1.0 - g * albedo)));
  return albedo * spread * arriving / escape;
}

// ---- Samples ----

// Density as it is drawn at a point of a brick: after noise and holes. `pixel`: width of a pixel there [m].
float brume_sample(int3 place, float3 local, float3 position, float pixel, uint4 holes, out float3 off) {
  float density = brume_local_density(place, local, off);
  bool cut = (holes.x | holes.y | holes.z | holes.w) != 0u;
  if (density <= 0.0 || (BRUME_EROSION <= 0.0 && !cut)) return density;
  // Without any noise there is no displacement.
  bool still = BRUME_EROSION <= 0.0 && BRUME_HOLE_RIM <= 0.0;
  if (still) return density * brume_after_holes(holes, position, 0.0);
  float3 at = float3(place) * BRUME_NOISE_POINTS + (local + 0.5) * BRUME_POINTS_PER_VOXEL + 0.5;
  at /= BRUME_ATLAS_BRICKS * BRUME_NOISE_POINTS;
  float3 displacement = brume_displacement.SampleLevel(brume_displacement_sampler, at, 0.0).xyz;
  float rim;
  density = brume_erode(density, position, displacement, pixel, rim);
  if (cut && density > 0.0) density *= brume_after_holes(holes, position, rim);
  return density;
}

// Density as it is drawn at any point; 1: as dense as smoke is before erosion. `pixel`: width of a pixel there [m];
// 0: with all detail.
float brume_density_at(float3 position, float pixel) {
  float3 voxel = (position - BRUME_ORIGIN) * BRUME_VOXELS_PER_METRE;
  int3 brick = int3(floor(voxel * 0.125));
  int3 place = brume_place(brick);
  if (place.x < 0) return 0.0;
  // Any line through the point meets the holes that contain it.
  uint4 holes = brume_holes_of_ray(position, float3(0.0, 1.0, 0.0));
  float3 off;
  return brume_sample(place, voxel - float3(brick) * 8.0, position, pixel, holes, off);
}

// The direction without zeros, to be divided by.
float3 brume_divisor(float3 direction) {
  return float3(abs(direction.x) < 1e-6 ? 1e-6 : direction.x, abs(direction.y) < 1e-6 ? 1e-6 : direction.y,
              abs(direction.z) < 1e-6 ? 1e-6 : direction.z);
}

// The part of a ray in which there may be smoke, from and to [m]; empty where to <= from.
float2 brume_span(float3 origin, float3 direction, float t_end) {
  float3 d = brume_divisor(direction);
  float3 a = (BRUME_LOW - origin) / d;
  float3 b = (BRUME_HIGH - origin) / d;
  float3 near = min(a, b);
  float3 far = max(a, b);
  return float2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, t_end)));
}

// How many steps lead out of the brick, at least one.
float brume_steps_out(float3 voxel, int3 brick, float3 direction, float step_voxels) {
  float3 d = brume_divisor(direction);
  float3 low = float3(brick) * 8.0;
  float3 a = (low - voxel) / d;
  float3 b = (low + 8.0 - voxel) / d;
  float3 far = max(a, b);
  return max(ceil(min(far.x, min(far.y, far.z)) / step_voxels), 1.0);
}

// What smoke lets through along a line, for shadows: by `steps` equal steps.
float brume_transmittance(float3 from, float3 to, int steps, float pixel) {
  float whole = length(to - from);
  if (whole <= 0.0) return 1.0;
  float3 direction = (to - from) / whole;
  float2 span = brume_span(from, direction, whole);
  if (span.y <= span.x) return 1.0;
  uint4 holes = brume_holes_of_ray(from, direction);
  float ds = (span.y - span.x) / float(steps);
  float depth = 0.0;
  for (int i = 0; i < steps; ++i) {
    float3 position = from + (span.x + (float(i) + 0.5) * ds) * direction;
    float3 voxel = (position - BRUME_ORIGIN) * BRUME_VOXELS_PER_METRE;
    int3 brick = int3(floor(voxel * 0.125));
    int3 place = brume_place(brick);
    if (place.x < 0) continue;
    float3 off;
    depth += brume_sample(place, voxel - float3(brick) * 8.0, position, pixel, holes, off);
  }
  return exp(-BRUME_EXTINCTION * ds * depth);
}

#endif
