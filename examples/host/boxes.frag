// Light from the sky, and from a light without a shadow.
#version 460
layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 colour;
layout(location = 2) in vec3 p_world;
layout(location = 0) out vec4 radiance;

const vec3 kLight = vec3(5.0, 2.0, 3.5), kIntensity = vec3(60.0, 40.0, 22.0);

void main() {
  const vec3 sky = vec3(0.04, 0.055, 0.09) * (0.75 + 0.25 * normal.y), to_light = kLight - p_world;
  const float cosine = max(dot(normal, normalize(to_light)), 0.0);
  radiance = vec4(colour * (sky + kIntensity * cosine / (3.1416 * dot(to_light, to_light))), 1.0);
}
