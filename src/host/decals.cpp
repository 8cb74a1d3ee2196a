#include "host/decals.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "api/ranges.hpp"
#include "core/utf8.hpp"
#include "host/frame.hpp"
#include "host/volumes.hpp"
#include "scene/decal_options.hpp"
#include "volumes/decal_volume.hpp"

using namespace brume::api;

namespace brume::host {
namespace {

static_assert(BRUME_NORMALS_SIGNED == shared::kNormalsSigned &&
              BRUME_NORMALS_UNSIGNED == shared::kNormalsUnsigned &&
              BRUME_NORMALS_OCTAHEDRAL == shared::kNormalsOctahedral &&
              BRUME_NORMALS_OCTAHEDRAL_UNSIGNED == shared::kNormalsOctahedralUnsigned);

constexpr float kFarthest = 1e6f;       // coordinates of a box's corners [m]
constexpr double kShortestEdge = 1e-6;  // [m]
/// Voxels of volumes that stay on the device though the frame does not show them: 32 MiB.
constexpr std::uint64_t kSpareVoxels = 1u << 22;
/// Along an axis of an image; devices have at least a quarter of it.
constexpr std::uint32_t kMostTexels = 16384;

std::uint64_t voxels_of(const grids::DenseVolume& volume) {
  const glm::uvec3 size = volume.front().size;
  return std::uint64_t{size.x} * size.y * size.z;
}

glm::uvec3 checked_voxels(const std::uint32_t (&size)[3]) {
  std::uint64_t voxels = 1;
  for (const std::uint32_t along : size) {
    require(along > 0, "`size` must be at least 1 along each axis");
    voxels = std::min<std::uint64_t>(along, grids::kMostAtlasTexels + 1) * voxels;
    if (voxels > grids::kMostAtlasTexels) fail(BRUME_ERROR_LIMIT, "`size` has more than 2^26 voxels");
  }
  return {size[0], size[1], size[2]};
}

grids::DenseGrid grid_of(const brume_decal_params& params, const char* name, const float* values) {
  grids::DenseGrid grid;
  grid.name = name;
  grid.size = checked_voxels(params.size);
  grid.box = {glm::dvec3(position(params.low, "low")), glm::dvec3(position(params.high, "high"))};
  require(glm::all(glm::lessThan(grid.box.low, grid.box.high)), "`low` must be below `high` along each axis");
  grid.values.assign(values, values + std::uint64_t{grid.size.x} * grid.size.y * grid.size.z);
  if (!std::ranges::all_of(grid.values, [](float value) { return std::isfinite(value); }))
    refuse(std::string("`") + name + "` must be finite");
  return grid;
}

volumes::SampledGrids of_arrays(const brume_decal_params& params) {
  const float& up = required(params.up, "up");
  grids::DenseVolume volume{grid_of(params, "up", &up)};
  volumes::SampledGrids sampled;
  if (params.down) {
    volume.push_back(grid_of(params, "down", params.down));
    sampled.occluder = volumes::occluder_of(volume[0], volume[1]);
  } else {
    volume.push_back(volume.front());
  }
  sampled.volume = std::make_shared<const grids::DenseVolume>(std::move(volume));
  return sampled;
}

volumes::SampledGrids of_file(const brume_decal_params& params) {
  const std::string file = params.file;
  require(!file.empty(), "`file` is empty");
  require(!params.up && !params.down, "`up` and `down` must be null where `file` is given");
  const grids::GridFile grids = loaded(grids::load_volume_file(to_path(file)));
  auto sampled = volumes::decal_volume(grids, params.grid ? params.grid : "");
  if (!sampled)
    fail(result_of(sampled.failure().code, BRUME_ERROR_DATA), file + ": " + sampled.failure().message);
  return *std::move(sampled);
}

DecalData load(const brume_decal_params& params) {
  volumes::SampledGrids sampled = params.file ? of_file(params) : of_arrays(params);
  unwrap(passes::pack_slices({&sampled.volume->front().size, 1}, kMostTexels));
  return {std::move(sampled.volume), sampled.file_from_box, glm::vec3(sampled.occluder.middle),
          static_cast<float>(sampled.occluder.radius)};
}

/// Whether the box of a decal in the world is one that can be inverted and culled in floats.
bool is_placeable(const glm::dmat4& world_from_box, const Box<double>& box) {
  const glm::dvec3 extent = box.high - box.low;
  glm::dvec3 edges[3];
  for (int axis = 0; axis < 3; ++axis) {
    edges[axis] = extent[axis] * glm::dvec3(world_from_box[axis]);
    if (!(glm::length(edges[axis]) >= kShortestEdge)) return false;
  }
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 p(world_from_box * glm::dvec4(box.low, 1));
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) p += edges[axis];
    if (!is_within(glm::vec3(p), -kFarthest, kFarthest)) return false;
  }
  return spans_space(edges[0], edges[1], edges[2]);
}

planning::DecalInput input_of(const brume_shown_decal& shown, const DecalData& data, std::size_t number) {
  const auto check = [&](bool condition, const char* expected) {
    if (!condition) refuse("decal " + std::to_string(number) + ": " + expected);
  };
  const glm::dvec3 x(vec3_of(shown.x_axis)), y(vec3_of(shown.y_axis)), z(vec3_of(shown.z_axis)),
      p(vec3_of(shown.position));
  check(spans_space(x, y, z), "its axes must be finite and span space");
  const glm::dmat4 world_from_space{{x, 0}, {y, 0}, {z, 0}, {p, 1}};
  const glm::mat4 world_from_box(world_from_space * data.space_from_box);
  check(is_placeable(glm::dmat4(world_from_box), data.volume->front().box),
        "its box must lie within 10^6 m of the world's origin and have edges of at least 10^-6 m");
  scene::DecalOptions look;
  look.strength = shown.strength;
  look.gamma = shown.gamma;
  look.correction = shown.correction;
  look.falloff = shown.falloff;
  look.fade = shown.fade;
  look.scatter = shown.scatter;
  scene::visit_decal_options(look, RangeCheck("decal", number));
  return {world_from_box, 0,          shown.strength, shown.gamma, shown.correction,
          shown.falloff,  shown.fade, shown.scatter,  data.middle, data.radius};
}

/// The place of a decal's volume; beyond the last for none.
std::size_t place_of(const DecalData& decal, const grids::DenseVolumes& volumes) {
  const auto same = [&](const auto& volume) { return volume.get() == decal.volume.get(); };
  return static_cast<std::size_t>(std::ranges::find_if(volumes, same) - volumes.begin());
}

/// Volumes of decals, and what they are of.
struct Sliced {
  std::shared_ptr<grids::DenseVolumes> volumes = std::make_shared<grids::DenseVolumes>();
  std::vector<std::weak_ptr<const DecalData>> decals;

  void add(const std::shared_ptr<const DecalData>& decal) {
    if (place_of(*decal, *volumes) < volumes->size()) return;
    volumes->push_back(decal->volume);
    decals.push_back(decal);
  }
  Result<passes::SlicePacking> packed(const gpu::Context& context) const {
    std::vector<glm::uvec3> sizes;
    for (const auto& volume : *volumes) sizes.push_back(volume->front().size);
    return passes::pack_slices(sizes, context.limits().maxImageDimension2D);
  }
};

/// The image of slices for a frame that shows what the one before lacks. Others stay in it, as far as there
/// is room, so that decals shown every other frame are uploaded once.
void replace_slices(std::span<const brume_shown_decal> shown, brume_renderer& renderer) {
  Sliced sliced;
  for (const brume_shown_decal& decal : shown) sliced.add(decal.decal->data);
  Sliced with_others{std::make_shared<grids::DenseVolumes>(*sliced.volumes), sliced.decals};
  std::uint64_t spare = 0;
  for (const auto& other : renderer.sliced) {
    const std::shared_ptr<const DecalData> decal = other.lock();
    if (!decal) continue;
    spare += voxels_of(*decal->volume);
    if (spare > kSpareVoxels) break;
    with_others.add(decal);
  }
  const gpu::Context& context = renderer.device->context;
  if (with_others.packed(context))
    sliced = std::move(with_others);
  else
    unwrap(sliced.packed(context));
  renderer.input.slices = std::move(sliced.volumes);
  renderer.sliced = std::move(sliced.decals);
}

}  // namespace

void add_decals(Call& call, const brume_frame_params& params, brume_renderer& renderer) {
  require(params.decal_count <= shared::kMaxDecals, "at most 32 decals");
  if (params.decal_count == 0) return;
  const std::span shown(&required(params.decals, "decals"), params.decal_count);
  planning::FrameInput& input = renderer.input;
  for (std::size_t i = 0; i < shown.size(); ++i)
    input.decals.push_back(input_of(shown[i], *call.handle(shown[i].decal).data, i));

  const auto is_sliced = [&](const brume_shown_decal& decal) {
    return input.slices && place_of(*decal.decal->data, *input.slices) < input.slices->size();
  };
  if (!std::ranges::all_of(shown, is_sliced)) replace_slices(shown, renderer);
  for (std::size_t i = 0; i < shown.size(); ++i)
    input.decals[i].volume = place_of(*shown[i].decal->data, *input.slices);
}

}  // namespace brume::host

extern "C" {

brume_result brume_decal_create(brume_context* context, const brume_decal_params* params,
                                brume_decal** decal) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(decal, "decal");
    create(decal, owner.settings, brume::host::load(required_params(params)));
  });
}

brume_result brume_decal_destroy(brume_decal* decal) BRUME_NOEXCEPT {
  return destroy(__func__, decal);
}

}  // extern "C"
