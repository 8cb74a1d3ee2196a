// Every numeric setting of a tank's scene in one place, as scene/options.hpp.
#pragma once

#include "scene/options.hpp"
#include "spheres/tank.hpp"

namespace brume::scene {

/// How a picture is made.
template <typename Options, typename Visitor>
void visit_tank_picture_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"samples", "", "paths of light of each pixel", 1, kMostSamples, "samples of a pixel"},
        o.samples);
  visit(OptionInfo{"bounces", "", "most scatterings of a path; 0: direct light and even ambient light only",
                   0, 16},
        o.bounces);
  visit(OptionInfo{"photons", "", "paths of light through the glass; 0: no light comes through it", 0,
                   1 << 22, "light through the glass"},
        o.photons);
  visit(OptionInfo{"dither", "", "noise of the rounding to 8 bits, in steps of them; 0 shows bands", 0, 1},
        o.dither);
}

/// Smallest radius of a sphere [voxels]; the largest one fits into the tank.
constexpr double kLeastRadius = 0.01;

/// Numbers of spheres::PackOptions, as scenes and `brume bake spheres` take them.
template <typename Options, typename Visitor>
void visit_pack_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"voxel", "m", "edge length of a voxel", 1e-6, 1e3, "edge of a voxel"}, o.voxel);
  visit(OptionInfo{"spheres", "", "spheres, if there is room for them", 0, spheres::kMostSpheres}, o.count);
  visit(OptionInfo{"distribution", "", "number of spheres of a radius ~ radius^-x", 0, 8,
                   "small ones over large"},
        o.distribution);
  visit(OptionInfo{"noise_size", "voxels", "size of the features of noise", 1, 4096, "size of features"},
        o.noise_size);
  visit(OptionInfo{"opacity", "", "what a voxel of a sphere blocks; 1: an opaque surface", 0, 1}, o.opacity);
}

template <typename Options, typename Visitor>
void visit_fog_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"extinction", "1/m", "extinction along rays of the camera", 0, 1e6, "density"},
        o.extinction);
  visit(OptionInfo{"color", "", "radiance of deep fog", 0, 1e6, "colour"}, o.color);
}

template <typename Options, typename Visitor>
void visit_tank_light_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"position", "m", "its middle", -kFarthestPoint, kFarthestPoint}, o.position_world);
  visit(OptionInfo{"color", "", "colour of its light", 0, 1, "colour"}, o.color);
  visit(OptionInfo{"intensity", "W/sr", "times `color`", 0, 1e9}, o.intensity);
  visit(OptionInfo{"radius", "m", "of the ball that shines; 0: a point", 0, 1e3}, o.radius);
}

template <typename Options, typename Visitor>
void visit_glass_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"position", "m", "its middle", -kFarthestPoint, kFarthestPoint}, o.position_world);
  visit(OptionInfo{"radii", "m", "half its axes", 1e-4, 1e4}, o.radii);
  visit(OptionInfo{"index", "", "index of refraction", 1, 4, "index of refraction"}, o.index);
}

}  // namespace brume::scene
