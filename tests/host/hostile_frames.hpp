// Calls the functions of brume_vulkan.h as Hostile calls those of brume.h, within the frames of a host.
#pragma once

#include <brume/brume_vulkan.h>

#include "gpu/host_recording.hpp"
#include "tests/api/hostile_calls.hpp"
#include "tests/gpu/host_application.hpp"

namespace brume::host {

class HostileFrames : public api::Hostile {
 public:
  /// Resolutions of the march that frames have: each takes pipelines of its own, which take long to compile.
  enum class Scales { full, all };
  /// `file`: a volume that can be loaded.
  HostileFrames(unsigned seed, std::string file, Scales scales);
  ~HostileFrames();

  /// Makes frames with several calls each, of both headers.
  void run_frames(int frames);
  std::vector<std::string> take_messages() { return host_.take_messages(); }

 private:
  static constexpr glm::uvec2 kSize{16, 9};
  using Step = void (HostileFrames::*)();

  void begin_frame(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed);
  void device();
  void renderer_create();
  void renderer_change();
  void renderer_read();
  void volume_create();
  void volume_read();
  void decal_create();
  void tank_create();
  void tank_change();
  void record();
  void compile();
  void host_defaults();

  /// Mostly in a range.
  float within(float low, float high);
  /// A number that is refused: `most` is allowed.
  std::uint32_t above(std::uint32_t most);
  template <typename Number>
  void spoil(Number& number, double probability = 0.01);
  brume_light light();
  brume_shown_volume shown_volume();
  brume_shown_decal shown_decal();
  brume_normals normals();
  brume_shown_tank shown_tank();
  void spoil(brume_frame_params& params);
  /// Parameters of the next frame, some of them spoiled.
  brume_frame_params frame_params();

  gpu::HostApplication host_{1};
  gpu::Context gpu_;
  gpu::HostRecording recording_;
  gpu::Image depth_, picture_, normals_;
  std::string file_;
  Scales scales_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  std::uint64_t number_ = 0, completed_ = 0;
  bool has_drawn_ = false;  ///< Over the picture, in this frame.
  std::vector<brume_light> lights_;
  std::vector<brume_shown_volume> shown_;
  std::vector<brume_shown_decal> shown_decals_;
  std::vector<brume_shown_tank> shown_tanks_;
  api::Pool<brume_device> devices_;
  api::Pool<brume_renderer> renderers_;
  api::Pool<brume_volume> volumes_;
  api::Pool<brume_decal> decals_;
  api::Pool<brume_tank> tanks_;
};

}  // namespace brume::host
