// What a scene without a timeline is shown with: a camera, light, ground and smoke that fit the scene,
// whatever its size and unit.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "scene/timeline.hpp"

namespace brume::scenario {

/// What replaces the choices of prepare_first_view.
struct FirstViewOptions {
  float aspect = 16.0f / 9.0f;                 ///< Width / height of the image.
  std::optional<float> scale;                  ///< Metres per unit of the file, > 0.
  std::optional<float> voxel;                  ///< [m]
  std::optional<float> smoke_size;             ///< Diameter of the grown smoke in open air [m].
  std::vector<scene::SmokeEvent> smokes = {};  ///< In metres, after scaling.
  bool has_smoke = true;                       ///< Whether there is smoke without `smokes`.
  bool has_ground = true;                      ///< Whether there may be a ground to the horizon.
  /// Replaces the camera of the result [m]; the smoke is placed for it.
  std::optional<scene::Camera> camera = {};
  std::optional<scene::SunOptions> sun = {};
  /// Without an exposure, it is measured (Scenario::measure_exposure).
  scene::PictureSettings<std::optional> picture = {};
  // For a volume alone, as in scene::VolumeOptions.
  std::string density = {}, heat = {};
  std::optional<float> kelvin = {}, volume_frame_rate = {};
  std::vector<scene::OpacityPoint> opacity = {};
  scene::ColorMap color_map = {};
  std::optional<glm::vec2> range = {};
};

/// Metres per unit that bring a scene's largest extent into [1 m, 4 km], by a power of ten; 1 where it is
/// there. Of a glTF file, whose unit is a metre, from 0.25 m on: smaller, its smoke would have too few
/// voxels.
float fitting_scale(float extent, const std::filesystem::path& file = {});

/// Scales a scene about the origin: objects, lights (so that they light it alike), camera and lists of
/// places.
void scale_scene(scene::Scene& scene, float factor);

/// Moves a scene: objects, lights, camera and lists of places.
void move_scene(scene::Scene& scene, glm::vec3 by);

/// Makes a loaded scene the level of a timeline: applies Timeline::origin, scale, ground and sun,
/// and lights a scene without any light by SunOptions{}.
void apply_level_options(const scene::Timeline& timeline, scene::Scene& scene);

/// Completes a loaded scene and returns its timeline. Saved and loaded again, the timeline gives the same
/// level; only the camera is not part of it.
///
/// - scale: as given, or fitting_scale with a warning;
/// - origin: moved to the middle of a scene that lies farther away than events may, with a warning;
/// - camera: the scene's own, or one that fits it into four fifths of the image;
/// - ground: below a scene without a camera, to the horizon (Object::backdrop);
/// - light: a sun and a day sky where the scene has no light, a dusk sky where it has no sun but other
/// lights;
/// - smoke: on the floor before what is in the middle of the view (first_smoke.hpp), about a fifth of the
/// image's width, dense and bright.
///
/// `path` is the scene's file.
scene::Timeline prepare_first_view(const std::filesystem::path& path, scene::Scene& scene,
                                   const FirstViewOptions& options);

}  // namespace brume::scenario
