// Marches rays from the eye through the media of a frame.
#pragma once

#include <map>

#include "passes/media_resources.hpp"
#include "shared/resolve.h"

namespace brume::passes {

/// Tiles of scale x scale pixels that share a ray.
struct MarchTiles {
  gpu::Buffer ends;  ///< shared::RayEnds, rows in order.
  gpu::Image near;   ///< Half floats, a texel per tile: the smoke up to the tile's nearest surface.
  gpu::Image far;    ///< The same up to its farthest.
  gpu::Buffer list;  ///< shared::MarchList and the indices of the tiles whose pixels are marched one by one.
  std::uint32_t scale;
  /// For frames up to `size_px`. `scale` is 2 or 4. Throws resource_limit.
  MarchTiles(gpu::Context& context, glm::uvec2 size_px, std::uint32_t scale);
};

/// Kinds of rays that frames march: those of pixels; those of tiles, and of the pixels of listed tiles.
enum class MarchRays { of_pixels, of_tiles, all };

class MarchPass {
 public:
  struct Options {
    bool count_samples = false;  ///< record adds the texture samples taken to the first word of `counters`.
    /// The same, and the steps of each pixel's ray behind that word, rows in order: one word plus one per
    /// pixel.
    bool count_steps = false;
    bool brute_force_holes = false;  ///< Every sample tests every hole: the baseline of the clusters.
    /// `counters` receives, behind its first word, the entry of each pixel's ray into the media, rows in
    /// order: the bits of the distance [m] at which the transmittance falls to shared::kEntryTransmittance,
    /// infinity where it does not. Instead of the counts above. The pixels of a tile have the entry of its
    /// ray.
    bool record_entries = false;
    /// The media that the constructor reserves, with all kinds of rays; 0: none.
    std::uint32_t media = shared::kMediumSmoke;
  };
  MarchPass(gpu::Context& context, const Options& options);
  /// Compiles what rays through a set of media need (shared/media.h), once: each pipeline takes a driver up
  /// to a tenth of a second. Outside of a recording.
  void reserve(std::uint32_t media, MarchRays rays = MarchRays::all);

  struct Inputs {
    const gpu::Buffer& frame;
    MediaResources media;  ///< Their set is reserved, with the kind of rays.
    MediaLight light;
    const gpu::Image& noise;
    const gpu::Image& detail;  ///< A tile of the noise's octaves below the coarse one.
    const gpu::Image& depth;
    const gpu::Image& blue_noise;
    glm::uvec2 size_px;  ///< The frame's size; images and tiles may be larger.
  };
  /// Marches the ray of each pixel. Writes premultiplied radiance and transmittance (half floats) to `smoke`.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const gpu::Image& smoke,
              const gpu::Buffer& counters) const;
  /// Marches one ray per tile, and writes the same for its nearest and its farthest surface.
  void record_tiles(gpu::Recorder& recorder, const Inputs& inputs, const MarchTiles& tiles,
                    const gpu::Buffer& counters) const;
  /// Marches the pixels of the listed tiles, into `smoke`.
  void record_list(gpu::Recorder& recorder, const Inputs& inputs, const MarchTiles& tiles,
                   const gpu::Image& smoke, const gpu::Buffer& counters) const;

 private:
  /// Resources that differ between the three kinds of rays. Unused ones get any resource of the same type.
  struct Rays {
    const gpu::Buffer& ends;
    const gpu::Buffer& list;
    const gpu::Image& near;
    const gpu::Image& smoke;
  };
  void bind(gpu::Recorder& recorder, const gpu::ComputePipeline& pipeline, const Inputs& inputs,
            const Rays& rays, const gpu::Buffer& counters) const;

  /// What a pipeline is specialized for.
  struct Variant {
    std::uint32_t rays, holes, media;
    auto operator<=>(const Variant&) const = default;
  };
  void dispatch(gpu::Recorder& recorder, std::uint32_t kind, const Inputs& inputs, const Rays& rays,
                glm::uvec2 ray_count, const gpu::Buffer& counters) const;
  std::uint32_t with_holes(std::uint32_t media) const;
  std::uint32_t holes_of(const Inputs& inputs) const;

  gpu::Context& context_;
  Options options_;
  std::map<Variant, gpu::ComputePipeline> pipelines_;
  gpu::Sampler linear_, repeat_, repeat_mips_, nearest_;
};

}  // namespace brume::passes
