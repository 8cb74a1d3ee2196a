// What the surfaces of a scene at a time consist of, and what a ray finds where it meets one.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planning/frame_input.hpp"
#include "reference/majorants.hpp"
#include "reference/surface.hpp"
#include "scene/scene.hpp"

namespace brume::reference {

/// Where a ray meets a surface.
struct SurfaceHit {
  float t = 0;  ///< [m]
  glm::vec3 position{0};
  glm::vec3 geometric_normal{0};  ///< Of the triangle, unit, towards the ray's origin.
  Reflection reflection;
  glm::vec3 emission{0};
  std::uint32_t part = 0, triangle = 0;
};

/// A triangle that emits.
struct Emitter {
  glm::vec3 corner{0}, edge_u{0}, edge_v{0};
  glm::vec3 radiance{0};  ///< To both sides.
  float area = 0;         ///< [m^2]
};

class SurfaceParts {
 public:
  /// What a level shows of the scene, which must outlive it: at equal steps while the shutter is open, at
  /// least one, of which the further ones place what moves. `matte`: all surfaces follow Lambert's law,
  /// without highlights.
  SurfaceParts(const scene::Scene& scene, std::span<const planning::LevelState> levels, bool matte = false);

  /// An object.
  struct Part {
    const scene::Scene* scene = nullptr;
    const scene::Mesh* mesh = nullptr;
    const scene::Material* material = nullptr;
    // At equal steps of the shutter's time; one of what rests.
    std::vector<glm::mat4> world_from_mesh;
    std::vector<std::vector<glm::vec3>> corners_world;
    float handedness = 1;
    std::uint32_t first_emitter = scene::kNone;

    bool has_holes() const { return material->alpha_cutoff > 0; }
    /// Whether its material is cut out at barycentric coordinates of a triangle.
    bool is_cut_out(std::uint32_t triangle, const glm::vec2& at) const;
  };
  std::span<const std::unique_ptr<Part>> all() const { return parts_; }

  /// Fills in place, normal and material of a hit, by its `part` and `triangle`.
  void shade(const glm::vec2& at, const Ray& ray, SurfaceHit& hit) const;

  std::span<const Emitter> emitters() const { return emitters_; }
  /// Which of the emitters a hit surface is; nothing where it does not emit.
  std::optional<std::uint32_t> emitter_of(const SurfaceHit& hit) const;

 private:
  void add(const scene::Object& object, std::vector<glm::mat4> world_from_mesh);
  void add_emitters(Part& part);

  const scene::Scene& scene_;
  bool matte_;
  std::vector<std::unique_ptr<Part>> parts_;  // at fixed addresses
  std::vector<Emitter> emitters_;
};

}  // namespace brume::reference
