// A scene, as produced by the loaders: meshes, materials, objects, lights, a camera. Plain data;
// right-handed, Y up, metres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/box.hpp"
#include "core/role.hpp"
#include "image/image.hpp"
#include "scene/wrap.hpp"

namespace brume::scene {

constexpr std::uint32_t kNone = 0xffffffffu;

/// One corner of a triangle, in mesh space.
struct Vertex {
  glm::vec3 position{0};
  glm::vec3 normal{0, 1, 0};  ///< Unit length.
  /// xyz: unit length; w: +1 or -1, the bitangent is w * cross(normal, tangent).
  glm::vec4 tangent{1, 0, 0, 1};
  glm::vec2 uv{0};     ///< v points down the image: (0, 0) is the first texel of the first row.
  glm::vec4 color{1};  ///< Linear RGB and alpha in [0, 1]; multiplies the material's base colour and alpha.
};

/// Triangles, three indices each, counter-clockwise seen from outside. Every index is below vertices.size().
struct Mesh {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

struct Image {
  std::string name;
  image::Image8 pixels;
  Wraps wraps = {};
};

struct Material {
  std::string name;
  glm::vec3 base_color{1};                 ///< Linear; multiplies the image.
  glm::vec3 emission{0};                   ///< Linear radiance [W/(sr m^2)], up to a scene-specific scale.
  float roughness = 0.8f;                  ///< [0, 1], perceptual: alpha = roughness^2.
  float metallic = 0;                      ///< [0, 1].
  float alpha_cutoff = 0;                  ///< Texels with less alpha are cut out; 0: none.
  std::uint32_t base_color_image = kNone;  ///< sRGB colour, linear alpha. Index into Scene::images.
  std::uint32_t normal_image = kNone;      ///< Tangent-space normal map, +Y up.
  std::uint32_t roughness_image = kNone;   ///< G: roughness, B: metallic; multiply the factors.
  Role role = Role::wall;                  ///< Role of all that it covers, as far as it is not cut out.
  // Properties of panes (is_pane):
  float opacity = 1;  ///< [0, 1]: the fraction of a pane that has the base colour; the rest is clear.
  float transmission =
      1;  ///< [0, 1]: of that fraction, what lets light through and tints it; the rest scatters.
  bool blended = false;  ///< Alpha multiplies the opacity, and cuts nothing out of panes.
};

struct Object {
  std::string name;
  std::uint32_t mesh = kNone;      ///< Index into Scene::meshes.
  std::uint32_t material = kNone;  ///< Index into Scene::materials.
  glm::mat4 world_from_mesh{1};
  Role role = Role::wall;    ///< What it stops.
  bool see_through = false;  ///< Its material is glass, whatever its role.
  bool backdrop = false;     ///< Not part of the scene's bounds: a ground that reaches to the horizon.
};

/// Whether an object is drawn transparent, and lets light through: glass, and what its material makes glass,
/// unless it stops sight.
inline bool is_pane(const Object& object) {
  return object.role == Role::glass || (object.see_through && !stops_sight(object.role));
}

/// The alpha below which texels of an object are cut out; 0: none. Glass that its role makes a wall is drawn
/// opaque, and of panes that blend nothing is cut out.
inline float cutoff_of(const Object& object, const Material& material) {
  const bool is_filled = object.see_through && stops_sight(object.role);
  return is_filled || (is_pane(object) && material.blended) ? 0 : material.alpha_cutoff;
}

enum class LightKind : std::uint32_t { point, spot, directional };

struct Light {
  LightKind kind = LightKind::point;
  glm::vec3 position_world{0};
  glm::vec3 direction_world{0, -1, 0};  ///< Direction in which light travels. Unit length.
  /// Point and spot: radiant intensity [W/sr] per channel; irradiance at distance d is intensity / d^2.
  /// Directional: irradiance [W/m^2].
  glm::vec3 intensity{1};
  float cos_inner = 1, cos_outer = 0;  ///< Spot: full inside the inner cone, zero outside the outer.
  float least = 0.01f;                 ///< Point and spot: the irradiance at which it ends, > 0 [W/m^2].
};

/// A thin lens; the default is a pinhole.
struct Lens {
  float aperture = 0;        ///< Radius of its opening [m]; 0: all is sharp.
  float focus = 0;           ///< Distance along the view axis that is sharp [m]; 0: as far as the target.
  std::uint32_t blades = 0;  ///< Edges of the opening; below 3: it is round.
  std::filesystem::path opening =
      {};  ///< Image in the place of blades: white lets light through. Ready to open.
  bool operator==(const Lens&) const = default;
};

/// Tangents of the angles from the view axis to the four sides of a picture, to the right and upwards: that
/// of a symmetric picture has left = -right and down = -up. left < right, down < up.
struct Frustum {
  float left = -1, right = 1, down = -1, up = 1;
  bool operator==(const Frustum&) const = default;
};

struct Camera {
  glm::vec3 position_world{0, 1.7f, 5};
  glm::vec3 target_world{0, 1.7f, 0};
  float vertical_fov = 1.0472f;  ///< Radians, (0, pi).
  /// What is up in the picture, unit. A view along it is valid.
  glm::vec3 up_world{0, 1, 0};
  Lens lens = {};
  /// How long the shutter stays open, from the picture's time on [s]; 0: nothing is blurred by motion.
  float shutter = 0;
  /// In the place of vertical_fov, where the view axis is not in the middle or pixels are not square.
  std::optional<Frustum> frustum = {};
};

/// The distance along the view axis that is sharp [m], > 0.
float focus_distance(const Camera& camera);

/// Where a volume of the timeline is.
struct Volume {
  std::string name;
  Box<float> bounds_world;  ///< Around what can be dense.
  Box<float> core_world;    ///< Around most of it: what a camera frames.
};

struct Sphere {
  glm::vec3 centre_world{0};
  float radius = 0.5f;             ///< [m], > 0
  std::uint32_t material = kNone;  ///< Index into Scene::materials.
};

/// A volume that darkens or tints the surfaces that it covers: the unit cube [-0.5, 0.5]^3 of its own space.
struct Decal {
  std::string name;
  std::filesystem::path file;     ///< Ready to open.
  glm::mat4 world_from_decal{1};  ///< Affine.
  std::uint32_t carrier =
      kNone;  ///< Index into Scene::objects of the object that it moves with; kNone: none.
};

/// A source of particles, which start in the unit cube [-0.5, 0.5]^3 of its own space.
struct Emitter {
  std::string name;
  glm::mat4 world_from_emitter{1};  ///< Affine.
  std::uint32_t count = 0;          ///< Particles alive at a time.
};

/// Everything that a file places in the world. Any list may be empty; loaders fill what their format has.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Image> images;
  std::vector<Material> materials;
  std::vector<Object> objects;  ///< The objects of the world, without the grenade.
  std::vector<Light> lights;
  std::vector<Volume> volumes;
  std::vector<Sphere> spheres;
  std::vector<Decal> decals;
  std::vector<Emitter> emitters;
  std::optional<Object> grenade;             ///< Drawn in flight; its mesh is centred on its origin.
  std::optional<Camera> camera;              ///< The first camera of the file.
  std::vector<std::filesystem::path> files;  ///< Every file that load_scene read, itself first.
};

/// The bounding box of all objects but backdrops and of spheres, in world space; low > high when there is
/// none.
Box<float> level_bounds(const Scene& scene);
/// The same with volumes.
Box<float> world_bounds(const Scene& scene);

/// The scene's own camera, or one that looks at it obliquely from above and fits it into the middle four
/// fifths of an image of `aspect` = width / height.
Camera default_camera(const Scene& scene, float aspect = 16.0f / 9.0f);

/// A camera after a rotation about the vertical axis through a point [radians], counter-clockwise as seen
/// from above: as high and as far from the point, which stays at its pixel. An angle of 0 gives the same
/// camera.
Camera orbited(const Camera& camera, glm::vec3 centre_world, double radians);

/// The camera that looks in the same direction from the nearest place where all points stay inside an image
/// of `aspect` = width / height while it circles `centre_world` from 0 to an angle [radians]. The same camera
/// if they stay inside of its image.
Camera fitted_to_orbit(std::span<const glm::vec3> points_world, const Camera& camera, glm::vec3 centre_world,
                       double radians, float aspect);

/// All corners of objects but backdrops and of boxes around spheres.
std::vector<glm::vec3> level_corners(const Scene& scene);

}  // namespace brume::scene
