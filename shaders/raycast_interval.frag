// An interval surface: where rays enter or leave the box, in object space; 1 in alpha where they do.
#version 460

layout(location = 0) in vec3 p_voxel;
layout(location = 0) out vec4 position;

void main() { position = vec4(p_voxel, 1.0); }
