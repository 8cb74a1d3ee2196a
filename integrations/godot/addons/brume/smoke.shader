// Written by script/export-godot from smoke.shader.in and shaders/export: do not edit.
shader_type spatial;
render_mode unshaded, depth_draw_never, depth_test_disable, cull_disabled;

// ---- The textures and constants of brume_textures.h, which smoke.gd sets ----

uniform sampler3D brume_density;
uniform sampler3D brume_displacement;
uniform sampler3D brume_pages;
uniform sampler3D brume_cells;
uniform sampler2D brume_boundary;
uniform sampler2D brume_corners;
uniform sampler2D brume_holes;
uniform sampler2D brume_masks;
uniform sampler3D brume_noise;
uniform sampler3D brume_detail;
uniform sampler3D brume_light_volume;
uniform vec4 brume_constants_0;
uniform vec4 brume_constants_1;
uniform vec4 brume_constants_2;
uniform vec4 brume_constants_3;
uniform vec4 brume_constants_4;
uniform vec4 brume_constants_5;
uniform vec4 brume_constants_6;
uniform vec4 brume_constants_7;
uniform vec4 brume_constants_8;
uniform vec4 brume_constants_9;

// Numbers of 16 bits from two bytes each.
uvec4 brume_words(vec4 bytes) {
  uvec4 b = uvec4(bytes * 255.0 + vec4(0.5));
  return uvec4(b.x | (b.y << uint(8)), uint(0), uint(0), uint(0));
}

ivec3 brume_place(ivec3 brick) {
  ivec3 at = brick - ivec3(brume_constants_1.xyz);
  ivec3 size = ivec3(brume_constants_2.xyz);
  bool below = at.x < 0 || at.y < 0 || at.z < 0;
  if (below || at.x >= size.x || at.y >= size.y || at.z >= size.z) return ivec3(-1, 0, 0);
  int slot = int(brume_words(texelFetch(brume_pages, at, 0)).r) - 1;
  if (slot < 0) return ivec3(-1, 0, 0);
  ivec3 atlas = ivec3(brume_constants_3.xyz);
  return ivec3(slot % atlas.x, (slot / atlas.x) % atlas.y, slot / (atlas.x * atlas.y));
}

// ---- Cells that a surface runs through: smoke ends at the surface, not at a voxel ----

// On which side of a plane a point is, 1 or 0. The plane is an octahedral normal of 2 x 10 bits and an offset of 12
// bits from the middle of its cell; 0: there is none. Moves `off` to a voxel off the plane.
uint brume_side(uint plane, vec3 from_middle, inout vec3 off) {
  if (plane == uint(0)) return uint(0);
  vec2 e = vec2(float(plane & uint(1023)), float((plane >> uint(10)) & uint(1023))) * (2.0 / 1022.0) - vec2(1.0, 1.0);
  vec3 n = vec3(e.x, e.y, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  n = normalize(n);
  float height = dot(n, from_middle) - (float(plane >> uint(20)) * (2.0 / 4094.0) - 1.0);
  off += n * ((height > 0.0 ? 1.0 : -1.0) * max(1.0 - abs(height), 0.0));
  return height > 0.0 ? uint(1) : uint(0);
}

vec4 brume_bytes(uint word) {
  vec4 bytes = vec4(float(word & uint(255)), float((word >> uint(8)) & uint(255)), float((word >> uint(16)) & uint(255)), float(word >> uint(24)));
  return bytes * (1.0 / 255.0);
}

// Smoke of a cell at `f`, from its low corner, each coordinate in [0, 1]: between the densities of its eight corners,
// as they are on the point's side of its planes. `number` is above 0.
float brume_cell_density(uint number, vec3 f, inout vec3 off) {
  int cell = int(number) - 1;
  uvec4 boundary = floatBitsToUint(texelFetch(brume_boundary, ivec2(cell % 256, cell / 256), 0));
  uint sides = brume_side(boundary.x, f - 0.5, off);
  sides |= brume_side(boundary.y, f - 0.5, off) << uint(1);
  sides |= brume_side(boundary.z, f - 0.5, off) << uint(2);
  int set = int(boundary.w + sides);
  uvec2 corners = floatBitsToUint(texelFetch(brume_corners, ivec2(set % 1024, set / 1024), 0)).rg;
  vec4 layer = mix(brume_bytes(corners.x), brume_bytes(corners.y), f.z);
  vec2 row = mix(layer.xy, layer.zw, f.y);
  return mix(row.x, row.y, f.x);
}

// Density before noise and holes at a point of a brick, [0, 1]. `local`: from the brick's low corner [voxels]. `off`:
// how far from the point its light is to be read, so that none leaks through walls [voxels].
float brume_local_density(ivec3 place, vec3 local, out vec3 off) {
  off = vec3(0.0, 0.0, 0.0);
  vec3 uvw = (vec3(place) * 10.0 + local + 1.0) / (brume_constants_3.xyz * 10.0);
  vec2 texel = textureLod(brume_density, uvw, 0.0).rg;
  // A solid voxel beside it?
  if (texel.g > 0.998) return texel.r;
  ivec3 cell = clamp(ivec3(local + 0.5), ivec3(0, 0, 0), ivec3(8, 8, 8));
  uint number = floatBitsToUint(texelFetch(brume_cells, place * 9 + cell, 0)).r;
  if (number == uint(0)) return texel.r;
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
  return brume_constants_5.w * (1.0 - mix(limited.x, limited.y, brume_wisps(density)));
}

// Billows and wisps from a texel of the noise.
vec2 brume_billows(vec4 noise) {
  return vec2(1.35 * dot(noise, vec4(0.65, 0.1, 0.0, 0.25)) - 0.235,
              1.3 * dot(noise, vec4(0.25, 0.0, 0.75, 0.0)) - 0.1);
}

// What erosion leaves of a density, before holes. `rim`: the noise of the rims of holes, [-1, 1].
float brume_erode(float density, vec3 position, vec3 displacement, float pixel, out float rim) {
  vec3 p = position + displacement;
  vec4 noise = textureLod(brume_noise, p * brume_constants_6.w + brume_constants_6.xyz, 0.0);
  float weight = brume_constants_8.x * clamp(1.5 - 16.0 * brume_constants_7.w * pixel, 0.0, 1.0);
  vec2 detail = vec2(0.0, 0.0);
  if (weight > 0.0) {
    float level = log2(max(128.0 * brume_constants_7.w * pixel, 1.0));
    vec3 at = p * brume_constants_7.w + brume_constants_7.xyz;
    vec2 texel = textureLod(brume_detail, at, level).rg;
    detail = weight * 0.54 * (2.0 * texel - 1.0);
  }
  rim = clamp(2.0 * noise.g - 1.0 + 1.5 * detail.x, -1.0, 1.0);
  if (brume_constants_5.w <= 0.0) return density;
  float threshold = brume_threshold(density, brume_billows(noise) + detail);
  float above = 4.0 * (density - threshold) / max(1.0 - threshold, 0.05);
  above += brume_constants_8.x * (above - 0.5);
  return clamp(above, 0.0, 1.0) * (1.0 + brume_constants_5.w * (0.7 * noise.r + 0.3 * noise.g - 0.5));
}

// ---- Holes ----

// What a hole leaves of the smoke at a point. `rim`: noise, [-1, 1].
float brume_after_hole(int hole, vec3 position, float rim) {
  vec4 origin = texelFetch(brume_holes, ivec2(0, hole), 0);   // w: radius
  vec4 forward = texelFetch(brume_holes, ivec2(1, hole), 0);  // w: depth
  vec3 from = position - origin.xyz;
  float z = dot(from, forward.xyz);
  vec3 across = from - z * forward.xyz;
  float radius = origin.w + rim * min(brume_constants_8.y, 0.25 * origin.w);
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
  float reach = 1.5 * (from.w + min(brume_constants_8.y, 0.25 * from.w));
  float crossing = dot(normal, normal);
  if (crossing < 1e-4) return length(apart - dot(apart, forward) * forward) < reach + 0.02 * length(apart);
  float height = dot(apart, normal);
  return height * height < reach * reach * crossing;
}

// The holes that a line may meet, a bit each.
uvec4 brume_holes_of_ray(vec3 origin, vec3 direction) {
  uvec4 bits = uvec4(uint(0), uint(0), uint(0), uint(0));
  for (int hole = 0; hole < int(brume_constants_2.w); ++hole) {
    if (!brume_meets_hole(hole, origin, direction)) continue;
    uint bit = uint(1) << uint(hole & 31);
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
  while (bits != uint(0) && left > 0.0) {
    if ((bits & uint(1)) != uint(0)) left *= brume_after_hole(hole, position, rim);
    bits = bits >> uint(1);
    ++hole;
  }
  return left;
}

float brume_after_holes(uvec4 bits, vec3 position, float rim) {
  float left = brume_after_word(bits.x, 0, position, rim);
  if (bits.y != uint(0)) left *= brume_after_word(bits.y, 32, position, rim);
  if (bits.z != uint(0)) left *= brume_after_word(bits.z, 64, position, rim);
  if (bits.w != uint(0)) left *= brume_after_word(bits.w, 96, position, rim);
  return left;
}

// ---- Light, where the texture of light is filled ----

vec2 brume_light_pair(vec3 texel, int number) {
  vec3 size = brume_constants_3.xyz * 10.0;
  int group = number / 2;
  vec3 at = vec3(texel.xy, texel.z + float(group) * size.z) / vec3(size.xy, size.z * brume_constants_9.x);
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
  if (!(brume_constants_9.z > 0.5)) return vec2(0.3, 0.225);
  return brume_light_pair(texel, int(brume_constants_9.y));
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
  bool cut = (holes.x | holes.y | holes.z | holes.w) != uint(0);
  if (density <= 0.0 || (brume_constants_5.w <= 0.0 && !cut)) return density;
  // Without any noise there is no displacement.
  bool still = brume_constants_5.w <= 0.0 && brume_constants_8.y <= 0.0;
  if (still) return density * brume_after_holes(holes, position, 0.0);
  vec3 at = vec3(place) * brume_constants_8.z + (local + 0.5) * brume_constants_8.w + 0.5;
  at /= brume_constants_3.xyz * brume_constants_8.z;
  vec3 displacement = textureLod(brume_displacement, at, 0.0).xyz;
  float rim;
  density = brume_erode(density, position, displacement, pixel, rim);
  if (cut && density > 0.0) density *= brume_after_holes(holes, position, rim);
  return density;
}

// Density as it is drawn at any point; 1: as dense as smoke is before erosion. `pixel`: width of a pixel there [m];
// 0: with all detail.
float brume_density_at(vec3 position, float pixel) {
  vec3 voxel = (position - brume_constants_0.xyz) * brume_constants_0.w;
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
  vec3 a = (brume_constants_4.xyz - origin) / d;
  vec3 b = (brume_constants_5.xyz - origin) / d;
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
    vec3 voxel = (position - brume_constants_0.xyz) * brume_constants_0.w;
    ivec3 brick = ivec3(floor(voxel * 0.125));
    ivec3 place = brume_place(brick);
    if (place.x < 0) continue;
    vec3 off;
    depth += brume_sample(place, voxel - vec3(brick) * 8.0, position, pixel, holes, off);
  }
  return exp(-brume_constants_3.w * ds * depth);
}

// ---- Light of the scene's lights and of the sky ----

// A row for each: its position and range (0: a sun, and the direction towards it); colour times energy, and attenuation;
// a spot's direction and the cosine of its angle (-2: no spot); a spot's attenuation.
uniform sampler2D lights;
uniform vec4 ambient;                // radiance of the sky
uniform float bounce = 0.35;         // what walls and ground reflect of sky and suns
uniform vec4 albedo = vec4(0.86, 0.86, 0.86, 0.0);
uniform float anisotropy = 0.2;

vec3 brume_light(vec3 position, vec3 texel, vec3 direction) {
  vec2 sky = brume_sky_at(texel);
  vec3 sum = vec3(0.0, 0.0, 0.0);
  vec3 on_ground = vec3(0.0, 0.0, 0.0);
  for (int i = 0; i < int(brume_constants_9.y); ++i) {
    vec4 place = texelFetch(lights, ivec2(0, i), 0);
    vec4 colour = texelFetch(lights, ivec2(1, i), 0);
    vec2 reach = brume_light_at(texel, i);
    vec3 towards = place.xyz;
    vec3 arriving = 3.14159265 * reach.y * colour.rgb;
    if (place.w > 0.0) {
      float away = max(length(place.xyz - position), 0.001);
      towards = (place.xyz - position) / away;
      // As Godot dims its lights.
      arriving *= pow(max(1.0 - away / place.w, 0.0), colour.w);
      vec4 cone = texelFetch(lights, ivec2(2, i), 0);
      float rim = (1.0 - dot(-towards, cone.xyz)) / max(1.0 - cone.w, 0.0001);
      float within = max(1.0 - pow(clamp(rim, 0.0001, 1.0), texelFetch(lights, ivec2(3, i), 0).x), 0.0);
      arriving *= cone.w > -1.5 ? within : 1.0;
    } else {
      on_ground += arriving * max(towards.y, 0.0);
    }
    sum += arriving * brume_scattered(reach.x, dot(towards, direction), albedo.rgb, anisotropy, sky.x);
  }
  vec3 reflected = bounce * (ambient.rgb + on_ground / 3.14159265);
  return sum + brume_scattered_sky(sky, ambient.rgb, reflected, albedo.rgb, anisotropy);
}

vec4 brume_march(vec3 origin, vec3 direction, float t_end, float jitter, float pixel_width) {
  vec2 span = brume_span(origin, direction, t_end);
  vec4 gathered = vec4(0.0, 0.0, 0.0, 1.0);
  if (span.y <= span.x) return gathered;
  uvec4 holes = brume_holes_of_ray(origin, direction);
  float ds = (span.y - span.x) / ceil((span.y - span.x) / brume_constants_4.w);
  float t = span.x + jitter * ds;
  while (t < span.y) {
    vec3 position = origin + t * direction;
    vec3 voxel = (position - brume_constants_0.xyz) * brume_constants_0.w;
    ivec3 brick = ivec3(floor(voxel * 0.125));
    ivec3 place = brume_place(brick);
    if (place.x < 0) {
      t += ds * brume_steps_out(voxel, brick, direction, ds * brume_constants_0.w);
      continue;
    }
    vec3 local = voxel - vec3(brick) * 8.0;
    vec3 off;
    float density = brume_sample(place, local, position, t * pixel_width, holes, off);
    if (density > 0.0) {
      float passed = exp(-brume_constants_3.w * density * ds);
      vec3 texel = vec3(place) * 10.0 + local + off + 1.0;
      gathered.rgb += gathered.a * (1.0 - passed) * brume_light(position, texel, direction);
      gathered.a *= passed;
      if (gathered.a < 0.004) {
        gathered.a = 0.0;
        break;
      }
    }
    t += ds;
  }
  return gathered;
}

// ---- The whole screen, in front of what is opaque ----

void vertex() {
  POSITION = vec4(VERTEX.xy, 0.0, 1.0);
}

void fragment() {
  vec2 at = SCREEN_UV * 2.0 - 1.0;
  float depth = texture(DEPTH_TEXTURE, SCREEN_UV).r;
  vec4 surface = INV_PROJECTION_MATRIX * vec4(at, depth * 2.0 - 1.0, 1.0);
  vec3 in_view = surface.xyz / surface.w;
  vec3 direction = (CAMERA_MATRIX * vec4(normalize(in_view), 0.0)).xyz;
  // Interleaved gradient noise (Jimenez 2014).
  float jitter = fract(52.9829189 * fract(dot(FRAGCOORD.xy, vec2(0.06711056, 0.00583715))));
  float pixel_width = 2.0 / (PROJECTION_MATRIX[1][1] * VIEWPORT_SIZE.y);
  vec4 smoke = brume_march(CAMERA_MATRIX[3].xyz, direction, length(in_view), jitter, pixel_width);
  ALPHA = 1.0 - smoke.a;
  ALBEDO = smoke.rgb / max(ALPHA, 0.001);
}
