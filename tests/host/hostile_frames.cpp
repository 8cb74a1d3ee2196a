#include "tests/host/hostile_frames.hpp"

#include <cmath>

namespace brume::host {
namespace {

gpu::ImageInfo image_of(VkFormat format, glm::uvec2 size, VkImageUsageFlags usage) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size, 1};
  info.usage = usage;
  return info;
}

}  // namespace

HostileFrames::HostileFrames(unsigned seed, std::string file, Scales scales)
    : Hostile(seed),
      gpu_(host_.device()),
      recording_(gpu_),
      depth_(gpu_, image_of(VK_FORMAT_R32_SFLOAT, kSize,
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                VK_IMAGE_USAGE_TRANSFER_DST_BIT)),
      picture_(gpu_, image_of(VK_FORMAT_R16G16B16A16_SFLOAT, kSize, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      normals_(gpu_, image_of(VK_FORMAT_R16G16B16A16_SFLOAT, kSize,
                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT)),
      file_(std::move(file)),
      scales_(scales) {}

HostileFrames::~HostileFrames() {
  host_.wait();
  for (brume_volume* volume : volumes_) EXPECT_EQ(brume_volume_destroy(volume), BRUME_OK);
  for (brume_decal* decal : decals_) EXPECT_EQ(brume_decal_destroy(decal), BRUME_OK);
  for (brume_tank* tank : tanks_) EXPECT_EQ(brume_tank_destroy(tank), BRUME_OK);
  for (brume_renderer* renderer : renderers_) EXPECT_EQ(brume_renderer_destroy(renderer), BRUME_OK);
  for (brume_device* device : devices_) EXPECT_EQ(brume_device_destroy(device), BRUME_OK);
}

void HostileFrames::begin_frame(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
  constexpr std::uint64_t kNumbers = 64;  // of each frame, for its calls
  commands_ = commands;
  number_ = kNumbers * frame;
  completed_ = kNumbers * completed + kNumbers - 1;
  has_drawn_ = false;
  if (frame > 1) return;
  completed_ = 0;
  recording_.begin(commands, frame, completed);
  // A surface, and what no normal is.
  recording_.recorder().clear(depth_, {{0.02f, 0, 0, 0}});
  recording_.recorder().clear(normals_, {{NAN, 1, 0, 0}});
  gpu::Recorder::Attachments attachments;
  attachments.colours = {&picture_};
  recording_.recorder().begin_rendering(attachments, kSize);
  recording_.recorder().end_rendering();
  recording_.end();
  host_.wait_for_compute(commands);
}

void HostileFrames::run_frames(int frames) {
  static constexpr std::array<Step, 13> kSteps{
      &HostileFrames::host_defaults,   &HostileFrames::device,        &HostileFrames::renderer_create,
      &HostileFrames::renderer_change, &HostileFrames::renderer_read, &HostileFrames::volume_create,
      &HostileFrames::volume_read,     &HostileFrames::decal_create,  &HostileFrames::tank_create,
      &HostileFrames::tank_change,     &HostileFrames::record,        &HostileFrames::record,
      &HostileFrames::record};
  constexpr int kStepsOfFrame = 33;
  run(2000);  // states and fields
  for (int i = 0; i < frames && !testing::Test::HasFailure(); ++i) {
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      begin_frame(commands, frame, completed);
      for (int step = 0; step < kStepsOfFrame; ++step) (this->*kSteps[below(kSteps.size())])();
    });
    // Each frame draws over the picture of the one before.
    host_.wait();
    run(20);
  }
}

float HostileFrames::within(float low, float high) {
  return chance(0.004) ? real(3) : low + (high - low) * std::abs(std::min(real(1), 1.0f));
}

std::uint32_t HostileFrames::above(std::uint32_t most) {
  const std::uint32_t any = number(9);
  return any > most ? any : most + 1 + any;
}

template <typename Number>
void HostileFrames::spoil(Number& number, double probability) {
  if (!chance(probability)) return;
  if constexpr (std::is_floating_point_v<Number>)
    number = static_cast<Number>(chance(0.5) ? NAN : real(1e6f));
  else
    number = static_cast<Number>(this->number(5));
}

void HostileFrames::device() {
  const gpu::HostDevice& host = host_.device();
  brume_device_params params = brume_device_defaults();
  params.get_instance_proc_addr = chance(0.05) ? nullptr : host.get_instance_proc_addr;
  params.instance = chance(0.05) ? VK_NULL_HANDLE : host.instance;
  params.physical_device = chance(0.05) ? VK_NULL_HANDLE : host.physical_device;
  params.device = chance(0.05) ? VK_NULL_HANDLE : host.device;
  spoil(params.queue_family, 0.2);
  if (chance(0.5)) params.enabled_features = brume_vulkan_features();
  if (devices_.empty() || chance(0.3)) {
    auto out = output<brume_device*>();
    const brume_result result = brume_device_create(handle(contexts_), spoiled(params), out.pointer());
    if (checked("brume_device_create", result, out.untouched())) devices_.push_back(out.value());
  }
  compile();
  read<std::uint64_t>("brume_device_memory", devices_, brume_device_memory);
  read<std::uint64_t>("brume_device_allocated_memory", devices_, brume_device_allocated_memory);
  const std::uint64_t limit = chance(0.5) ? UINT64_MAX : static_cast<std::uint64_t>(below(100)) << 20;
  checked("brume_device_set_memory_limit", brume_device_set_memory_limit(handle(devices_), limit), true);
  // The first one stays: the renderers' frames are of it.
  const bool is_last = devices_.size() > 1;
  brume_device* one = is_last ? devices_.back() : wrong_handle<brume_device>();
  if (checked("brume_device_destroy", brume_device_destroy(one), true) && is_last) devices_.pop_back();
  if (renderers_.empty()) return;
  EXPECT_FALSE(checked("brume_device_destroy", brume_device_destroy(devices_.front()), true));
}

brume_light HostileFrames::light() {
  brume_light light = {below(3), point(9), {0, -1, 0.2f}, {1, 2, 3}, 0.2f, 0.5f};
  spoil(light.kind);
  spoil(light.direction.y);
  spoil(light.intensity[1]);
  spoil(light.inner_angle);
  spoil(light.outer_angle);
  return light;
}

void HostileFrames::renderer_create() {
  if (devices_.empty() || (renderers_.size() > 1 && !chance(0.2))) return;
  brume_renderer_params params = brume_renderer_defaults();
  params.width = kSize.x;
  params.height = kSize.y;
  // Other sizes than that of the host's images only where they are refused.
  if (chance(0.1)) params.width = chance(0.5) ? 0 : 16385;
  if (chance(0.1)) params.height = chance(0.5) ? 0 : ~0u;
  spoil(params.march_scale, 0.1);
  if (scales_ == Scales::full && params.march_scale != 1) params.march_scale = 3;
  params.temporal = below(2);
  params.motion = chance(0.7);
  lights_.assign(below(3), light());
  params.lights = chance(0.05) ? nullptr : lights_.data();
  params.light_count = chance(0.1) ? above(1024) : lights_.size();
  const std::array<brume_point, 3> points{point(9), point(9), point(9)};
  const std::array<std::uint32_t, 3> indices{0, 1, chance(0.1) ? number(9) : 2};
  params.points = chance(0.05) ? nullptr : points.data();
  params.point_count = points.size();
  params.indices = chance(0.05) ? nullptr : indices.data();
  params.index_count = chance(0.1) ? 2 : 3;
  params.masks = chance(0.1) ? handle(masks_) : nullptr;
  auto out = output<brume_renderer*>();
  brume_device* on = chance(0.1) ? handle(devices_) : devices_.front();
  const brume_result result = brume_renderer_create(on, spoiled(params), out.pointer());
  if (!checked("brume_renderer_create", result, out.untouched())) return;
  renderers_.push_back(out.value());
  // Of the defaults, where there were no parameters.
  if (checked("brume_renderer_resize", brume_renderer_resize(out.value(), kSize.x, kSize.y), true) &&
      renderers_.size() > 2) {
    EXPECT_TRUE(checked("brume_renderer_destroy", brume_renderer_destroy(renderers_.back()), true));
    renderers_.pop_back();
  }
}

void HostileFrames::renderer_change() {
  const bool is_wrong = chance(0.5);
  const std::uint32_t width = is_wrong ? (chance(0.5) ? 0 : above(16384)) : kSize.x;
  checked("brume_renderer_resize", brume_renderer_resize(handle(renderers_), width, kSize.y), true);
  // Of full resolution alone: the others become numbers that are refused.
  std::uint32_t scale = number(5);
  if (scales_ == Scales::full && scale != 1) scale = 3 + 2 * scale;
  checked("brume_renderer_set_march_scale", brume_renderer_set_march_scale(handle(renderers_), scale), true);
  const std::vector<brume_light> lights(below(3), light());
  checked("brume_renderer_set_lights",
          brume_renderer_set_lights(handle(renderers_), chance(0.1) ? nullptr : lights.data(), lights.size()),
          true);
  const std::vector<brume_point> points(below(5), {1, 2, 3});
  const std::vector<std::uint32_t> indices(below(9), number(5));
  checked("brume_renderer_set_triangles",
          brume_renderer_set_triangles(handle(renderers_), chance(0.1) ? nullptr : points.data(),
                                       points.size(), chance(0.1) ? nullptr : indices.data(), indices.size()),
          true);
  checked("brume_renderer_destroy", brume_renderer_destroy(wrong_handle<brume_renderer>()), true);
}

void HostileFrames::renderer_read() {
  const auto read_image = [&](const char* name, auto function) {
    auto image = output<VkImage>();
    auto view = output<VkImageView>();
    const brume_result result = function(handle(renderers_), image.pointer(), view.pointer());
    checked(name, result, image.untouched() && view.untouched());
  };
  read_image("brume_renderer_smoke", brume_renderer_smoke);
  read_image("brume_renderer_shadows", brume_renderer_shadows);
  read_image("brume_renderer_occlusion", brume_renderer_occlusion);
  read_image("brume_renderer_motion", brume_renderer_motion);
  auto level = output<std::uint32_t>(), is_smoke_missing = output<std::uint32_t>();
  const brume_result result =
      brume_renderer_coarseness(handle(renderers_), level.pointer(), is_smoke_missing.pointer());
  checked("brume_renderer_coarseness", result, level.untouched() && is_smoke_missing.untouched());
  read_list("brume_renderer_timings", renderers_, brume_renderer_timings);
}

void HostileFrames::host_defaults() {
  write_defaults("brume_device_params_init", brume_device_params_init);
  write_defaults("brume_renderer_params_init", brume_renderer_params_init);
  write_defaults("brume_frame_params_init", brume_frame_params_init);
  write_defaults("brume_volume_params_init", brume_volume_params_init);
  write_defaults("brume_decal_params_init", brume_decal_params_init);
  write_defaults("brume_tank_params_init", brume_tank_params_init);
  write_defaults("brume_tank_lighting_init", brume_tank_lighting_init);
  auto volume = output<brume_shown_volume>();
  checked("brume_shown_volume_init", brume_shown_volume_init(volume.pointer(), nullptr), volume.untouched());
  auto decal = output<brume_shown_decal>();
  checked("brume_shown_decal_init", brume_shown_decal_init(decal.pointer(), nullptr), decal.untouched());
  auto tank = output<brume_shown_tank>();
  checked("brume_shown_tank_init", brume_shown_tank_init(tank.pointer(), nullptr), tank.untouched());
}

void HostileFrames::volume_create() {
  if (volumes_.size() > 1 && !chance(0.2)) return;
  brume_volume_params params = brume_volume_defaults();
  params.file = chance(0.1) ? (chance(0.5) ? nullptr : "") : file_.c_str();
  if (chance(0.1)) params.file = "/nowhere/%d.brv";
  if (chance(0.1)) params.density = chance(0.5) ? "nothing" : "";
  if (chance(0.1)) params.heat = "nothing";
  if (chance(0.1)) params.color = "density";
  spoil(params.frame_rate, 0.1);
  spoil(params.repeat, 0.1);
  params.wait_for_frame = below(2);
  params.max_bytes = chance(0.3) ? number(100000) : 0;
  auto out = output<brume_volume*>();
  const brume_result result = brume_volume_create(handle(contexts_), spoiled(params), out.pointer());
  if (!checked("brume_volume_create", result, out.untouched())) return;
  volumes_.push_back(out.value());
  if (volumes_.size() <= 3) return;
  EXPECT_TRUE(checked("brume_volume_destroy", brume_volume_destroy(volumes_.front()), true));
  volumes_.erase(volumes_.begin());
}

void HostileFrames::volume_read() {
  read<brume_volume_info>("brume_volume_describe", volumes_, brume_volume_describe);
  checked("brume_volume_destroy", brume_volume_destroy(wrong_handle<brume_volume>()), true);
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr, {}};
  if (chance(0.2)) features.pNext = &features;
  brume_feature_storage storage;
  const brume_result merged = brume_vulkan_merge_features(chance(0.2) ? nullptr : &features, &storage);
  checked("brume_vulkan_merge_features", merged, !features.features.samplerAnisotropy);
}

void HostileFrames::decal_create() {
  checked("brume_decal_destroy", brume_decal_destroy(wrong_handle<brume_decal>()), true);
  if (decals_.size() > 1 && !chance(0.2)) return;
  const std::vector<float> values(8, chance(0.1) ? NAN : 0.5f);
  brume_decal_params params = brume_decal_defaults();
  if (chance(0.3)) params.file = chance(0.3) ? "/nowhere/decal.brv" : file_.c_str();
  if (chance(0.2)) params.grid = chance(0.5) ? "nothing" : "";
  if (!params.file || chance(0.1)) params.up = chance(0.1) ? nullptr : values.data();
  if (!params.file && chance(0.5)) params.down = values.data();
  for (std::uint32_t& along : params.size) along = 2;
  // Fewer values than are there, or more than an image holds.
  if (chance(0.2)) params.size[below(3)] = chance(0.5) ? below(2) : above(1u << 26);
  if (chance(0.1)) params.size[below(3)] = 1u << 31;
  spoil(params.low.y, 0.1);
  if (chance(0.1)) params.high = params.low;
  auto out = output<brume_decal*>();
  const brume_result result = brume_decal_create(handle(contexts_), spoiled(params), out.pointer());
  if (!checked("brume_decal_create", result, out.untouched())) return;
  decals_.push_back(out.value());
  if (decals_.size() <= 3) return;
  EXPECT_TRUE(checked("brume_decal_destroy", brume_decal_destroy(decals_.front()), true));
  decals_.erase(decals_.begin());
}

brume_shown_decal HostileFrames::shown_decal() {
  brume_shown_decal shown = brume_shown_decal_defaults(handle(decals_));
  shown.position = point(9);
  shown.x_axis.x = within(1, 9);
  spoil(shown.x_axis.y);
  if (chance(0.01)) shown.y_axis = shown.x_axis;
  if (chance(0.01)) shown.z_axis.z = 1e-30f;
  spoil(shown.position.z);
  spoil(shown.strength);
  spoil(shown.gamma);
  spoil(shown.correction);
  spoil(shown.falloff);
  spoil(shown.fade);
  spoil(shown.scatter);
  return shown;
}

brume_normals HostileFrames::normals() {
  brume_normals normals = brume_frame_defaults().normals;
  if (chance(0.5)) normals.view = normals_.view();
  normals.layout = VK_IMAGE_LAYOUT_GENERAL;
  if (chance(0.02)) normals.layout = static_cast<VkImageLayout>(chance(0.5) ? 0 : number(999));
  normals.encoding = below(4);
  spoil(normals.encoding);
  normals.in_view_space = below(3);
  normals.alpha_receives = below(3);
  return normals;
}

brume_shown_volume HostileFrames::shown_volume() {
  brume_shown_volume shown = brume_shown_volume_defaults(handle(volumes_));
  shown.position = point(9);
  spoil(shown.x_axis.x);
  if (chance(0.01)) shown.y_axis = shown.x_axis;
  spoil(shown.z_axis.y);
  spoil(shown.seconds);
  spoil(shown.extinction);
  spoil(shown.albedo[2]);
  spoil(shown.anisotropy);
  spoil(shown.multiple_scattering);
  spoil(shown.emission);
  spoil(shown.kelvin);
  return shown;
}

void HostileFrames::tank_create() {
  if (tanks_.size() > 1 && !chance(0.2)) return;
  static constexpr std::array kSpheres{3.0f, 3.0f, 3.0f, 2.0f, 7.0f, 5.0f, 4.0f, 1.5f};
  static constexpr std::array kColors{0xffffffffu, 0x40808080u};
  std::array spheres = kSpheres;
  brume_tank_params params = brume_tank_defaults();
  if (chance(0.05)) params.file = chance(0.5) ? "" : file_.c_str();
  for (std::uint32_t& size : params.size) {
    size = 9;
    spoil(size, 0.03);
  }
  params.voxel = 0.2f;
  spoil(params.voxel, 0.1);
  for (float& number : spheres) spoil(number, 0.03);
  params.spheres = chance(0.05) ? nullptr : spheres.data();
  params.colors = chance(0.05) ? nullptr : kColors.data();
  params.sphere_count = chance(0.05) ? below(3) : 2;
  if (chance(0.05)) params.sphere_count = (std::size_t{1} << 23) + 1 + number(999);
  auto out = output<brume_tank*>();
  const brume_result result = brume_tank_create(handle(contexts_), spoiled(params), out.pointer());
  if (!checked("brume_tank_create", result, out.untouched())) return;
  tanks_.push_back(out.value());
  if (tanks_.size() <= 3) return;
  EXPECT_TRUE(checked("brume_tank_destroy", brume_tank_destroy(tanks_.front()), true));
  tanks_.erase(tanks_.begin());
}

void HostileFrames::tank_change() {
  brume_tank_lighting lighting = brume_tank_lighting_defaults();
  std::array<brume_tank_light, 3> lights{};
  for (brume_tank_light& light : lights) {
    light = {point(3), within(0, 1), {1, 2, 3}};
    spoil(light.radius);
    spoil(light.intensity[1]);
  }
  lighting.lights = chance(0.05) ? nullptr : lights.data();
  lighting.light_count = below(4);
  if (chance(0.05)) lighting.light_count = above(16);
  spoil(lighting.ambient[1]);
  lighting.bounces = below(4);
  spoil(lighting.bounces);
  spoil(lighting.fog_extinction, 0.05);
  spoil(lighting.fog_color[2], 0.05);
  if (chance(0.3)) lighting.glass_index = 1.5f;
  spoil(lighting.glass_index, 0.05);
  lighting.glass_position = point(1);
  spoil(lighting.glass_radii.y, 0.05);
  lighting.photons = below(64);
  if (chance(0.05)) lighting.photons = above(1u << 22);
  checked("brume_tank_set_lighting", brume_tank_set_lighting(handle(tanks_), spoiled(lighting)), true);
  checked("brume_tank_destroy", brume_tank_destroy(wrong_handle<brume_tank>()), true);
}

brume_shown_tank HostileFrames::shown_tank() {
  brume_shown_tank shown = brume_shown_tank_defaults(handle(tanks_));
  shown.position = point(9);
  spoil(shown.x_axis.x);
  if (chance(0.01)) shown.y_axis = shown.x_axis;
  spoil(shown.z_axis.z);
  shown.view = below(2);
  spoil(shown.view);
  shown.samples = 1 + below(2);
  spoil(shown.samples);
  shown.continues_previous = below(2);
  return shown;
}

void HostileFrames::spoil(brume_frame_params& params) {
  constexpr double kRarely = 0.006;
  for (float* value : {&params.camera.position.y,
                       &params.camera.forward.x,
                       &params.camera.up.z,
                       &params.camera.vertical_fov,
                       &params.camera.jitter_x,
                       &params.depth.near_plane,
                       &params.depth.far_plane,
                       &params.picture.exposure,
                       &params.look.albedo[0],
                       &params.look.anisotropy,
                       &params.look.multiple_scattering,
                       &params.look.erosion,
                       &params.look.noise_size,
                       &params.look.hole_rim,
                       &params.look.swirl,
                       &params.look.rise,
                       &params.ambient[2],
                       &params.ambient_indoors,
                       &params.quality.step_scale,
                       &params.quality.resolve_error_scale,
                       &params.quality.light_update_fraction,
                       &params.quality.bounce_update_fraction})
    spoil(*value, kRarely);
  for (float* side : {&params.frustum.left, &params.frustum.right, &params.frustum.down, &params.frustum.up,
                      &params.previous_camera.position.y, &params.previous_camera.up.z,
                      &params.previous_camera.vertical_fov, &params.previous_camera.jitter_y,
                      &params.previous_frustum.left, &params.previous_frustum.up})
    spoil(*side, kRarely);
  for (std::uint32_t* length : {&params.part.width, &params.part.height, &params.view})
    spoil(*length, kRarely);
  spoil(params.seconds, kRarely);
  if (chance(kRarely)) params.camera.forward = {0, 0, 0};
  if (chance(kRarely)) params.camera.up = params.camera.forward;
  if (chance(kRarely)) params.commands = VK_NULL_HANDLE;
  if (chance(kRarely)) params.depth.view = VK_NULL_HANDLE;
  if (chance(0.02)) params.depth.layout = static_cast<VkImageLayout>(chance(0.5) ? 0 : number(999));
  // Depth, compressed, or none: what cannot be blended.
  if (chance(0.02)) params.picture.format = static_cast<VkFormat>(VK_FORMAT_D16_UNORM + below(200));
  if (chance(0.02)) params.light_count = count(lights_.size());
  if (chance(0.02)) params.volume_count = count(shown_.size());
  if (chance(0.02)) params.decal_count = chance(0.5) ? 33 : count(shown_decals_.size());
  if (chance(0.02)) params.tank_count = count(shown_tanks_.size());
  if (chance(kRarely)) params.bounces = above(16);
  spoil(params.shadow_lights[1], 0.02);
  if (chance(0.02)) params.shadow_light_count = above(4);
  // Wrong numbers of frames.
  if (chance(0.02)) params.frame_number = below(2) * (params.frame_number - 1);
  if (chance(0.02)) params.completed_frame = params.frame_number + number(9);
  if (chance(0.02) && params.completed_frame > 0) params.completed_frame = 0;
}

brume_frame_params HostileFrames::frame_params() {
  brume_frame_params params = brume_frame_defaults();
  params.commands = commands_;
  params.frame_number = ++number_;
  params.completed_frame = completed_;
  params.camera.position = {within(1, 5), within(1, 3), within(5, 12)};
  params.depth = {depth_.view(), VK_IMAGE_LAYOUT_GENERAL, 0.1f, INFINITY, 1};
  if (!has_drawn_ && chance(0.3)) params.picture = {picture_.view(), VK_FORMAT_R16G16B16A16_SFLOAT, 1};
  lights_.clear();
  for (std::uint32_t i = below(4); i > 0; --i) lights_.push_back(light());
  std::erase_if(lights_,
                [&](const brume_light& one) { return one.kind == BRUME_LIGHT_SUN && !chance(0.05); });
  params.lights = lights_.data();
  params.light_count = lights_.size();
  shown_.clear();
  for (std::uint32_t i = below(3); i > 0 && !volumes_.empty(); --i) shown_.push_back(shown_volume());
  params.volumes = shown_.data();
  params.volume_count = shown_.size();
  shown_decals_.clear();
  for (std::uint32_t i = below(4); i > 0 && !decals_.empty(); --i) shown_decals_.push_back(shown_decal());
  params.decals = shown_decals_.data();
  params.decal_count = shown_decals_.size();
  params.normals = normals();
  shown_tanks_.clear();
  for (std::uint32_t i = below(3); i > 0 && !tanks_.empty(); --i) shown_tanks_.push_back(shown_tank());
  params.tanks = shown_tanks_.data();
  params.tank_count = shown_tanks_.size();
  params.shadow_light_count = lights_.empty() ? 0 : below(3);
  params.continues_previous = below(2);
  params.view = below(BRUME_MAX_VIEWS);
  params.has_previous = below(2);
  params.parallel = chance(0.2);
  if (params.parallel || chance(0.3))
    params.previous_frustum =
        params.frustum = {-within(0, 2), within(0.01f, 3), -within(0, 2), within(0.01f, 3)};
  if (params.parallel) params.depth.far_plane = 50;
  params.previous_camera = params.camera;
  params.previous_camera.position.x += within(0, 1);
  if (chance(0.3)) params.part = {below(8), below(4), 1 + below(8), 1 + below(5)};
  params.seconds = within(0, 9);
  spoil(params);
  return params;
}

void HostileFrames::compile() {
  brume_renderer_params renderer = brume_renderer_defaults();
  renderer.width = chance(0.1) ? 0 : kSize.x;
  spoil(renderer.march_scale, 0.1);
  renderer.temporal = below(2);
  renderer.light_count = chance(0.1) ? above(1024) : 0;
  brume_frame_params frame = frame_params();
  // It is seldom worth the time.
  if (!chance(0.05)) frame.picture.format = VK_FORMAT_R32_UINT;
  checked("brume_device_compile", brume_device_compile(handle(devices_), spoiled(renderer), spoiled(frame)),
          true);
}

void HostileFrames::record() {
  brume_frame_params params = frame_params();
  const bool draws = params.picture.view != VK_NULL_HANDLE;
  const brume_field* field = chance(0.1) ? nullptr : handle(fields_);
  const brume_result result = brume_renderer_record(handle(renderers_), field, spoiled(params));
  has_drawn_ |= checked("brume_renderer_record", result, true) && draws;
  if (!chance(0.2)) return;
  std::array<brume_frame_params, 3> views;
  std::array<const brume_frame_params*, 3> pointers{};
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i] = params;
    views[i].frame_number = number_;
    views[i].picture = {};
    views[i].view = chance(0.9) ? static_cast<std::uint32_t>(i) : below(5);
    if (!chance(0.05)) pointers[i] = &views[i];
  }
  const std::uint32_t count = chance(0.9) ? 1 + below(3) : above(4);
  checked(
      "brume_renderer_record_views",
      brume_renderer_record_views(handle(renderers_), field, chance(0.05) ? nullptr : pointers.data(), count),
      true);
}

}  // namespace brume::host
