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
#ifndef BRUME_SMOKE_GLSL
#define BRUME_SMOKE_GLSL

#ifndef BRUME_DECLARED
uniform highp sampler3D brume_density;
uniform highp sampler3D brume_displacement;
uniform highp usampler3D brume_pages;
uniform highp usampler3D brume_cells;
uniform highp usampler2D brume_boundary;
uniform highp usampler2D brume_corners;
uniform highp sampler2D brume_holes;
uniform highp sampler2D brume_masks;
uniform highp sampler3D brume_noise;
uniform highp sampler3D brume_detail;
uniform highp sampler3D brume_light_volume;
uniform highp vec4 brume_constants[10];
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
ivec3 brume_place(ivec3 brick) {
  ivec3 at = brick - ivec3(BRUME_WINDOW_LOW);
  ivec3 size = ivec3(BRUME_WINDOW_SIZE);
  bool below = at.x < 0 || at.y < 0 || at.z < 0;
  if (below || at.x >= size.x || at.y >= size.y || at.z >= size.z) return ivec3(-1, 0, 0);
  int slot = int(texelFetch(brume_pages, at, 0).r) - 1;
  if (slot < 0) return ivec3(-1, 0, 0);
  ivec3 atlas = ivec3(BRUME_ATLAS_BRICKS);
  return ivec3(slot % atlas.x, (slot / atlas.x) % atlas.y, slot / (atlas.x * atlas.y));
}

// ---- Cells that a surface runs through: smoke ends at the surface, not at a voxel ----

// On which side of a plane a point is, 1 or 0. The plane is an octahedral normal of 2 x 10 bits and an offset of 12
// bits from the middle of its cell; 0: there is none. Moves `off` to a voxel off the plane.
uint brume_side(uint plane, vec3 from_middle, inout vec3 off) {
  if (plane == 0u) return 0u;
  vec2 e = vec2(float(plane & 1023u), float((plane >> 10) & 1023u)) * (2.0 / 1022.0) - vec2(1.0, 1.0);
  vec3 n = vec3(e.x, e.y, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  n = normalize(n);
  float height = dot(n, from_middle) - (float(plane >> 20) * (2.0 / 4094.0) - 1.0);
  off += n * ((height > 0.0 ? 1.0 : -1.0) * max(1.0 - abs(height), 0.0));
  return height > 0.0 ? 1u : 0u;
}

vec4 brume_bytes(uint word) {
  vec4 bytes = vec4(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u), float(word >> 24));
  return bytes * (1.0 / 255.0);
}

// Smoke of a cell at `f`, from its low corner, each coordinate in [0, 1]: between the densities of its eight corners,
// as they are on the point's side of its planes. `number` is above 0.
float brume_cell_density(uint number, vec3 f, inout vec3 off) {
  int cell = int(number) - 1;
  uvec4 boundary = texelFetch(brume_boundary, ivec2(cell % 256, cell / 256), 0);
  uint sides = brume_side(boundary.x, f - 0.5, off);
  sides |= brume_side(boundary.y, f - 0.5, off) << 1;
  sides |= brume_side(boundary.z, f - 0.5, off) << 2;
  int set = int(boundary.w + sides);
  uvec2 corners = texelFetch(brume_corners, ivec2(set % 1024, set / 1024), 0).rg;
  vec4 layer = mix(brume_bytes(corners.x), brume_bytes(corners.y), f.z);
  vec2 row = mix(layer.xy, layer.zw, f.y);
  return mix(row.x, row.y, f.x);
}

// Density before noise and holes at a point of a brick, [0, 1]. `local`: from the brick's low corner [voxels]. `off`:
// how far from the point its light is to be read, so that none leaks through walls [voxels].
float brume_local_density(ivec3 place, vec3 local, out vec3 off) {
  off = vec3(0.0, 0.0, 0.0);
  vec3 uvw = (vec3(place) * 10.0 + local + 1.0) / (BRUME_ATLAS_BRICKS * 10.0);
  vec2 texel = textureLod(brume_density, uvw, 0.0).rg;
  // A solid voxel beside it?
  if (texel.g > 0.998) return texel.r;
  ivec3 cell = clamp(ivec3(local + 0.5), ivec3(0, 0, 0), ivec3(8, 8, 8));
  uint number = texelFetch(brume_cells, place * 9 + cell, 0).r;
  if (number == 0u) return texel.r;
  float density = brume_cell_density(number, local + 0.5 - vec3(cell), off);
  off = clamp(local + off, -0.5, 8.5) - local;
  return density;
}

// ---- Noise ----

// How much wisps count beside billows: in very thin smoke as much.
float brume_wisps(float density) { return 0.5 * (1.0 - density) * (1.0 - density); }

// What noise removes: density below it.
float brume_threshold(float density, vec2 noise) {
  vec2 limited = clamp(noise, 0.0, 1.0);
  return BRUME_EROSION * (1.0 - mix(limited.x, limited.y, brume_wisps(density)));
}

// Billows and wisps from a texel of the noise.
vec2 brume_billows(vec4 noise) {
  return vec2(1.35 * dot(noise, vec4(0.65, 0.1, 0.0, 0.25)) - 0.235,
              1.3 * dot(noise, vec4(0.25, 0.0, 0.75, 0.0)) - 0.1);
}

// What erosion leaves of a density, before holes. `rim`: the noise of the rims of holes, [-1, 1].
float brume_erode(float density, vec3 position, vec3 displacement, float pixel, out float rim) {
  vec3 p = position + displacement;
  vec4 noise = textureLod(brume_noise, p * BRUME_NOISE_FREQUENCY + BRUME_NOISE_OFFSET, 0.0);
  float weight = BRUME_DETAIL * clamp(1.5 - 16.0 * BRUME_DETAIL_FREQUENCY * pixel, 0.0, 1.0);
  vec2 detail = vec2(0.0, 0.0);
  if (weight > 0.0) {
    float level = log2(max(128.0 * BRUME_DETAIL_FREQUENCY * pixel, 1.0));
    vec3 at = p * BRUME_DETAIL_FREQUENCY + BRUME_DETAIL_OFFSET;
    vec2 texel = textureLod(brume_detail, at, level).rg;
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
float brume_after_hole(int hole, vec3 position, float rim) {
  vec4 origin = texelFetch(brume_holes, ivec2(0, hole), 0);   // w: radius
  vec4 forward = texelFetch(brume_holes, ivec2(1, hole), 0);  // w: depth
  vec3 from = position - origin.xyz;
  float z = dot(from, forward.xyz);
  vec3 across = from - z * forward.xyz;
  float radius = origin.w + rim * min(BRUME_HOLE_RIM, 0.25 * origin.w);
  if (z < 0.0 || z > forward.w || dot(across, across) >= 2.0001 * radius * radius) return 1.0;

  // Its opening at this depth, since the front has passed.
  vec4 right = texelFetch(brume_holes, ivec2(2, hole), 0);  // w: time since the shot
  vec4 up = texelFetch(brume_holes, ivec2(3, hole), 0);     // w: time to the far end
  vec4 times = texelFetch(brume_holes, ivec2(4, hole), 0);  // to expand, to stay open, to fade; w: shape
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
  vec4 uv = texelFetch(brume_holes, ivec2(5, hole), 0);
  vec2 at = clamp(vec2(0.5 + 0.5 * x / radius, 0.5 - 0.5 * y / radius), 0.0, 1.0);
  return 1.0 - strength * textureLod(brume_masks, mix(uv.xy, uv.zw, at), 0.0).r;
}

// Whether a line comes near a hole's axis.
bool brume_meets_hole(int hole, vec3 origin, vec3 direction) {
  vec4 from = texelFetch(brume_holes, ivec2(0, hole), 0);
  vec3 forward = texelFetch(brume_holes, ivec2(1, hole), 0).xyz;
  vec3 apart = origin - from.xyz;
  vec3 normal = cross(direction, forward);
  float reach = 1.5 * (from.w + min(BRUME_HOLE_RIM, 0.25 * from.w));
  float crossing = dot(normal, normal);
  if (crossing < 1e-4) return length(apart - dot(apart, forward) * forward) < reach + 0.02 * length(apart);
  float height = dot(apart, normal);
  return height * height < reach * reach * crossing;
}

// The holes that a line may meet, a bit each.
uvec4 brume_holes_of_ray(vec3 origin, vec3 direction) {
  uvec4 bits = uvec4(0u, 0u, 0u, 0u);
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

float brume_after_word(uint bits, int first, vec3 position, float rim) {
  float left = 1.0;
  int hole = first;
  while (bits != 0u && left > 0.0) {
    if ((bits & 1u) != 0u) left *= brume_after_hole(hole, position, rim);
    bits = bits >> 1;
    ++hole;
  }
  return left;
}

float brume_after_holes(uvec4 bits, vec3 position, float rim) {
  float left = brume_after_word(bits.x, 0, position, rim);
  if (bits.y != 0u) left *= brume_after_word(bits.y, 32, position, rim);
  if (bits.z != 0u) left *= brume_after_word(bits.z, 64, position, rim);
  if (bits.w != 0u) left *= brume_after_word(bits.w, 96, position, rim);
  return left;
}

// ---- Light, where the texture of light is filled ----

vec2 brume_light_pair(vec3 texel, int number) {
  vec3 size = BRUME_ATLAS_BRICKS * 10.0;
  int group = number / 2;
  vec3 at = vec3(texel.xy, texel.z + float(group) * size.z) / vec3(size.xy, size.z * BRUME_LIGHT_GROUPS);
  vec4 pair = textureLod(brume_light_volume, at, 0.0);
  return number - 2 * group == 0 ? pair.xy : pair.zw;
}

// The optical depth of the smoke between a point and light `number`, and in y how much of the light walls let through.
// `texel`: as brume_light has it.
vec2 brume_light_at(vec3 texel, int number) {
  vec2 pair = brume_light_pair(texel, number);
  return vec2(-4.0 * log(max(pair.x, 1.0 / 512.0)), pair.y);
}

// The sky: what passes the smoke, the mean over all directions, and in y that times the radiance of a sky of 0.75 +
// 0.375 y in the direction (x, y, z) where no wall hides it. Where the texture of light has no sky, what is usual in
// smoke under an open sky.
vec2 brume_sky_at(vec3 texel) {
  if (!BRUME_HAS_SKY) return vec2(0.3, 0.225);
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
vec3 brume_scattered(float depth, float cosine, vec3 albedo, float g, float escape) {
  float forward = max(g, 0.0);
  vec3 again = albedo * (1.0 - escape);
  vec3 decay = 1.05 * sqrt((1.0 - 0.951 * albedo) * (1.0 - forward * albedo));
  vec3 fraction = 0.788 * exp(-0.481 * forward) * again / (1.0 - 0.775 * again);
  float even = forward / (1.0 + exp(3.409 - 4.663 * forward));
  vec3 often = fraction * exp(-decay * depth) * brume_phase(even, cosine);
  return albedo * (exp(-depth) * brume_phase(g, cosine) + often);
}

// What smoke scatters of a sky of `ambient` and of the surfaces that hide it, which send `reflected`: a fifth, say, of
// the sum of the ambient light and of the suns' irradiance on level ground, divided by pi. `sky`: of brume_sky_at.
vec3 brume_scattered_sky(vec2 sky, vec3 ambient, vec3 reflected, vec3 albedo, float g) {
  float escape = max(sky.x, 0.002);
  vec3 arriving = ambient * sky.y + reflected * max(escape - sky.y / 0.75, 0.0);
  vec3 spread = pow(vec3(escape, escape, escape), sqrt((1.0 - albedo) * (1.0 - g * albedo)));
  return albedo * spread * arriving / escape;
}

// ---- Samples ----

// Density as it is drawn at a point of a brick: after noise and holes. `pixel`: width of a pixel there [m].
float brume_sample(ivec3 place, vec3 local, vec3 position, float pixel, uvec4 holes, out vec3 off) {
  float density = brume_local_density(place, local, off);
  bool cut = (holes.x | holes.y | holes.z | holes.w) != 0u;
  if (density <= 0.0 || (BRUME_EROSION <= 0.0 && !cut)) return density;
  // Without any noise there is no displacement.
  bool still = BRUME_EROSION <= 0.0 && BRUME_HOLE_RIM <= 0.0;
  if (still) return density * brume_after_holes(holes, position, 0.0);
  vec3 at = vec3(place) * BRUME_NOISE_POINTS + (local + 0.5) * BRUME_POINTS_PER_VOXEL + 0.5;
  at /= BRUME_ATLAS_BRICKS * BRUME_NOISE_POINTS;
  vec3 displacement = textureLod(brume_displacement, at, 0.0).xyz;
  float rim;
  density = brume_erode(density, position, displacement, pixel, rim);
  if (cut && density > 0.0) density *= brume_after_holes(holes, position, rim);
  return density;
}

// Density as it is drawn at any point; 1: as dense as smoke is before erosion. `pixel`: width of a pixel there [m];
// 0: with all detail.
float brume_density_at(vec3 position, float pixel) {
  vec3 voxel = (position - BRUME_ORIGIN) * BRUME_VOXELS_PER_METRE;
  ivec3 brick = ivec3(floor(voxel * 0.125));
  ivec3 place = brume_place(brick);
  if (place.x < 0) return 0.0;
  // Any line through the point meets the holes that contain it.
  uvec4 holes = brume_holes_of_ray(position, vec3(0.0, 1.0, 0.0));
  vec3 off;
  return brume_sample(place, voxel - vec3(brick) * 8.0, position, pixel, holes, off);
}

// The direction without zeros, to be divided by.
vec3 brume_divisor(vec3 direction) {
  return vec3(abs(direction.x) < 1e-6 ? 1e-6 : direction.x, abs(direction.y) < 1e-6 ? 1e-6 : direction.y,
              abs(direction.z) < 1e-6 ? 1e-6 : direction.z);
}

// The part of a ray in which there may be smoke, from and to [m]; empty where to <= from.
vec2 brume_span(vec3 origin, vec3 direction, float t_end) {
  vec3 d = brume_divisor(direction);
  vec3 a = (BRUME_LOW - origin) / d;
  vec3 b = (BRUME_HIGH - origin) / d;
  vec3 near = min(a, b);
  vec3 far = max(a, b);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, t_end)));
}

// How many steps lead out of the brick, at least one.
float brume_steps_out(vec3 voxel, ivec3 brick, vec3 direction, float step_voxels) {
  vec3 d = brume_divisor(direction);
  vec3 low = vec3(brick) * 8.0;
  vec3 a = (low - voxel) / d;
  vec3 b = (low + 8.0 - voxel) / d;
  vec3 far = max(a, b);
  return max(ceil(min(far.x, min(far.y, far.z)) / step_voxels), 1.0);
}

// What smoke lets through along a line, for shadows: by `steps` equal steps.
float brume_transmittance(vec3 from, vec3 to, int steps, float pixel) {
  float whole = length(to - from);
  if (whole <= 0.0) return 1.0;
  vec3 direction = (to - from) / whole;
  vec2 span = brume_span(from, direction, whole);
  if (span.y <= span.x) return 1.0;
  uvec4 holes = brume_holes_of_ray(from, direction);
  float ds = (span.y - span.x) / float(steps);
  float depth = 0.0;
  for (int i = 0; i < steps; ++i) {
    vec3 position = from + (span.x + (float(i) + 0.5) * ds) * direction;
    vec3 voxel = (position - BRUME_ORIGIN) * BRUME_VOXELS_PER_METRE;
    ivec3 brick = ivec3(floor(voxel * 0.125));
    ivec3 place = brume_place(brick);
    if (place.x < 0) continue;
    vec3 off;
    depth += brume_sample(place, voxel - vec3(brick) * 8.0, position, pixel, holes, off);
  }
  return exp(-BRUME_EXTINCTION * ds * depth);
}

#endif
