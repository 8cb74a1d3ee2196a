// A tank of spheres as shaders read it. All lengths are in voxels of the tank, from its low corner: light that
// falls off with the squared distance [m] is scaled to match.
#ifndef BRUME_TANK_H
#define BRUME_TANK_H
#include "shared/optics.h"
#include "shared/photons.h"
#include "shared/shim.h"
#include "shared/spheres.h"
SHARED_BEGIN

SHARED_BINDING(kBindTank, 66u);
SHARED_BINDING(kBindSpheres, 67u);
SHARED_BINDING(kBindSphereColors, 68u);
SHARED_BINDING(kBindSphereBricks, 69u);
SHARED_BINDING(kBindSphereList, 70u);
SHARED_BINDING(kBindVoxelColors, 71u);
SHARED_BINDING(kBindVoxelIds, 72u);
SHARED_BINDING(kBindVoxelLight, 73u);
SHARED_BINDING(kBindTankLights, 74u);
SHARED_BINDING(kBindWideVoxelIds, 75u);
SHARED_BINDING(kBindTankSurfaces, 100u);

/// A ball that shines evenly in all directions.
struct TankLight {
  vec3 position;
  float radius;    // 0: a point
  vec3 intensity;  // [W/sr] times the squared voxels of a metre
  float padding SHARED_ZERO;
};
SHARED_SIZE(TankLight, 32);

SHARED_CONST uint kLensRemap = 0u;
SHARED_CONST uint kLensRejection = 1u;

/// A camera with a lens. The ray of a pixel leads from a point of the lens to where the ray from its middle, along
/// forward + x right + y up with x and y in [-1, 1], meets the plane that is sharp.
struct TankCamera {
  vec3 eye;
  float aperture;  // radius of the lens
  vec3 forward;    // unit
  float focus;     // distance of the plane that is sharp, along `forward`
  vec3 right;      // scaled by tan(half the horizontal field of view)
  uint blades;     // as lens_point
  vec3 up;         // scaled by tan(half the vertical field of view)
  uint lens_points;  // kLensRemap or kLensRejection
  vec2 shift;        // of all rays, in units of right and up, as Camera::shift
  vec2 padding SHARED_ZERO;
};
SHARED_SIZE(TankCamera, 80);

/// What surrounds the tank and fills it.
struct TankAir {
  vec3 zenith;   // radiance that rays of the camera see above,
  float padding SHARED_ZERO;
  vec3 horizon;  // and below
  float padding_1 SHARED_ZERO;
  vec3 ambient;  // radiance that scattered rays see
  float padding_2 SHARED_ZERO;
  vec3 fog_color;
  float fog_extinction;
};
SHARED_SIZE(TankAir, 64);

struct TankConstants {
  TankCamera camera;
  TankAir air;
  Glass glass;
  ivec3 size;  // of the tank
  uint light_count;
  ivec3 bricks;
  uint bounces;  // most scattering events of a path
  PhotonGrid photons;
  uvec2 size_px;
  float surface_near;  // in a frame: its depth d is that of a surface at surface_near / d along the camera's axis
  uint in_middle;      // 1: rays of the camera pass through the middles of pixels, 0: anywhere through them
};
SHARED_SIZE(TankConstants, 232);

/// What is found for each voxel.
struct SphereVoxelsParams {
  ivec3 size;    // of the tank
  uint painted;  // 1: colours
  uint has_ids;  // 1: ids
};
SHARED_SIZE(SphereVoxelsParams, 20);

/// Samples of each pixel that a dispatch adds, from a row of the picture on.
struct TankSamples {
  uint first;  // before them; 0 begins a picture
  uint count;
  uint first_row;
  uint index;  // of the picture's first sample: pictures of other ones have other noise
};
SHARED_SIZE(TankSamples, 16);

SHARED_END
#endif
