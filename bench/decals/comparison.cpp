#include "bench/decals/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <optional>

#include "bench/decals/ray_traced_occlusion.hpp"
#include "core/tasks.hpp"
#include "film/playback.hpp"
#include "gpu/read_back.hpp"
#include "image/png.hpp"
#include "scenario/world_triangles.hpp"
#include "scene/moved_objects.hpp"

namespace brume::decals {
namespace {

constexpr double kOffset = 1e-4;  // from surfaces to where rays begin [m]

/// Where the first decal is.
struct DecalBox {
  glm::dmat4 uvw_from_world{1};
  glm::dvec3 up_world{0, 1, 0};
  double fade = 0;
};

DecalBox decal_box(const scenario::Scenario& scenario, double seconds) {
  if (scenario.timeline.decals.empty()) throw Error(ErrorCode::bad_input, "the timeline has no [[decal]]");
  const scene::DecalOptions& options = scenario.timeline.decals.front();
  const scenario::SliceVolume& slices = scenario.slices.of_decals.front();
  const Box<double>& box = (*scenario.slices.volumes)[slices.volume]->front().box;
  const glm::dmat4 world_from_box(scenario::world_from_file(scenario.timeline.carriers, options, seconds) *
                                  slices.file_from_box);
  glm::dmat4 box_from_uvw(1);
  for (int axis = 0; axis < 3; ++axis) box_from_uvw[axis][axis] = box.high[axis] - box.low[axis];
  box_from_uvw[3] = glm::dvec4(box.low, 1);
  return {glm::inverse(world_from_box * box_from_uvw), glm::normalize(glm::dvec3(world_from_box[1])),
          double{options.fade}};
}

std::vector<voxel::Triangle> carried_triangles(const scenario::Scenario& scenario, double seconds) {
  const std::string& name = scenario.timeline.decals.front().carrier;
  std::vector<voxel::Triangle> triangles;
  for (const scene::MovedObject& moved :
       scene::moved_objects(scenario.timeline.carriers, scenario.scene, seconds)) {
    scene::Object object = scenario.scene.objects[moved.object];
    const auto is_carrier = [&](const scene::Carrier& carrier) {
      return carrier.name == name && carrier.object == object.name;
    };
    if (std::none_of(scenario.timeline.carriers.begin(), scenario.timeline.carriers.end(), is_carrier))
      continue;
    object.world_from_mesh = moved.world_from_mesh;
    const auto more = scenario::object_triangles(scenario.scene, object);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  if (triangles.empty())
    throw Error(ErrorCode::bad_input, "the first [[decal]] has no carrier with an object that it moves");
  return triangles;
}

}  // namespace

void Difference::add(double decal, double reference) {
  const double apart = decal - reference;
  ++pixels;
  sum += apart;
  sum_of_squares += apart * apart;
  largest = std::max(largest, std::abs(apart));
  sum_of_reference += reference;
}

void Difference::add(const Difference& other) {
  pixels += other.pixels;
  sum += other.sum;
  sum_of_squares += other.sum_of_squares;
  largest = std::max(largest, other.largest);
  sum_of_reference += other.sum_of_reference;
}

// Rendering.

struct ViewRenderer::Parts {
  gpu::Context& context;
  gpu::CommandRunner& runner;
  const scenario::Scenario& scenario;
  std::unique_ptr<scenario::Simulation> simulation;
  render::Renderer renderer;
  gpu::Buffer depth, normal, occlusion;

  Parts(gpu::Context& context_in, gpu::CommandRunner& runner_in, const scenario::Scenario& scenario_in,
        glm::uvec2 size_px)
      : context(context_in),
        runner(runner_in),
        scenario(scenario_in),
        simulation(scenario::Simulation::create(scenario_in).value_or_throw()),
        renderer(context_in, runner_in, scenario_in.scene, render::RendererOptions{size_px}) {
    const std::size_t pixels = std::size_t{size_px.x} * size_px.y;
    depth = gpu::readback_buffer(context, 4 * pixels);
    for (gpu::Buffer* const buffer : {&normal, &occlusion})
      *buffer = gpu::readback_buffer(context, 8 * pixels);
  }
};

ViewRenderer::ViewRenderer(gpu::Context& context, gpu::CommandRunner& runner,
                           const scenario::Scenario& scenario, glm::uvec2 size_px)
    : parts_(std::make_unique<Parts>(context, runner, scenario, size_px)) {}

ViewRenderer::~ViewRenderer() = default;

View ViewRenderer::draw(double seconds) {
  // Render.
  Parts& in = *parts_;
  in.simulation->advance_to(seconds);
  std::vector<shared::Hole> holes;
  const render::FrameInput input = scenario::frame_input(in.scenario, *in.simulation, seconds, holes);
  in.renderer.draw(input, [&](gpu::Recorder& recorder) {
    const passes::GBuffer& gbuffer = in.renderer.targets().gbuffer;
    recorder.read_back(gbuffer.depth, in.depth);
    recorder.read_back(gbuffer.normal_metallic, in.normal);
    if (in.renderer.occlusion()) recorder.read_back(*in.renderer.occlusion(), in.occlusion);
  });

  // From texels to surfaces.
  const glm::uvec2 size_px = in.renderer.targets().size_px;
  const shared::Camera camera = planning::FramePlan(input, size_px).camera;
  const auto depth = gpu::values_of<float>(in.depth);
  const auto normal = gpu::values_of<std::uint64_t>(in.normal);
  const auto occlusion = gpu::values_of<std::uint64_t>(in.occlusion);
  View view{std::vector<View::Kind>(depth.size(), View::Kind::sky), std::vector<glm::dvec3>(depth.size()),
            std::vector<glm::dvec3>(depth.size()), std::vector<float>(depth.size(), 0)};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] == 0) continue;
    view.kinds[i] =
        shared::moves_of(glm::unpackHalf4x16(normal[i]).a) ? View::Kind::moves : View::Kind::surface;
    const glm::dvec2 ndc = (glm::dvec2(i % size_px.x, i / size_px.x) + 0.5) / glm::dvec2(size_px) * 2.0 - 1.0;
    const glm::dvec3 ray =
        glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) - ndc.y * glm::dvec3(camera.up);
    view.positions_world[i] = glm::dvec3(camera.eye_world) + double{camera.near_z} / double{depth[i]} * ray;
    view.normals[i] = glm::normalize(glm::dvec3(glm::unpackHalf4x16(normal[i])));
    if (in.renderer.occlusion()) view.decal[i] = glm::unpackHalf4x16(occlusion[i]).r;
  }
  return view;
}

// Tracing and comparing.

std::vector<float> trace(const scenario::Scenario& scenario, double seconds, const View& view, int rays) {
  const std::vector<voxel::Triangle> triangles = carried_triangles(scenario, seconds);
  Box<float> bounds = kEmptyBox;
  for (const voxel::Triangle& triangle : triangles)
    for (const glm::vec3 corner : {triangle.a, triangle.b, triangle.c})
      bounds = united(bounds, {corner, corner});
  const glm::dvec3 middle(0.5f * (bounds.low + bounds.high));
  const double radius = 0.5 * glm::length(glm::dvec3(bounds.high - bounds.low));

  const RayTracedOcclusion occluders(triangles, rays);
  std::vector<float> occlusion(view.kinds.size(), 0);
  parallel_for(view.kinds.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (view.kinds[i] != View::Kind::surface) continue;
      // Behind the surface.
      if (glm::dot(middle - view.positions_world[i], view.normals[i]) < -radius) continue;
      occlusion[i] = static_cast<float>(
          occluders.at(view.positions_world[i], view.normals[i], static_cast<std::uint32_t>(i), kOffset));
    }
  });
  return occlusion;
}

Differences compare(const scenario::Scenario& scenario, double seconds, const View& view,
                    const std::vector<float>& reference) {
  const DecalBox box = decal_box(scenario, seconds);
  Differences differences;
  const auto add = [&](Part part, std::size_t i) {
    differences[static_cast<std::size_t>(part)].add(double{view.decal[i]}, double{reference[i]});
  };
  for (std::size_t i = 0; i < view.kinds.size(); ++i) {
    if (view.kinds[i] != View::Kind::surface) continue;
    add(Part::all, i);
    const glm::dvec3 uvw(box.uvw_from_world * glm::dvec4(view.positions_world[i], 1));
    const glm::dvec3 from_face = glm::min(uvw, 1.0 - uvw);
    const double nearest = std::min({from_face.x, from_face.y, from_face.z});
    if (nearest < 0) {
      add(Part::outside, i);
      continue;
    }
    add(Part::inside, i);
    if (nearest < box.fade) add(Part::rim, i);
    const double up = std::abs(glm::dot(view.normals[i], box.up_world));
    add(up > 0.9 ? Part::ceiling_and_floor : up < 0.3 ? Part::wall : Part::oblique, i);
  }
  return differences;
}

Result<void> save_picture(const std::filesystem::path& path, glm::uvec2 size_px, const View& view,
                          const std::vector<float>& reference) {
  constexpr glm::vec3 kElsewhere(0.55f, 0.65f, 0.85f);
  image::Image8 image{3 * size_px.x, size_px.y, {}};
  image.rgba.resize(std::size_t{4} * image.width * image.height);
  const auto set = [&](std::size_t column, std::size_t i, glm::vec3 colour) {
    const std::size_t at = i % size_px.x + column * size_px.x + i / size_px.x * image.width;
    const glm::u8vec4 texel(glm::round(255.0f * glm::vec4(glm::clamp(colour, 0.0f, 1.0f), 1)));
    std::memcpy(&image.rgba[4 * at], &texel, 4);
  };
  for (std::size_t i = 0; i < view.kinds.size(); ++i) {
    const bool compared = view.kinds[i] == View::Kind::surface;
    const float apart = compared ? 4 * (view.decal[i] - reference[i]) : 0;
    set(0, i, compared ? glm::vec3(1 - reference[i]) : kElsewhere);
    set(1, i, compared ? glm::vec3(1 - view.decal[i]) : kElsewhere);
    set(2, i, apart > 0 ? glm::vec3(1, 1 - apart, 1 - apart) : glm::vec3(1 + apart, 1 + apart, 1));
  }
  return image::save_png(path, image);
}

}  // namespace brume::decals
