// Emitting surfaces so small that the rays of a probe (light_cells.hpp) would meet them by chance: they get
// rays of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/indirect_light.h"
#include "surfaces/surfaces.hpp"

namespace brume::surfaces {

/// Pieces of emitting triangles that share corners, as far as a piece reaches no farther than a few cells
/// from its middle.
class SmallEmitters {
 public:
  /// Finds the pieces among the emitters of `surfaces`, which must outlive it. `cell_size` [m].
  SmallEmitters(const Surfaces& surfaces, float cell_size);

  bool empty() const { return pieces_.empty(); }
  /// Whether a hit surface is part of a piece.
  bool contains(const SurfaceHit& hit) const;
  /// Places on the pieces.
  std::span<const shared::EmitterSample> samples() const { return samples_; }
  /// Rays from a probe to samples, chosen by how much light they may send, kEmitterRays of them. Their sum is
  /// an estimate of the light that arrives directly; neighbouring probes of other phases have others.
  void find_rays(glm::vec3 centre_world, std::uint32_t phase, std::span<shared::EmitterRay> rays) const;

 private:
  struct Piece {
    glm::vec3 middle{0};
    float radius = 0, area = 0, power = 0;  ///< Radiance times area, as brightness.
    std::uint32_t first_sample = 0, samples = 0;
  };
  /// Samples of which a ray meets any, each with the same share of the area.
  struct Choice {
    std::uint32_t first_sample = 0, count = 0;
    double weight = 0;
    float share = 0;
  };
  void add_piece(std::span<const std::uint32_t> triangles);
  void add_samples(std::span<const std::uint32_t> triangles, Piece& piece);
  template <typename Use>
  void for_each_choice(glm::vec3 centre_world, Use use) const;
  shared::EmitterRay ray_to(std::uint32_t sample, glm::vec3 centre_world, float area) const;

  const Surfaces& surfaces_;
  float cell_size_;
  std::vector<Piece> pieces_;
  std::vector<bool> is_small_;  ///< By emitter.
  std::vector<shared::EmitterSample> samples_;
};

}  // namespace brume::surfaces
