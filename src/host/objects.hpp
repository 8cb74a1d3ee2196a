// The objects behind the handles of brume_assets.h and brume_vulkan.h.
#pragma once

#include <brume/brume_vulkan.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "api/objects.hpp"
#include "gpu/host_recording.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"
#include "volumes/volumes.hpp"

namespace brume::host {

/// A host's device, and the frame that its renderers recorded last.
struct DeviceData {
  explicit DeviceData(const gpu::HostDevice& given) : host(given), context(given) {
    host.enabled_features = nullptr;
  }
  gpu::HostDevice host;  ///< Without `enabled_features`, which were the caller's.
  gpu::Context context;
  /// Held while a renderer is made, records or ends: the context is used by one thread at a time.
  std::mutex mutex;
  std::uint64_t frame = 0, completed = 0;
  std::atomic<int> renderers = 0;
};

/// Whether the device can blend over a picture of a format of Vulkan 1.0.
bool can_blend(const gpu::Context& context, VkFormat format);

/// A file of grids or a sequence of them.
struct VolumeData {
  scene::VolumeOptions options;               ///< Without place and look, which each frame gives.
  std::shared_ptr<volumes::Volumes> volumes;  ///< This one alone.
  volumes::VolumeWait wait = volumes::VolumeWait::never;
  std::mutex mutex;  ///< Held while frames are chosen.
};

/// A volume of baked occlusion.
struct DecalData {
  std::shared_ptr<const grids::DenseVolume> volume;  ///< Channels: what faces up, down.
  glm::dmat4 space_from_box{1};  ///< From the box of its voxels to the space that the host places.
  glm::vec3 middle{0};           ///< As planning::DecalInput.
  float radius = 0;
};

}  // namespace brume::host

struct brume_device : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::device;
  brume_device(std::shared_ptr<brume::api::Settings> context_settings, const brume::gpu::HostDevice& host)
      : Handle(kKind, std::move(context_settings)), data(std::make_shared<brume::host::DeviceData>(host)) {}

  std::shared_ptr<brume::host::DeviceData> data;
};

struct brume_volume : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::volume;
  brume_volume(std::shared_ptr<brume::api::Settings> context_settings,
               std::shared_ptr<brume::host::VolumeData> volume_data)
      : Handle(kKind, std::move(context_settings)), data(std::move(volume_data)) {}

  std::shared_ptr<brume::host::VolumeData> data;
};

struct brume_decal : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::decal;
  brume_decal(std::shared_ptr<brume::api::Settings> context_settings, brume::host::DecalData decal_data)
      : Handle(kKind, std::move(context_settings)),
        data(std::make_shared<const brume::host::DecalData>(std::move(decal_data))) {}

  const std::shared_ptr<const brume::host::DecalData> data;  ///< No other holds it.
};

struct brume_tank : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::tank;
  brume_tank(std::shared_ptr<brume::api::Settings> context_settings,
             std::shared_ptr<const brume::scene::TankContent> tank_content,
             std::shared_ptr<const brume::scene::TankIllumination> illumination)
      : Handle(kKind, std::move(context_settings)),
        content(std::move(tank_content)),
        light(std::move(illumination)) {}

  const std::shared_ptr<const brume::scene::TankContent> content;
  std::shared_ptr<const brume::scene::TankIllumination> light;
};

struct brume_renderer : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::renderer;
  brume_renderer(std::shared_ptr<brume::api::Settings> context_settings,
                 std::shared_ptr<brume::host::DeviceData> device_data, brume::scene::Scene renderer_scene,
                 std::shared_ptr<const brume::smoke::MaskAtlas> mask_atlas,
                 const brume::render::RendererOptions& renderer_options, bool timed);
  ~brume_renderer();
  /// What frames have left is gone; the next one makes the renderer again.
  void drop() {
    renderer.reset();
    has_frame = false;
  }

  std::shared_ptr<brume::host::DeviceData> device;
  brume::scene::Scene scene;
  /// What `scene` has and `renderer` has not yet.
  enum class Change { none, lights, triangles } change = Change::none;
  std::shared_ptr<const brume::smoke::MaskAtlas> masks;
  brume::render::RendererOptions options;
  brume::gpu::HostRecording recording;
  brume::planning::FrameInput input;  ///< What the last frame showed.
  /// The decals whose volumes are in `input.slices`, while they exist.
  std::vector<std::weak_ptr<const brume::host::DecalData>> sliced;
  /// From the first frame on, which uploads.
  std::optional<brume::render::Renderer> renderer;
  bool has_frame = false;          ///< Whether the last frame was recorded.
  std::uint64_t shown_volume = 0;  ///< SparseVolume::id of the last frame's smoke; 0: none.
};
