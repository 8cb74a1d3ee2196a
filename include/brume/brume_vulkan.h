// The C interface of Brume's renderer: smoke in the frames of your Vulkan renderer, the host. Library:
// libbrume, which contains all of brume.h, too. Guide: docs/start/your-renderer.md.
//
//   context --> device --> renderer --,
//   world --> state --> field --------+--> brume_renderer_record: commands in your command buffer
//   context --> volume, decal, tank --'
//
// Example    A device and a renderer, then the smoke of one frame. Between both, your renderer draws its
//            surfaces into `color_view` and `depth_view`, and a barrier makes the depth readable by compute
//            shaders.
//
// ```c
//   brume_device* device;
//   brume_renderer* renderer;
//   brume_device_params host = brume_device_defaults();
//   host.get_instance_proc_addr = vkGetInstanceProcAddr;
//   host.instance = instance;
//   host.physical_device = physical_device;
//   host.device = vulkan_device;  // created with brume_vulkan_features()
//   host.queue_family = queue_family;
//   check(brume_device_create(context, &host, &device));
//   brume_renderer_params size = brume_renderer_defaults();
//   size.width = width;
//   size.height = height;
//   check(brume_renderer_create(device, &size, &renderer));
//
//   brume_frame_params frame = brume_frame_defaults();
//   frame.commands = commands;  // in the recording state, outside vkCmdBeginRendering
//   frame.frame_number = frame_number;
//   frame.completed_frame = completed_frame;  // the last frame whose fence is signalled
//   frame.camera.position = eye;
//   frame.camera.forward = forward;
//   frame.camera.vertical_fov = 1.0f;
//   frame.depth.view = depth_view;  // in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
//   frame.depth.near_plane = 0.1f;
//   frame.depth.far_plane = 1000.0f;
//   frame.picture.view = color_view;  // in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL
//   frame.picture.format = VK_FORMAT_R16G16B16A16_SFLOAT;
//   frame.seconds = tick / 64.0;
//   frame.jitter_index = (uint32_t)frame_number;
//   check(brume_renderer_record(renderer, field, &frame));
// ```
//
// The rules of brume.h for results, handles, threads and structs hold here, too. In addition:
//
// Submitting  No function submits commands or waits for the device (see brume_renderer_params::timings for
//             drivers that do). Functions that take a command buffer in
//             the recording state, outside vkCmdBeginRendering, only record. Submit the commands to one
//             queue, in the order of their frames. If you do not submit the commands of a frame, submit no
//             later frame either.
// Frames      You number your frames, with numbers that never fall, and report the last frame of which the
//             device has completed all commands. Any number of frames may be in flight. The library destroys
//             resources of a frame after that frame has completed.
// Failures    After an error of a frame nothing was added to the command buffer. Unless
//             arguments were wrong, the images of the last frame are gone, and the next one uploads
//             everything again.
// Positions   Coordinates are within +-16384 m.
// Images      Your images are in the layout that the struct names, before and after the commands. Make your
//             writes visible to the stage that the struct names, and let later accesses wait for this stage.
// Threads     Calls with renderers of one device run one after another.
#ifndef BRUME_BRUME_VULKAN_H
#define BRUME_BRUME_VULKAN_H

#include <brume/brume.h>
#include <brume/brume_assets.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct brume_device brume_device;
typedef struct brume_renderer brume_renderer;

// ---- Device ----

/// Returns a constant chain for VkDeviceCreateInfo::pNext, which begins with a VkPhysicalDeviceFeatures2: all
/// features that Brume uses of a device of Vulkan 1.3. A device of Vulkan 1.2 with
/// shaderStorageImageExtendedFormats is enough, if you give brume_device_params::enabled_features: render
/// passes and barriers of Vulkan 1.0 then draw the same pictures. Each device must support subgroup vote,
/// arithmetic and ballot in compute shaders. None needs an extension. Never fails.
BRUME_API const void* brume_vulkan_features(void) BRUME_NOEXCEPT;

/// Memory of the structs that brume_vulkan_merge_features appends.
typedef struct brume_feature_storage {
  uint64_t words[24];  ///< Internal.
} brume_feature_storage;

/// Enables the features of brume_vulkan_features in your own chain for VkDeviceCreateInfo::pNext. It sets
/// them in the structs that the chain has: its VkPhysicalDeviceFeatures2, VkPhysicalDeviceVulkan12Features
/// and VkPhysicalDeviceVulkan13Features, or structs of single features. Missing structs are appended, in
/// `storage`, which must live as long as the chain. What else the chain enables stays. Errors:
/// BRUME_ERROR_ARGUMENT for a chain without VkPhysicalDeviceFeatures2; it is then unchanged.
BRUME_API brume_result brume_vulkan_merge_features(void* chain,
                                                   brume_feature_storage* storage) BRUME_NOEXCEPT;

/// Your Vulkan device.
typedef struct brume_device_params {
  uint32_t struct_size;
  const void* next;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< The function that returns all others.
  VkInstance instance;                               ///< Your instance.
  VkPhysicalDevice physical_device;                  ///< The physical device of `device`.
  VkDevice device;                                   ///< Your device.
  uint32_t queue_family;  ///< The family of your command buffers, with graphics and compute.
  /// Passed to the two functions below, with which you allocate the device's memory yourself. Set both or
  /// neither; null: vkAllocateMemory and vkFreeMemory. They are called within functions of the device and its
  /// renderers, in the thread of the call, and must not call Brume.
  void* memory_user;
  /// Returns memory of the size and type in `info` that is not used or mapped otherwise.
  VkResult (*allocate_memory)(void* memory_user, const VkMemoryAllocateInfo* info, VkDeviceMemory* memory);
  /// Frees memory that `allocate_memory` returned.
  void (*free_memory)(void* memory_user, VkDeviceMemory memory, VkDeviceSize size);
  /// The chain of VkDeviceCreateInfo::pNext with which you created `device`, with a
  /// VkPhysicalDeviceFeatures2: brume_device_create then checks that it enables what Brume needs, and does
  /// without what else it lacks. Null: nothing is checked, and you enabled all of brume_vulkan_features that
  /// the physical device supports.
  const void* enabled_features;
  /// Your cache for pipelines, which must outlive the brume_device; null: none. It is used while calls
  /// compile, also in their threads, so create it without
  /// VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT.
  VkPipelineCache pipeline_cache;
  /// Memory of the CPU for what the driver creates for Brume, which must outlive the brume_device; null: the
  /// driver's own. Calls use it in their threads.
  const VkAllocationCallbacks* allocation_callbacks;
} brume_device_params;

/// Writes what brume_device_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_device_params_init(brume_device_params* params,
                                                uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: queue family 0, no memory functions. Set the other members.
static inline brume_device_params brume_device_defaults(void) {
  brume_device_params params;
  brume_device_params_init(&params, sizeof params);
  return params;
}

/// Borrows your Vulkan device, which must outlive the result. Errors: BRUME_ERROR_DEVICE when physical device
/// or driver lack something, or `enabled_features` lacks a feature, which the error names;
/// BRUME_ERROR_ARGUMENT for a queue family that does not exist or lacks graphics or compute.
BRUME_API brume_result brume_device_create(brume_context* context, const brume_device_params* params,
                                           brume_device** device) BRUME_NOEXCEPT;
/// Destroys a device; null is ignored. The GPU must have completed all frames, which is not checked. Errors:
/// BRUME_ERROR_ORDER unless all renderers of the device have been destroyed.
BRUME_API brume_result brume_device_destroy(brume_device* device) BRUME_NOEXCEPT;
/// Writes the bytes of device memory that the device's renderers use at present. Resources that only frames
/// in flight still use, and the CPU memory of uploads, are not included.
BRUME_API brume_result brume_device_memory(const brume_device* device, uint64_t* bytes) BRUME_NOEXCEPT;
/// Writes the bytes that are allocated at present, by vkAllocateMemory or your function: blocks of 16 MiB and
/// larger ones, with memory for uploads and memory to spare.
BRUME_API brume_result brume_device_allocated_memory(const brume_device* device,
                                                     uint64_t* bytes) BRUME_NOEXCEPT;
/// Limits the device memory of all renderers of the device to `bytes` from the next frame on; resources that
/// only frames in flight still use are not included. UINT64_MAX, the initial limit: all memory of the device.
/// Images of the frame's size, and for each renderer a reserve of 512 bricks of smoke with their light, are
/// never refused or given back. Smoke for which too little memory remains becomes coarser instead of
/// invisible: see brume_renderer_coarseness.
BRUME_API brume_result brume_device_set_memory_limit(brume_device* device, uint64_t bytes) BRUME_NOEXCEPT;

// ---- Renderer ----

typedef enum brume_light_kind {
  BRUME_LIGHT_POINT = 0,
  BRUME_LIGHT_SPOT = 1,
  BRUME_LIGHT_SUN = 2  ///< The same light from one direction everywhere.
} brume_light_kind;

/// A light.
typedef struct brume_light {
  uint32_t kind;          ///< A brume_light_kind.
  brume_point position;   ///< Position [m]; a sun ignores it.
  brume_point direction;  ///< Direction in which light travels, any length but 0; a point light ignores it.
  float intensity[3];     ///< Per channel, [0, 10^12]: intensity [W/sr]; for a sun, irradiance [W/m^2].
  float inner_angle;  ///< Angle from a spot's axis up to which it has full intensity [rad], [0, outer_angle).
  float outer_angle;  ///< Angle beyond which it has none, (0, pi]. Between both: KHR_lights_punctual of glTF.
} brume_light;

/// The settings of a new renderer.
typedef struct brume_renderer_params {
  uint32_t struct_size;
  const void* next;
  uint32_t width;   ///< Width of your pictures [px], [1, 16384]; frames may be smaller: see `part`.
  uint32_t height;  ///< Their height, likewise.
  /// Pixels per ray of the march along each axis: 1, 2 or 4. 2 and 4 are faster, and show nothing that 1
  /// hides.
  uint32_t march_scale;
  uint32_t temporal;  ///< 1: smoke is accumulated over frames with brume_frame_params::continues_previous.
  /// Lights that stay until brume_renderer_set_lights, with shadow maps. At most 1024.
  const brume_light* lights;
  size_t light_count;  ///< Number of `lights`.
  /// Triangles that cast shadows into the smoke, as in brume_triangles_params, until
  /// brume_renderer_set_triangles. None: nothing casts shadows.
  const brume_point* points;
  size_t point_count;        ///< Number of `points`, below 2^28.
  const uint32_t* indices;   ///< Three indices into `points` for each triangle.
  size_t index_count;        ///< Number of `indices`: a multiple of 3, below 2^30.
  const brume_masks* masks;  ///< The masks of the fields that it draws; null: none.
  /// 1: the first frame compiles all pipelines of smoke, for all march scales, so that no later frame of
  /// smoke waits for a pipeline. Compiled pipelines belong to the device: later renderers use them, too.
  uint32_t prepare_all;
  /// 1: brume_renderer_timings has the GPU times of passes. Some drivers, such as Mesa's lavapipe, then wait
  /// for the device in brume_renderer_record. 0: no timestamps are written.
  uint32_t timings;
  uint32_t motion;  ///< 1: each frame has brume_renderer_motion.
} brume_renderer_params;

/// Writes what brume_renderer_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_renderer_params_init(brume_renderer_params* params,
                                                  uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: 1280 x 720, a ray per pixel, no accumulation, no lights, no triangles, no timings.
static inline brume_renderer_params brume_renderer_defaults(void) {
  brume_renderer_params params;
  brume_renderer_params_init(&params, sizeof params);
  return params;
}

/// Creates a renderer. Its first frame uploads lights and triangles, and compiles pipelines that no renderer
/// of the device has used before. The arrays are copied.
BRUME_API brume_result brume_renderer_create(brume_device* device, const brume_renderer_params* params,
                                             brume_renderer** renderer) BRUME_NOEXCEPT;
/// Destroys a renderer; null is ignored. Its device keeps resources of frames in flight until they complete.
BRUME_API brume_result brume_renderer_destroy(brume_renderer* renderer) BRUME_NOEXCEPT;
/// Changes the size of pictures [px], [1, 16384], from the next frame on, and makes all images of that size
/// again. Accumulation starts over. For frames of changing size use brume_frame_params::part.
BRUME_API brume_result brume_renderer_resize(brume_renderer* renderer, uint32_t width,
                                             uint32_t height) BRUME_NOEXCEPT;

/// Changes the renderer's march_scale (brume_renderer_params) to 1, 2 or 4, from the next frame on.
BRUME_API brume_result brume_renderer_set_march_scale(brume_renderer* renderer,
                                                      uint32_t march_scale) BRUME_NOEXCEPT;

/// Replaces the lights of brume_renderer_params from the next frame on, which draws their shadow maps and
/// finds all light in the smoke again. Lights that change in each frame belong into brume_frame_params. The
/// array is copied.
BRUME_API brume_result brume_renderer_set_lights(brume_renderer* renderer, const brume_light* lights,
                                                 size_t light_count) BRUME_NOEXCEPT;

/// Replaces the triangles of brume_renderer_params from the next frame on, which draws all shadow maps and
/// finds all light in the smoke again: for another level, and for walls that fall. The arrays are copied.
BRUME_API brume_result brume_renderer_set_triangles(brume_renderer* renderer, const brume_point* points,
                                                    size_t point_count, const uint32_t* indices,
                                                    size_t index_count) BRUME_NOEXCEPT;

// ---- Frames ----

/// The camera of a frame.
typedef struct brume_camera {
  brume_point position;  ///< Position [m].
  brume_point forward;   ///< Direction of view, any length but 0.
  brume_point up;        ///< What is up in the image: any length but 0, 0.001 rad or more off `forward`.
  float vertical_fov;    ///< Vertical field of view [rad], (0, pi). Pixels are square.
  float jitter_x;        ///< Your jitter: from a pixel's centre to its sample, to the right [px], [-1, 1].
  float jitter_y;        ///< The same, downwards [px], [-1, 1].
} brume_camera;

/// Tangents of the angles from the camera's `forward` to the sides of the picture, to the right and upwards:
/// left < right, down < up, each in [-1000, 1000]. From the angles of an eye in OpenXR, tan(angleLeft) and so
/// on. From a projection matrix P in the column convention, which maps the view's x, y and -1 to clip space:
/// left = (P[2][0] - 1) / P[0][0], right = (P[2][0] + 1) / P[0][0], and likewise with y for the other two.
typedef struct brume_frustum {
  float left;   ///< Tangent towards the left side.
  float right;  ///< The same towards the right side.
  float down;   ///< The same towards the lower side.
  float up;     ///< The same towards the upper side.
} brume_frustum;

/// A part of your images [px].
typedef struct brume_rectangle {
  uint32_t x;       ///< The left column.
  uint32_t y;       ///< The top row.
  uint32_t width;   ///< The number of columns.
  uint32_t height;  ///< The number of rows.
} brume_rectangle;

/// The depth of the surfaces that you drew with the same camera.
typedef struct brume_depth {
  /// The depth aspect alone of a 2D image with VK_IMAGE_USAGE_SAMPLED_BIT: of a layer of an array, a view of
  /// that layer. It has one sample per pixel, or several with brume_frame_params::depth_has_samples.
  VkImageView view;
  VkImageLayout layout;  ///< A layout in which it can be sampled. Stage: compute shaders, sampled reads.
  /// Near plane [m], (0, 16384). The depth is a projection onto [0, 1]: see brume_frame_params::parallel.
  float near_plane;
  float far_plane;    ///< Far plane [m], above near_plane, may be infinite. Its depth means: no surface.
  uint32_t reversed;  ///< 1: the depth is 1 at near_plane and 0 at far_plane.
} brume_depth;

typedef enum brume_normal_encoding {
  BRUME_NORMALS_SIGNED = 0,    ///< r, g and b are x, y and z, with any length.
  BRUME_NORMALS_UNSIGNED = 1,  ///< 2 rgb - 1 are x, y and z.
  /// r and g in [-1, 1] are x and y of the octahedron |x| + |y| + |z| = 1; its half with z < 0 is folded over
  /// the other: (x, y) becomes ((1 - |y|) sign(x), (1 - |x|) sign(y)).
  BRUME_NORMALS_OCTAHEDRAL = 2,
  BRUME_NORMALS_OCTAHEDRAL_UNSIGNED = 3  ///< 2 rg - 1 are x and y of the octahedron.
} brume_normal_encoding;

/// The normals of the surfaces that you drew, for decals.
typedef struct brume_normals {
  /// An image as large as the depth's, in a format that shaders read as floats. Null: the normals follow from
  /// planes through the depths of neighbouring pixels, and face the camera. Such a normal also replaces one
  /// in the image that is 0 or not finite.
  VkImageView view;
  VkImageLayout layout;    ///< A layout in which it can be sampled. Stage: compute shaders, sampled reads.
  uint32_t encoding;       ///< A brume_normal_encoding.
  uint32_t in_view_space;  ///< 1: axes are the camera's right, up, and towards the viewer; 0: world axes.
  /// 1: decals do not darken surfaces where alpha is 0: moving objects, and the mesh of which a decal was
  /// baked.
  uint32_t alpha_receives;
} brume_normals;

/// Your colour target, over which smoke is blended.
typedef struct brume_picture {
  /// A 2D image, or a layer of an array, with one sample per pixel and VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
  /// in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL. Stage: colour attachment output, reads and writes. Null:
  /// smoke is not blended; read brume_renderer_smoke.
  VkImageView view;
  VkFormat format;  ///< A format that can be blended, with linear radiance: for example half floats.
  float exposure;   ///< Factor of the smoke's radiance, (0, 10^9).
} brume_picture;

/// The look of smoke; its large shape and its extinction come from the field.
typedef struct brume_smoke_look {
  float albedo[3];            ///< Fraction of the light that smoke scatters, per channel, [0, 1].
  float anisotropy;           ///< Mean cosine of the phase function, [-0.99, 0.99].
  float multiple_scattering;  ///< Weight of light that is scattered more than once, [0, 1].
  /// Strength of the noise that erodes smoke, [0, 1]. Above 0, players see other smoke than
  /// brume_field_visible and brume_field_optical_depths count: rims are thinner, with gaps to look through,
  /// and dense smoke is up to 1 + erosion / 2 times as dense in places. brume_field_drawn_visible and
  /// brume_field_drawn_depths count the drawn smoke. With erosion and hole_rim 0, all of them count the same
  /// smoke.
  float erosion;
  float noise_size;  ///< Size of the largest billows [m], [0.05, 100].
  float hole_rim;    ///< Distance by which noise frays the rims of holes [m], [0, 10].
  float swirl;       ///< Distance by which the noise swirls [m], [0, 10].
  float rise;        ///< Speed at which the noise rises [m/s], [-10, 10].
} brume_smoke_look;

/// Savings of a frame. 0 in each member: the best quality.
typedef struct brume_quality {
  float step_scale;            ///< Factor of the march's step length, [0.25, 16]; 0: 1.
  float resolve_error_scale;   ///< Factor of the error that march_scale 2 or 4 may make, [0.25, 16]; 0: 1.
  uint32_t skip_fine_shadows;  ///< 1: noise does not shadow itself, which saves up to a third of the march.
  /// Fraction of the changed light in the smoke that this frame updates, [1/16, 1]; 0: all. At a fraction f,
  /// light may lag by up to 1/f frames.
  float light_update_fraction;
  float bounce_update_fraction;  ///< The same fraction for light of brume_frame_params::bounces.
  /// Bytes of a large volume that this frame uploads; until all are uploaded, the volume is shown at a lower
  /// resolution. 0: all at once.
  uint64_t volume_upload_bytes;
} brume_quality;

/// The largest number of views of a renderer.
#define BRUME_MAX_VIEWS 4
/// The largest number of lights in brume_frame_params::shadow_lights.
#define BRUME_MAX_SHADOW_LIGHTS 4

/// One frame.
typedef struct brume_frame_params {
  uint32_t struct_size;
  const void* next;

  // Set these each frame.

  VkCommandBuffer commands;  ///< Your command buffer, in the recording state, outside vkCmdBeginRendering.
  /// The number of this frame, from 1 on. It never falls on a device. All views of a frame, and all renderers
  /// that draw it, may have the same number.
  uint64_t frame_number;
  /// The last frame of which the device has completed all commands; 0: none yet. It never falls, and is below
  /// frame_number.
  uint64_t completed_frame;
  brume_camera camera;    ///< The camera with which you drew depth and picture.
  brume_depth depth;      ///< The depth of your surfaces, which hide smoke behind them.
  brume_picture picture;  ///< The colour target over which smoke is blended, and which decals darken.
  /// The clock of noise and holes [s], [0, 10^7]: the time of the field's state, or later, between ticks.
  double seconds;
  uint32_t jitter_index;  ///< The jitter of the march; add 1 each frame. Equal indices give equal smoke.

  // Optional: brume_frame_defaults() sets these.

  /// 1: this frame follows the last recorded one of its view, so that smoke may be accumulated
  /// (brume_renderer_params::temporal). 0: accumulation starts over, after a camera cut for example.
  uint32_t continues_previous;
  brume_smoke_look look;  ///< The look of smoke.
  /// Reduction of the noise finer than a tenth of look.noise_size, [0, 1]. 0: all of it is drawn; 1: none,
  /// which saves a quarter of the march.
  float detail_reduction;
  /// Light of the sky, [0, 10^6]: its radiance from a direction of height y is (0.75 + 0.375 y) * ambient.
  float ambient[3];
  float ambient_indoors;  ///< Fraction of `ambient` that arrives where no sky is visible, [0, 1].
  /// Number of times that smoke and the level's surfaces, which count as white, pass light on to each other,
  /// [0, 16]. 0: never; a formula then approximates light that is scattered more than once. More than 0 needs
  /// Embree 3 (libembree3.so.3) at run time: BRUME_ERROR_DEVICE without it.
  uint32_t bounces;
  uint32_t shadow_light_count;  ///< Number of `shadow_lights`, [0, BRUME_MAX_SHADOW_LIGHTS].
  /// The lights of brume_renderer_shadows, as indices into the renderer's lights followed by the frame's.
  uint32_t shadow_lights[BRUME_MAX_SHADOW_LIGHTS];
  /// Lights of this frame only, such as muzzle flashes and moving lights, shadowed by the level's voxels. At
  /// most 64; no suns.
  const brume_light* lights;
  size_t light_count;                 ///< Number of `lights`.
  const brume_shown_volume* volumes;  ///< Volumes, at most 32. They may overlap each other and the smoke.
  size_t volume_count;                ///< Number of `volumes`.
  const brume_shown_decal* decals;    ///< Decals, at most 32. Overlapping decals multiply.
  size_t decal_count;                 ///< Number of `decals`.
  brume_normals normals;              ///< The normals of the surfaces that decals darken.
  const brume_shown_tank* tanks;      ///< Tanks, at most 4. jitter_index also selects their paths.
  size_t tank_count;                  ///< Number of `tanks`.
  brume_quality quality;              ///< Savings of this frame.
  /// The part of depth, normals and picture that this frame covers, up to the renderer's size: split screens,
  /// dynamic resolution. Its size may change in each frame; accumulation goes on. All 0: the renderer's
  /// size, from the top left corner on.
  brume_rectangle part;
  /// The picture's sides, in the place of camera.vertical_fov and square pixels: an eye of a headset, a tile,
  /// a portal. All 0: the view axis is in the middle.
  brume_frustum frustum;
  /// Which of the renderer's views this is, [0, BRUME_MAX_VIEWS): an eye of a headset, a part of a split
  /// screen. Views share all light and differ in what accumulates over frames.
  uint32_t view;
  /// 1: `previous_camera` and `previous_frustum` are set. 0: the previous camera is the one of the view's
  /// last recorded frame.
  uint32_t has_previous;
  /// The camera, with its jitter, with which you drew this view's previous frame, in the coordinates of this
  /// frame: where your origin has moved since, or positions continue elsewhere, the camera as if it had been
  /// there. Motion leads there, also where that frame was not recorded or `continues_previous` is 0. With
  /// `continues_previous` that frame must be the view's last recorded one: accumulation goes on from its
  /// smoke, as seen by this camera.
  brume_camera previous_camera;
  brume_frustum previous_frustum;  ///< Its `frustum`.
  /// 1: `depth.view` has several samples per pixel. Smoke then ends at the farthest surface of a pixel, so
  /// that it hides all that it hides of any sample. Resolve colour before, and normals.
  uint32_t depth_has_samples;
  /// 1: a parallel projection, also of the previous camera: all rays run along camera.forward, as in views of
  /// an editor. `frustum`, which must be set, has distances [m] from the axis through camera.position in the
  /// place of tangents, each in [-16384, 16384]; the depth is linear from depth.near_plane to
  /// depth.far_plane, which is finite. Smoke behind camera.position is not drawn. Such frames have no tanks.
  uint32_t parallel;
} brume_frame_params;

/// Writes what brume_frame_defaults returns into a struct of `struct_size` bytes: for other languages.
BRUME_API brume_result brume_frame_params_init(brume_frame_params* params,
                                               uint32_t struct_size) BRUME_NOEXCEPT;
/// Returns the defaults: a camera at the origin that looks along -z, planes at 0.1 m and 1000 m, smoke of
/// albedo 0.92 under a blue-grey sky, the best quality.
static inline brume_frame_params brume_frame_defaults(void) {
  brume_frame_params params;
  brume_frame_params_init(&params, sizeof params);
  return params;
}

/// Compiles all pipelines that frames like `frame` need in renderers like `renderer`: at all march scales and
/// qualities, with smoke and without, with decals, shadows on surfaces and multisampled depth. `renderer`
/// counts by its lights and flags; null: the defaults. `frame` counts by its `picture.format`
/// (VK_FORMAT_UNDEFINED: no picture), `parallel`, `bounces`, and the volumes and tanks that its camera sees:
/// place it so that it sees all. Frames may then see all of its volumes, one of them, or none; others that
/// are seen together may need more pipelines. Its `commands`, numbers and image views are ignored; null: a
/// frame of smoke without a picture.
///
/// The call records nothing and may run in another thread, while renderers of the device are created and
/// record: they wait at most for a pipeline that they need and that is being compiled. It takes seconds where
/// drivers have no pipelines cached, and meanwhile some MB of device memory and as much as the volumes and
/// tanks need, which no limit of memory counts; your memory functions may be called by both threads at once.
/// Errors: as brume_renderer_create and brume_renderer_record.
BRUME_API brume_result brume_device_compile(brume_device* device, const brume_renderer_params* renderer,
                                            const brume_frame_params* frame) BRUME_NOEXCEPT;

/// Records the smoke of a field as of its last update, volumes and tanks in front of your surfaces, and
/// blends them over your picture p: exposure * radiance + transmittance * p; with decals exposure * radiance
/// + transmittance * (1 - occlusion) * p. `field` may be null: no smoke, and no level. You may change or
/// destroy field, volumes, decals and tanks as soon as the function returns. Errors: BRUME_ERROR_ORDER when a
/// frame number falls; BRUME_ERROR_MISMATCH for a field with other masks than the renderer; BRUME_ERROR_LIMIT
/// when the device has too little memory, or the decals of a frame have more voxels than one image holds;
/// BRUME_ERROR_DEVICE.
BRUME_API brume_result brume_renderer_record(brume_renderer* renderer, const brume_field* field,
                                             const brume_frame_params* params) BRUME_NOEXCEPT;

/// Records up to BRUME_MAX_VIEWS views of one frame, each as brume_renderer_record does, in their order. They
/// have different `view`s, and the same `commands`, `frame_number` and `completed_frame`. All are recorded,
/// or none: where one fails, be it for want of memory, no view of the frame has smoke; the next frame may
/// have to compute all light again, and accumulation starts over. The images that the renderer returns show
/// the last view, and so does brume_renderer_coarseness. Errors: as brume_renderer_record;
/// BRUME_ERROR_ARGUMENT names the view.
BRUME_API brume_result brume_renderer_record_views(brume_renderer* renderer, const brume_field* field,
                                                   const brume_frame_params* const* views,
                                                   size_t view_count) BRUME_NOEXCEPT;

/// Writes the image of smoke, volumes and tanks of the last recorded frame, for your own compositing: half
/// floats with premultiplied radiance, before any exposure, and transmittance in alpha, in
/// VK_IMAGE_LAYOUT_GENERAL, written by compute shaders. It has the renderer's size at any march_scale, with
/// the frame in its top left corner, and can be sampled. Frames, also of other views, may share one image:
/// compute shaders of the next frame must wait for your reads. It is another image after
/// brume_renderer_resize, and when frames begin or cease to have tanks. Either pointer may be null. Errors:
/// BRUME_ERROR_ORDER before the first frame and after a frame that failed.
BRUME_API brume_result brume_renderer_smoke(const brume_renderer* renderer, VkImage* image,
                                            VkImageView* view) BRUME_NOEXCEPT;

/// Writes by how much the smoke of the last recorded frame is coarser because memory is short. Its voxels are
/// 2^level times as wide as the level's voxels and at least as dense, so that it hides no less than it
/// should; 0: full resolution. `is_smoke_missing`, which may be null, receives 1 when smoke out of view has
/// been dropped, so that visible smoke may be brighter than it should be. Before smoke becomes coarser, it
/// does without the light that is finer than its voxels near the camera, which is not reported. Errors:
/// BRUME_ERROR_ORDER as for brume_renderer_smoke.
BRUME_API brume_result brume_renderer_coarseness(const brume_renderer* renderer, uint32_t* level,
                                                 uint32_t* is_smoke_missing) BRUME_NOEXCEPT;

/// Writes the image of the shadows of the last frame's smoke and volumes on your surfaces: half floats, where
/// R, G, B and A are the fractions of brume_frame_params::shadow_lights[0] to [3] that reach the surface of
/// the pixel, 1 without such a light. Shadows of the renderer's triangles are not included. In
/// VK_IMAGE_LAYOUT_GENERAL, written by compute shaders. It is another image after brume_renderer_resize.
/// Either pointer may be null. Errors: BRUME_ERROR_ORDER unless the last frame had shadow_lights.
BRUME_API brume_result brume_renderer_shadows(const brume_renderer* renderer, VkImage* image,
                                              VkImageView* view) BRUME_NOEXCEPT;

/// Writes the image of the motion of the last frame's smoke and volumes, for upscalers and temporal
/// anti-aliasing: half floats. R and G lead from where the smoke of a pixel is to where it was in the view's
/// previous frame [px], to the right and down, without jitter; 0 where the frame does not continue and has no
/// previous camera. B is the distance along the view axis at which the transmittance falls to 0.99 [m], A the
/// mean distance of the smoke's light [m], which R and G follow; both are 65504, the largest half float,
/// where there is none. In VK_IMAGE_LAYOUT_GENERAL, written by compute shaders; frames, also of other views,
/// share one image, which is another one after brume_renderer_resize. Either pointer may be null. Errors:
/// BRUME_ERROR_ORDER before the first frame, after a frame that failed, and unless
/// brume_renderer_params::motion was 1.
BRUME_API brume_result brume_renderer_motion(const brume_renderer* renderer, VkImage* image,
                                             VkImageView* view) BRUME_NOEXCEPT;

/// Writes the image of the occlusion by the last frame's decals: half floats, where R is the fraction of its
/// reflected light that the surface of the pixel loses, 0 without a surface; other channels are internal. In
/// VK_IMAGE_LAYOUT_GENERAL, written by compute shaders. It is another image after each frame. Either pointer
/// may be null. Errors: BRUME_ERROR_ORDER unless the last frame had decals, in view or not.
BRUME_API brume_result brume_renderer_occlusion(const brume_renderer* renderer, VkImage* image,
                                                VkImageView* view) BRUME_NOEXCEPT;

/// The time of a pass.
typedef struct brume_timing {
  char name[32];        ///< Name of the pass.
  double milliseconds;  ///< Its time on the device [ms].
} brume_timing;

/// Writes the times of the newest frame that the device had completed when the last frame was recorded; where
/// that had several views, the times of one of them. No times before that, without
/// brume_renderer_params::timings, and where the queue family has no timestamps
/// (VkQueueFamilyProperties::timestampValidBits is 0).
BRUME_API brume_result brume_renderer_timings(const brume_renderer* renderer, brume_timing* timings,
                                              size_t capacity, size_t* count) BRUME_NOEXCEPT;

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_VULKAN_H
