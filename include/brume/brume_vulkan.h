// The C interface of Brume's renderer: smoke in the Vulkan frames of a host. Library: libbrume, which has all
// of brume.h, too. Walk through: docs/rendering-in-a-host.md.
//
//   context --> device --> renderer --,
//   world --> state --> field --------+--> brume_renderer_record: commands in the host's command buffer
//   context --> volume, decal, tank --'
//
// Everything that brume.h says of results, handles, threads and structs holds here. Besides:
//
// Submitting  Nothing submits or waits for the device. Functions that take a command buffer, in the recording
//             state and outside of a rendering, only record. The commands are submitted to one queue, in the
//             order of their frames; where those of one are not, none of a later frame may be.
// Frames      Each has a number of the host, which rises. The host says up to which frame the device has
//             completed all commands; any number of frames may be in flight. What a frame uses is destroyed
//             after that.
// Failures    After an error of brume_renderer_record nothing was added to the command buffer. But for wrong
//             arguments, its number is used up and the images of the last frame are gone; the next frame
//             uploads everything again.
// Positions   Within 16384 m of the origin along each axis.
// Images      Of the host: in the layout that the struct names, before and after. Writes to them must be
//             visible to the stages that the struct names, and later accesses of the host wait for these
//             stages.
// Threads     Renderers of one device record one after the other.
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

/// Returns a constant chain for VkDeviceCreateInfo::pNext: a VkPhysicalDeviceFeatures2 and what follows it,
/// the features that the host's device must have enabled. It must also be of Vulkan 1.3 and have subgroup
/// vote, arithmetic and ballot in compute shaders.
BRUME_API const void* brume_vulkan_features(void) BRUME_NOEXCEPT;

/// The Vulkan device of the host.
typedef struct brume_device_params {
  uint32_t struct_size;
  const void* next;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< By which all other functions are found.
  VkInstance instance;                               ///< Of the host.
  VkPhysicalDevice physical_device;                  ///< Of `device`.
  VkDevice device;                                   ///< With brume_vulkan_features().
  uint32_t queue_family;                             ///< Of the command buffers, with graphics and compute.
  /// Of the host's own allocation of the device's memory, by both functions or neither; null:
  /// vkAllocateMemory and vkFreeMemory. Called within functions of the device and its renderers, on their
  /// thread; neither may call Brume.
  void* memory_user;
  /// Returns memory of info's size and type that nothing else uses or maps.
  VkResult (*allocate_memory)(void* memory_user, const VkMemoryAllocateInfo* info, VkDeviceMemory* memory);
  /// Frees what `allocate_memory` returned.
  void (*free_memory)(void* memory_user, VkDeviceMemory memory, VkDeviceSize size);
} brume_device_params;

static inline brume_device_params brume_device_defaults(void) {
  brume_device_params params = {sizeof(brume_device_params),
                                BRUME_NULL,
                                BRUME_NULL,
                                VK_NULL_HANDLE,
                                VK_NULL_HANDLE,
                                VK_NULL_HANDLE,
                                0,
                                BRUME_NULL,
                                BRUME_NULL,
                                BRUME_NULL};
  return params;
}

/// Borrows the host's device, which must outlive it. Errors: BRUME_ERROR_DEVICE.
BRUME_API brume_result brume_device_create(brume_context* context, const brume_device_params* params,
                                           brume_device** device) BRUME_NOEXCEPT;
/// All renderers must have been destroyed (else BRUME_ERROR_ORDER), and the device must have completed all
/// frames, which is not checked.
BRUME_API brume_result brume_device_destroy(brume_device* device) BRUME_NOEXCEPT;
/// Writes the bytes of device memory that its renderers use at present, beside what frames in flight still
/// use and the memory of the CPU that uploads go through.
BRUME_API brume_result brume_device_memory(const brume_device* device, uint64_t* bytes) BRUME_NOEXCEPT;
/// From the next frame on the device's renderers use no more than `bytes` of device memory, beside what
/// frames in flight still use; UINT64_MAX, as in the beginning: as much as the device has. Images of the
/// frame's size, and for each renderer a reserve of 512 bricks of smoke with their light, are neither refused
/// nor given back.
/// Smoke that has too little room, here or on the device, becomes coarser instead of invisible: see
/// brume_renderer_coarseness.
BRUME_API brume_result brume_device_set_memory_limit(brume_device* device, uint64_t bytes) BRUME_NOEXCEPT;

// ---- Renderer ----

typedef enum brume_light_kind {
  BRUME_LIGHT_POINT = 0,
  BRUME_LIGHT_SPOT = 1,
  BRUME_LIGHT_SUN = 2  ///< The same light from one direction everywhere.
} brume_light_kind;

/// A light.
typedef struct brume_light {
  uint32_t kind;          ///< brume_light_kind.
  brume_point position;   ///< [m]; of a sun ignored.
  brume_point direction;  ///< In which the light travels, any length but 0; of a point light ignored.
  float intensity[3];     ///< Per channel, [0, 10^12]: [W/sr]; of a sun the irradiance [W/m^2].
  float inner_angle;      ///< Of a spot, from its axis [rad]: full inside, [0, outer_angle).
  float outer_angle;      ///< None outside, (0, pi]; between them as glTF recommends (KHR_lights_punctual).
} brume_light;

/// What a renderer is created with.
typedef struct brume_renderer_params {
  uint32_t struct_size;
  const void* next;
  uint32_t width, height;  ///< Of the host's depth and picture [px], [1, 16384].
  /// Pixels per ray of the march along each axis: 1, 2 or 4. 2 and 4 are faster and show nothing that 1
  /// hides.
  uint32_t march_scale;
  uint32_t temporal;  ///< 1: smoke is accumulated over the frames that continue each other.
  /// Lights that stay, with shadow maps. At most 1024.
  const brume_light* lights;
  size_t light_count;  ///< Of `lights`.
  /// What casts shadows into the smoke: triangles, as in brume_triangles_params. None: nothing does.
  const brume_point* points;
  size_t point_count;        ///< Of `points`.
  const uint32_t* indices;   ///< Three numbers of points for each triangle.
  size_t index_count;        ///< A multiple of 3.
  const brume_masks* masks;  ///< Those of the fields that it shows; null: none.
  /// 1: its first frame prepares what any later frame of smoke needs, of all march scales, so that none waits
  /// for a pipeline.
  uint32_t prepare_all;
} brume_renderer_params;

static inline brume_renderer_params brume_renderer_defaults(void) {
  brume_renderer_params params = {sizeof(brume_renderer_params),
                                  BRUME_NULL,
                                  1280,
                                  720,
                                  1,
                                  0,
                                  BRUME_NULL,
                                  0,
                                  BRUME_NULL,
                                  0,
                                  BRUME_NULL,
                                  0,
                                  BRUME_NULL,
                                  0};
  return params;
}

/// Creates a renderer; its first frame uploads what it needs. The arrays are copied.
BRUME_API brume_result brume_renderer_create(brume_device* device, const brume_renderer_params* params,
                                             brume_renderer** renderer) BRUME_NOEXCEPT;
/// What frames in flight use is destroyed later: see brume_device_destroy.
BRUME_API brume_result brume_renderer_destroy(brume_renderer* renderer) BRUME_NOEXCEPT;
/// Frames of another size from the next one on. A film starts over.
BRUME_API brume_result brume_renderer_resize(brume_renderer* renderer, uint32_t width,
                                             uint32_t height) BRUME_NOEXCEPT;

/// Another brume_renderer_params::march_scale, 1, 2 or 4, from the next frame on.
BRUME_API brume_result brume_renderer_set_march_scale(brume_renderer* renderer,
                                                      uint32_t march_scale) BRUME_NOEXCEPT;

// ---- Frames ----

/// The camera of a frame.
typedef struct brume_camera {
  brume_point position;  ///< [m]
  brume_point forward;   ///< Any length but 0.
  brume_point up;        ///< Of the picture; any length but 0.
  float vertical_fov;    ///< [rad], (0, pi). Pixels are square.
  /// The jitter of the host: from the middle of each pixel to the point that it shows, to the right [px],
  /// [-1, 1].
  float jitter_x;
  float jitter_y;  ///< Downwards [px], [-1, 1].
} brume_camera;

/// The depth of the surfaces that the host drew with the same camera.
typedef struct brume_depth {
  VkImageView view;      ///< Its depth aspect, of the renderer's size, with VK_IMAGE_USAGE_SAMPLED_BIT.
  VkImageLayout layout;  ///< One in which it can be sampled. Stage: compute shaders, sampled reads.
  float near_plane;      ///< [m], in (0, 16384). Depth is that of a perspective projection onto [0, 1].
  float far_plane;       ///< [m], above near_plane; may be infinite. Depth of far_plane: no surface.
  uint32_t reversed;     ///< 1: the depth is 1 at near_plane and 0 at far_plane.
} brume_depth;

typedef enum brume_normal_encoding {
  BRUME_NORMALS_SIGNED = 0,    ///< x, y and z in r, g and b, of any length.
  BRUME_NORMALS_UNSIGNED = 1,  ///< 2 rgb - 1 is that.
  /// r and g in [-1, 1] are x and y of the octahedron |x| + |y| + |z| = 1; its half of z < 0 is folded over
  /// the other: (x, y) becomes ((1 - |y|) sign(x), (1 - |x|) sign(y)).
  BRUME_NORMALS_OCTAHEDRAL = 2,
  BRUME_NORMALS_OCTAHEDRAL_UNSIGNED = 3  ///< 2 rg - 1 is that.
} brume_normal_encoding;

/// The normals of the surfaces that the host drew, which decals darken.
typedef struct brume_normals {
  /// Of the renderer's size, of a format that shaders read as floats, with VK_IMAGE_USAGE_SAMPLED_BIT; null:
  /// the normals are those of the planes through the depths of neighbouring pixels, and face the camera. The
  /// same replaces a normal that is 0 or not finite.
  VkImageView view;
  VkImageLayout layout;  ///< One in which it can be sampled. Stage: compute shaders, sampled reads.
  uint32_t encoding;     ///< brume_normal_encoding.
  uint32_t of_view;      ///< 1: along the camera's right, up, and towards the viewer; 0: of the world.
  /// 1: decals do not darken surfaces where its alpha is 0: what moves, and what they were baked of.
  uint32_t alpha_receives;
} brume_normals;

/// The host's picture, which smoke is blended over.
typedef struct brume_picture {
  VkImageView view;  ///< Of the renderer's size, with VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT; null: none.
  VkFormat format;   ///< One that can be blended. Radiance should be linear in it: half floats, for example.
  /// In VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL. Stage: colour attachment output, reads and writes.
  float exposure;  ///< Multiplies the smoke's radiance, in (0, 10^9).
} brume_picture;

/// How smoke looks; its shape in the large is that of the field.
typedef struct brume_smoke_look {
  float albedo[3];            ///< [0, 1].
  float anisotropy;           ///< Mean cosine of the phase function, (-1, 1).
  float multiple_scattering;  ///< Weight of light that is scattered more than once, [0, 1].
  float erosion;              ///< How much noise erodes, [0, 1].
  float noise_size;           ///< Of its largest billows [m], [0.05, 100].
  float hole_rim;             ///< How far noise frays the rims of holes [m], [0, 1].
  float swirl;                ///< How far noise swirls [m], [0, 10].
  float rise;                 ///< How fast noise rises [m/s], [-10, 10].
} brume_smoke_look;

/// What a frame may save. 0 in each: the best.
typedef struct brume_quality {
  float step_scale;           ///< Multiplies the steps of the march, [0.25, 16]; 0: 1.
  float resolve_error_scale;  ///< The same of the error of a reduced march, [0.25, 16]; 0: 1.
  uint32_t no_fine_shadows;   ///< 1: noise does not shadow itself, which takes up to a third of the march.
  /// About which fraction of the light that changed is found in this frame, [1/16, 1]; 0: all. Below 1 it is
  /// as old as the inverse of that in frames.
  float light_update_fraction;
  float bounce_update_fraction;  ///< The same of brume_frame_params::bounces.
  /// Bytes of a large volume that are uploaded in this frame; until all are, it is shown at a lower
  /// resolution. 0: all at once.
  uint64_t volume_upload_bytes;
} brume_quality;

/// Lights whose shadows of a frame's media the host may ask for.
#define BRUME_MAX_SHADOW_LIGHTS 4

/// All that changes from frame to frame.
typedef struct brume_frame_params {
  uint32_t struct_size;
  const void* next;
  VkCommandBuffer commands;  ///< In the recording state, outside of a rendering.
  uint64_t frame;            ///< Above that of the frame before, of all renderers of the device; from 1.
  uint64_t completed;        ///< The last frame that the device has completed, never falling; 0: none.
  brume_camera camera;       ///< That of the depth and the picture.
  brume_depth depth;         ///< What hides smoke.
  brume_picture picture;     ///< What smoke is blended over, and decals darken.
  brume_smoke_look look;     ///< Extinction is the field's: but for noise, players see what queries find.
  double seconds;            ///< The clock of noise and holes [s], [0, 10^7]; usually the state's.
  /// Moves the jitter of the march, usually up by one a frame; equal numbers give equal smoke.
  uint32_t jitter_index;
  uint32_t continues;  ///< 1: the next frame of a film (brume_renderer_params::temporal).
  float ambient[3];    ///< Light of the sky, [0, 10^6]: radiance (0.75 + 0.375 y) times it from height y.
  float bounce;        ///< The fraction of it where no sky is visible, [0, 1].
  /// How often surfaces of the level, which are white, and smoke pass light on to each other, [0, 16]. 0:
  /// never, and a formula stands for light that is scattered more than once.
  uint32_t bounces;
  /// Lights of this frame, shadowed by voxels: muzzle flashes, moving lights. At most 64; no suns.
  const brume_light* lights;
  size_t light_count;                 ///< Of `lights`.
  const brume_shown_volume* volumes;  ///< At most 32; they may overlap each other and the smoke.
  size_t volume_count;                ///< Of `volumes`.
  /// Lights for brume_renderer_shadows, by their number: those of the renderer, then those of the frame.
  uint32_t shadow_lights[BRUME_MAX_SHADOW_LIGHTS];
  uint32_t shadow_light_count;      ///< [0, BRUME_MAX_SHADOW_LIGHTS].
  brume_quality quality;            ///< What the frame may save.
  const brume_shown_decal* decals;  ///< At most 32; of several what they leave of the light multiplies.
  size_t decal_count;               ///< Of `decals`.
  brume_normals normals;            ///< Of the surfaces that they darken.
  const brume_shown_tank* tanks;    ///< At most 4. Paths are chosen by `jitter_index`, as the march's jitter.
  size_t tank_count;                ///< Of `tanks`.
  /// How much is left out of what noise has below a tenth of look.noise_size, [0, 1]. 0: all is drawn, as
  /// brume_drawn_params::detail = 1 has it; 1: none, which takes a quarter off the march.
  float less_detail;
  uint32_t reserved;  ///< 0.
} brume_frame_params;

static inline brume_frame_params brume_frame_defaults(void) {
  brume_frame_params params = {
      sizeof(brume_frame_params),
      BRUME_NULL,
      VK_NULL_HANDLE,
      0,
      0,
      {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}, 1.0f, 0.0f, 0.0f},
      {VK_NULL_HANDLE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0.1f, 1000.0f, 0},
      {VK_NULL_HANDLE, VK_FORMAT_UNDEFINED, 1.0f},
      {{0.92f, 0.92f, 0.92f}, 0.2f, 1.0f, 0.5f, 1.5f, 0.06f, 0.2f, 0.12f},
      0.0,
      0,
      0,
      {0.25f, 0.29f, 0.35f},
      0.2f,
      0,
      BRUME_NULL,
      0,
      BRUME_NULL,
      0,
      {0, 0, 0, 0},
      0,
      {0.0f, 0.0f, 0, 0.0f, 0.0f, 0},
      BRUME_NULL,
      0,
      {VK_NULL_HANDLE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, BRUME_NORMALS_SIGNED, 0, 0},
      BRUME_NULL,
      0,
      0.0f,
      0};
  return params;
}

/// Records the smoke of a field, as of its last update, volumes and tanks in front of the host's surfaces,
/// and blends them over the host's picture p: exposure * radiance + transmittance * p; with decals exposure *
/// radiance + transmittance * (1 - occlusion) * p. `field` may be null: no smoke, and no level. Field,
/// volumes, decals and tanks may change as soon as the function returns. Errors: BRUME_ERROR_MISMATCH for a
/// field with other masks; BRUME_ERROR_LIMIT when the device has too little memory, or the decals of a frame
/// more voxels than one image holds; BRUME_ERROR_DEVICE.
BRUME_API brume_result brume_renderer_record(brume_renderer* renderer, const brume_field* field,
                                             const brume_frame_params* params) BRUME_NOEXCEPT;

/// The smoke of the last recorded frame, for hosts that blend it themselves: half floats, premultiplied
/// radiance and, in alpha, transmittance, in VK_IMAGE_LAYOUT_GENERAL, written by compute shaders.
/// Tanks are part of it. BRUME_ERROR_ORDER before the first frame and after one that failed; another image
/// after brume_renderer_resize, and where frames begin or end to have tanks. Either pointer may be null.
BRUME_API brume_result brume_renderer_smoke(const brume_renderer* renderer, VkImage* image,
                                            VkImageView* view) BRUME_NOEXCEPT;

/// Writes how coarse the smoke of the last recorded frame is for want of memory: its voxels are 2^level times
/// as wide as those of the level, and at least as dense, so that it hides what it should. 0: as it should be.
/// `dims_less`, which may be null: 1 where smoke out of view dims less light than it should.
BRUME_API brume_result brume_renderer_coarseness(const brume_renderer* renderer, uint32_t* level,
                                                 uint32_t* dims_less) BRUME_NOEXCEPT;

/// The shadows of the last frame's smoke and volumes on the host's surfaces: half floats, in R, G, B and A
/// which fraction of brume_frame_params::shadow_lights[0] to [3] they let through to the surface of the
/// pixel, 1 without one; the shadows of the renderer's triangles are not in it. In VK_IMAGE_LAYOUT_GENERAL,
/// written by compute shaders. BRUME_ERROR_ORDER unless the last frame had shadow_lights; another image after
/// brume_renderer_resize. Either pointer may be null.
BRUME_API brume_result brume_renderer_shadows(const brume_renderer* renderer, VkImage* image,
                                              VkImageView* view) BRUME_NOEXCEPT;

/// The occlusion of the last frame by its decals: half floats, in R which fraction of the light that it
/// reflects the surface of the pixel loses, 0 without a surface; the other channels are the renderer's own.
/// In VK_IMAGE_LAYOUT_GENERAL, written by compute shaders. BRUME_ERROR_ORDER unless the last frame had
/// decals, in view or not; another image after each frame. Either pointer may be null.
BRUME_API brume_result brume_renderer_occlusion(const brume_renderer* renderer, VkImage* image,
                                                VkImageView* view) BRUME_NOEXCEPT;

/// The time that a pass took.
typedef struct brume_timing {
  char name[32];        ///< Of a pass.
  double milliseconds;  ///< On the device.
} brume_timing;

/// Writes the times of the newest frame that the device had completed when the last one was recorded; none
/// before that.
BRUME_API brume_result brume_renderer_timings(const brume_renderer* renderer, brume_timing* timings,
                                              size_t capacity, size_t* count) BRUME_NOEXCEPT;

#ifdef __cplusplus
}  // extern "C"
#endif

#endif  // BRUME_BRUME_VULKAN_H
