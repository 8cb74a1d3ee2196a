// The material where there is no surface.
#version 460

layout(location = 0) out vec4 albedo_roughness;
layout(location = 1) out vec4 normal_metallic;
layout(location = 2) out vec4 emission;

void main() { albedo_roughness = normal_metallic = emission = vec4(0.0); }
