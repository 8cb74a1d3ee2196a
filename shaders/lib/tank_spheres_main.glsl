// The paths of tank_spheres.comp and tank_spheres_over.comp.
#include "lib/photon_gather.glsl"
#include "lib/sphere_trace.glsl"
#include "lib/tank_air.glsl"
#include "lib/tank_glass.glsl"
#include "lib/tank_picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const float kPi = 3.14159265;
/// Surfaces that a path meets at most: one that stays in the glass ends.
const uint kMostSegments = 64u;

/// Where a path is scattered.
struct Event {
  vec3 at, normal;
  vec3 albedo;
  uint id;       // of the sphere
  bool surface;  // else in a medium, without a normal
};

Event event_at(SphereRay ray) {
  const uint color = sphere_colors[ray.id - 1u];
  Event event;
  event.id = ray.id;
  event.albedo = albedo_of(color);
  event.surface = kOpaque || is_opaque(color);
  event.at = ray.origin + ray.t * ray.direction;
  event.normal = vec3(0.0);
  if (event.surface) {
    const vec4 sphere = spheres[ray.id - 1u];
    event.normal = normalize(event.at - sphere.xyz);
    event.at = sphere.xyz + sphere.w * event.normal;
  }
  return event;
}

/// Two unit vectors across a third (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
void axes_across(vec3 n, out vec3 x, out vec3 y) {
  const float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
  x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
  y = vec3(b, s + n.y * n.y * a, -n.y);
}

/// Radiance that an event scatters of one light, times the number of lights. Light comes straight: what the glass
/// bends is no part of it.
vec3 direct_light(Event event, inout SampleSource source) {
  if (tank.light_count == 0u) return vec3(0.0);
  const vec2 chosen = next_point(source), u = next_point(source);
  const uint count = tank.light_count;
  const TankLight light = tank_lights[min(uint(chosen.x * float(count)), count - 1u)];

  // A direction within the cone that the light fills; all of it has the same radiance.
  const vec3 apart = light.position - event.at;
  const float squared = dot(apart, apart);
  if (squared <= light.radius * light.radius) return vec3(0.0);
  const vec3 axis = apart * inversesqrt(squared);
  const float sine_squared = light.radius * light.radius / squared, widest = sqrt(1.0 - sine_squared);
  const float cosine = 1.0 - u.x * (sine_squared / (1.0 + widest)), sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  vec3 x, y;
  axes_across(axis, x, y);
  const vec3 to_light = cosine * axis + sine * (cos(2.0 * kPi * u.y) * x + sin(2.0 * kPi * u.y) * y);

  const float facing = event.surface ? dot(event.normal, to_light) * (1.0 / kPi) : 0.25 / kPi;
  if (facing <= 0.0) return vec3(0.0);
  // Up to the light's surface on that line.
  const float reach = sqrt(squared) * cosine - sqrt(max(0.0, light.radius * light.radius - squared * sine * sine));
  if (is_in_glass(event.at) || distance_to_glass(event.at, to_light, false) < reach) return vec3(0.0);
  SphereRay ray = SphereRay(event.at, to_light, event.surface ? event.id : 0u, next_seed(source), true, reach, 0u);
  trace_spheres(ray);
  if (ray.id != 0u) return vec3(0.0);
  // Radiance I / (pi r^2) times the cone's solid angle, 2 pi (1 - widest).
  return event.albedo * light.intensity * (facing * float(count) * 2.0 / (squared * (1.0 + widest)));
}

/// Radiance that an event scatters of the light that has come through the glass.
vec3 bent_light(Event event) {
  const float extinction = event.surface ? 0.0 : extinction_of(sphere_colors[event.id - 1u]);
  const vec3 gathered = gather_photons(tank.photons, event.at, event.id, spheres[event.id - 1u], extinction);
  return event.albedo * gathered * ((event.surface ? 1.0 : 0.25) / kPi);
}

vec3 scattered_direction(Event event, vec2 u) {
  const float turn = 2.0 * kPi * u.x;
  if (!event.surface) {
    const float z = 1.0 - 2.0 * u.y, r = sqrt(max(0.0, 1.0 - z * z));
    return vec3(r * cos(turn), r * sin(turn), z);
  }
  vec3 x, y;
  axes_across(event.normal, x, y);
  const float r = sqrt(u.y);
  return normalize(r * cos(turn) * x + r * sin(turn) * y + sqrt(1.0 - u.y) * event.normal);
}

Seen path_seen(vec3 origin, vec3 direction, float to_surface, inout SampleSource source) {
  vec3 weight = vec3(1.0);
  Seen seen = Seen(vec3(0.0), 0.0);
  bool in_glass = is_in_glass(origin);
  uint events = 0u, skip = 0u;
  for (uint segment = 0u; segment < kMostSegments; ++segment) {
    // What comes first: a sphere, the glass or the surface.
    const float to_glass = distance_to_glass(origin, direction, in_glass);
    SphereRay ray = SphereRay(origin, direction, skip, next_seed(source), false, min(to_glass, to_surface), 0u);
    trace_spheres(ray);
    if (events == 0u && !in_glass) weight *= add_fog(origin, direction, ray.t, weight, seen.radiance);

    if (ray.id == 0u && to_surface <= to_glass) {
      if (events == 0u)
        see_behind(direction, weight, seen);
      else
        seen.radiance += weight * tank.air.ambient;
      return seen;
    }
    // Where a bent path meets the surfaces is unknown.
    to_surface = kNoCrossing;
    if (ray.id == 0u) {
      origin += to_glass * direction;
      cross_glass(origin, next_point(source).x, direction, in_glass);
      skip = 0u;
      continue;
    }

    // A sphere.
    if (events == max(tank.bounces, 1u)) return seen;
    const Event event = event_at(ray);
    seen.radiance += weight * (direct_light(event, source) + bent_light(event));
    weight *= event.albedo;
    if (tank.bounces == 0u) {
      seen.radiance += weight * tank.air.ambient;
      return seen;
    }
    ++events;
    origin = event.at;
    direction = scattered_direction(event, next_point(source));
    skip = event.surface ? event.id : 0u;
  }
  return seen;
}

/// Where the ray of a pixel's middle first meets a sphere, as if there were no glass: the same for all samples.
float first_hit(ivec2 px, vec3 origin, vec3 direction, float to_surface) {
  SphereRay ray = SphereRay(origin, direction, 0u, pcg3d(uvec3(px, 0u)).x, false, to_surface, 0u);
  trace_spheres(ray);
  return ray.id == 0u ? kNoCrossing : ray.t;
}

#include "lib/tank_main.glsl"
