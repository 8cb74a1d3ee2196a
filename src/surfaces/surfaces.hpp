// The surfaces of a scene at a time, for rays.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planning/frame_input.hpp"
#include "scene/scene.hpp"
#include "surfaces/ray.hpp"
#include "surfaces/surface.hpp"
#include "trace/triangle_tree.hpp"

namespace brume::surfaces {

/// Where a ray meets a surface.
struct SurfaceHit {
  float t = 0;  ///< [m]
  glm::vec3 position{0};
  glm::vec3 geometric_normal{0};  ///< Normal of the triangle, unit, towards the ray's origin.
  Reflection reflection;
  glm::vec3 emission{0};
  bool is_pane = false;
  glm::vec3 passes{0};  ///< Fraction of light that goes straight on through a pane.
  std::uint32_t part = 0, triangle = 0;
};

/// A triangle that emits.
struct Emitter {
  glm::vec3 corner{0}, edge_u{0}, edge_v{0};
  glm::vec3 radiance{0};  ///< To both sides.
  float area = 0;         ///< [m^2]
};

class Surfaces {
 public:
  /// What a level shows of the scene, which must outlive it: at equal steps while the shutter is open, at
  /// least one, of which the further ones place what moves. `matte`: all surfaces follow Lambert's law,
  /// without highlights. Throws what TriangleTree::build fails with.
  Surfaces(const scene::Scene& scene, std::span<const planning::LevelState> levels, bool matte = false);

  /// The nearest surface or pane. What follows looks through panes.
  std::optional<SurfaceHit> hit(const Ray& ray) const;
  std::optional<SurfaceHit> opaque_hit(const Ray& ray) const;
  /// What panes let through of light along a ray up to its end.
  glm::vec3 through_panes(Ray ray) const;
  /// The nearest place of a surface on a ray, without its material.
  struct Place {
    glm::vec3 position{0};
    glm::vec3 normal{0};    ///< Unit, towards the ray's origin.
    bool is_front = false;  ///< The triangle is seen from outside.
  };
  std::optional<Place> place(const Ray& ray) const;
  /// Distance of the nearest surface on a ray; its end where there is none before [m].
  float distance(const Ray& ray) const;
  /// Whether a surface lies on a ray before its end.
  bool occluded(const Ray& ray) const;
  /// A ray's origin off a surface, on the side that `direction` leaves to.
  static glm::vec3 off_surface(const SurfaceHit& hit, const glm::vec3& direction);

  std::span<const Emitter> emitters() const { return emitters_; }
  /// Which of the emitters a hit surface is; nothing where it does not emit.
  std::optional<std::uint32_t> emitter_of(const SurfaceHit& hit) const;

 private:
  /// An object: one geometry of the tree.
  struct Part {
    const scene::Scene* scene = nullptr;
    const scene::Mesh* mesh = nullptr;
    const scene::Material* material = nullptr;
    bool is_pane = false;
    float alpha_cutoff = 0;
    // At equal steps of the shutter's time; a single step for what rests.
    std::vector<glm::mat4> world_from_mesh;
    std::vector<std::vector<glm::vec3>> corners_world;
    float handedness = 1;
    std::uint32_t first_emitter = scene::kNone;
  };
  void add(const scene::Object& object, std::vector<glm::mat4> world_from_mesh);
  void add_emitters(Part& part);
  struct Tree {
    trace::TriangleTree triangles;
    std::vector<std::uint32_t> parts;  // by geometry
  };
  void build(Tree& tree, bool of_panes);
  static std::optional<RTCRayHit> intersect(const Tree& tree, const Ray& ray);
  SurfaceHit shaded(const Tree& tree, const RTCRayHit& query, const Ray& ray) const;
  static void reject_cut_out(const RTCFilterFunctionNArguments* arguments);
  void shade(const Part& part, std::uint32_t triangle, const glm::vec2& at, const Ray& ray,
             SurfaceHit& hit) const;

  const scene::Scene& scene_;
  bool matte_;
  std::vector<std::unique_ptr<Part>> parts_;  // at fixed addresses
  std::vector<Emitter> emitters_;
  Tree opaque_, panes_;
};

}  // namespace brume::surfaces
