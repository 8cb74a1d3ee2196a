// Pictures of volumes that no single device holds (sort-last): each renderer has a part (volume::Parts), and
// what they find is combined between the steps of a frame, by whatever connects them.
//
// Optical depths along rays of light add up, so that each part finds the light of the whole. Along a ray of
// the eye all parts take the same steps, of which each adds those in its own bricks: radiance and
// transmittance of the whole are the parts', composited front to back.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "image/image.hpp"
#include "render/renderer.hpp"

namespace brume::film {

/// The largest optical depth that is stored: beyond, nothing of the light remains.
inline constexpr float kMostDepth = 60;

/// Adds the depths of another part, up to kMostDepth.
void add_depths(std::span<float> depths, std::span<const float> more);

/// Radiance and transmittance of a pixel, as floats.
using Pixels = std::vector<glm::vec4>;
/// Adds what is behind: pixels of the same size.
void composite_behind(Pixels& front, const Pixels& behind);

/// A frame is the three steps, in this order, each once.
class VolumePartRenderer {
 public:
  /// `context`, `runner` and `scene` must outlive it. Throws resource_limit, and usage for a scene with
  /// objects, on which only the whole casts shadows.
  VolumePartRenderer(gpu::Context& context, gpu::CommandRunner& runner, const scene::Scene& scene,
                     glm::uvec2 size_px);

  /// Uploads the part, and finds the optical depths of it alone, to be summed over all parts. Only the sun
  /// and the sky may light the volume: throws usage for a frame with other lights, heat, masks, colours,
  /// dense volumes or more than one. Throws as Renderer::plan.
  std::vector<float> find_depths(const planning::FrameInput& input);
  /// Finds the light by the depths of the whole, and marches: what rays meet in this part.
  Pixels march(std::span<const float> depths);
  /// The picture by the pixels of the whole.
  image::Image8 picture(const Pixels& pixels);

  /// Bytes of the part's bricks on the device.
  std::uint64_t volume_bytes() const { return volume_bytes_; }

 private:
  std::vector<std::uint16_t> halves_of(const gpu::Image& image);
  void set_halves(const gpu::Image& image, std::span<const std::uint16_t> halves);

  gpu::Context& context_;
  gpu::CommandRunner& runner_;
  render::Renderer renderer_;
  planning::FrameInput input_;  ///< The plan refers to it.
  std::optional<planning::FramePlan> plan_;
  std::uint64_t volume_bytes_ = 0;
};

}  // namespace brume::film
