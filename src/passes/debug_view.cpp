#include "passes/debug_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "brume_shaders.hpp"
#include "core/error.hpp"
#include "shared/display.h"
#include "shared/resolve.h"

namespace brume::passes {
namespace {

constexpr int kNodeVoxels = 64;
constexpr std::uint32_t kEntriesPerNode = 512, kWordsPerBrick = 16;

std::uint32_t glyph_of(char c) {
  if (c >= '0' && c <= '9') return static_cast<std::uint32_t>(c - '0');
  return c == '.' ? shared::kGlyphPoint : c == 'm' ? shared::kGlyphMetre : shared::kGlyphPlus;
}

std::uint32_t label_of(std::string_view text) {
  std::uint32_t label = 0;
  for (std::uint32_t i = 0; i < shared::kLabelGlyphs; ++i)
    label |= (i < text.size() ? glyph_of(text[i]) : shared::kGlyphNone) << (5 * i);
  return label;
}

/// A number and what follows it, in at most kLabelGlyphs glyphs.
std::uint32_t label_of(float number, const char* behind) {
  char text[24];
  const int decimals = number == std::floor(number) || number >= 100 ? 0
                       : number * 2 == std::floor(number * 2)        ? 1
                                                                     : 2;
  std::snprintf(text, sizeof text, "%.*f%s", decimals, static_cast<double>(number), behind);
  return label_of(text);
}

glm::uvec3 labels_of(DebugView view, float full) {
  const auto numbers = [](float begin, float middle, float end, const char* unit, const char* last) {
    return glm::uvec3(label_of(begin, unit), label_of(middle, unit), label_of(end, last));
  };
  switch (view) {
    case DebugView::distance:
      return numbers(0, full / 2, full, "m", "m");
    case DebugView::density:
    case DebugView::bricks:
      return numbers(0, full / 2, full, "", "");
    case DebugView::holes:
      return numbers(0, full / 2, full, "m", "m+");
    case DebugView::steps:
    case DebugView::overdraw:
      return numbers(0, full / 2, full, "", "+");
    case DebugView::depth:
      return numbers(shared::kDepthFar, std::sqrt(shared::kDepthNear * shared::kDepthFar), shared::kDepthNear,
                     "m", "m");
    default:
      return glm::uvec3(0);
  }
}

bool needs_level(DebugView view) {
  return view == DebugView::solid || view == DebugView::density || view == DebugView::light;
}

/// The level as lib/voxel_rays.glsl reads it.
std::vector<std::uint32_t> words_of_level(const voxel::BitGrid& grid, glm::ivec3 root_size) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(root_size.x) *
                                   static_cast<std::size_t>(root_size.y) *
                                   static_cast<std::size_t>(root_size.z));
  const auto append = [&](std::uint32_t count) {
    if (words.size() + count > 0xffffffffu)
      throw Error(ErrorCode::resource_limit, "the level has too many voxels to be shown; use larger voxels");
    words.resize(words.size() + count);
    return static_cast<std::uint32_t>(words.size() - count);
  };
  grid.for_each_brick([&](glm::ivec3 at, const voxel::BitGrid::Brick& brick) {
    const glm::ivec3 n = at >> 3, b = at & 7;
    const auto root = static_cast<std::size_t>(n.x + root_size.x * (n.y + root_size.y * n.z));
    if (words[root] == 0) words[root] = append(kEntriesPerNode);  // grows `words`: not in one expression
    const std::size_t entry = words[root] + static_cast<std::size_t>(b.x + 8 * (b.y + 8 * b.z));
    const std::uint32_t first = append(kWordsPerBrick);
    words[entry] = first;
    for (std::size_t z = 0; z < brick.size(); ++z) {
      words[first + 2 * z] = static_cast<std::uint32_t>(brick[z]);
      words[first + 2 * z + 1] = static_cast<std::uint32_t>(brick[z] >> 32);
    }
  });
  return words;
}

}  // namespace

std::optional<DebugView> find_debug_view(std::string_view name) {
  const auto found = std::find(kDebugViewNames.begin(), kDebugViewNames.end(), name);
  if (found == kDebugViewNames.end()) return std::nullopt;
  return static_cast<DebugView>(found - kDebugViewNames.begin());
}

float ramp_end(DebugView view, const sim::State& state) {
  if (view == DebugView::holes) return 2;
  if (view == DebugView::steps) return 96;
  if (view == DebugView::overdraw) return 128;
  if (view != DebugView::distance) return 1;
  std::uint32_t farthest = 0;
  for (const sim::LiveCloud& live : state.clouds)
    for (const std::uint32_t distance : live.cloud->distances())
      if (distance != sim::Cloud::kNoDistance) farthest = std::max(farthest, distance);
  const float voxels = static_cast<float>(farthest) / static_cast<float>(sim::kFaceStep);
  return std::max(std::ceil(voxels * state.layout.voxel_size), 1.0f);
}

DebugViewPass::DebugViewPass(gpu::Context& context)
    : context_(context),
      nearest_(context, {VK_FILTER_NEAREST}),
      nothing_(context, sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {}

void DebugViewPass::reserve(const DebugSubject& subject, glm::uvec2 size_px) {
  auto& pipeline = pipelines_[static_cast<std::size_t>(subject.view)];
  if (!pipeline) {
    pipeline.emplace(context_, shaders::debug_view_comp,
                     std::vector<std::uint32_t>{static_cast<std::uint32_t>(subject.view)});
  }
  if (needs_level(subject.view)) find_level(subject.level);
  if (subject.view == DebugView::distance) find_distances(subject);
  if (subject.view == DebugView::steps)
    gpu::grow(context_, counters_, sizeof(std::uint32_t) * (1 + std::uint64_t{size_px.x} * size_px.y));
}

void DebugViewPass::find_level(const LevelView& level) {
  if (seen_level_ == level) return;
  root_size_ = level.grid ? (level.grid->size() + (kNodeVoxels - 1)) / kNodeVoxels : glm::ivec3(1);
  level_words_ = level.grid ? words_of_level(*level.grid, root_size_) : std::vector<std::uint32_t>(1);
  gpu::grow(context_, level_, level_words_.size() * sizeof(std::uint32_t));
  seen_level_ = level;
}

void DebugViewPass::find_distances(const DebugSubject& subject) {
  distance_words_.assign(1, 0);
  if (subject.volume && subject.state) {
    distance_words_.assign(std::max<std::size_t>(subject.volume->slot_count(), 1) * smoke::kVoxelsPerBrick,
                           0);
    for (const sim::LiveCloud& live : subject.state->clouds) {
      const sim::Cloud& cloud = *live.cloud;
      const sim::CloudPhase phase = cloud.phase(subject.state->tick);
      cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
        const std::uint32_t slot = subject.volume->slot_at(voxel >> 3);
        if (slot == smoke::SmokeBricks::kNoSlot || cloud.density(rank, phase) == 0) return;
        const std::uint32_t distance = cloud.distances()[rank];
        const std::uint32_t word = distance == sim::Cloud::kNoDistance ? shared::kUnreached : distance + 1;
        std::uint32_t& entry =
            distance_words_[std::size_t{slot} * smoke::kVoxelsPerBrick + smoke::local_voxel(voxel)];
        entry = entry == 0 ? word : std::min(entry, word);
      });
    }
  }
  gpu::grow(context_, distances_, distance_words_.size() * sizeof(std::uint32_t));
}

void DebugViewPass::record(gpu::Recorder& recorder, const DebugSubject& subject, const Inputs& in,
                           const gpu::Image& display) {
  // What changed in the level and the distances.
  if (!level_words_.empty()) recorder.upload(level_, 0, std::as_bytes(std::span(level_words_)));
  if (!distance_words_.empty()) recorder.upload(distances_, 0, std::as_bytes(std::span(distance_words_)));
  level_words_ = {};
  distance_words_ = {};

  shared::DebugViewParams params{};
  const voxel::GridLayout grid = subject.level.grid ? subject.level.grid->layout() : voxel::GridLayout();
  params.grid_size = grid.size;
  params.voxel_size = grid.voxel_size;
  params.grid_origin_world = grid.origin_world;
  params.root_size = root_size_;
  params.slice_axis = static_cast<int>(subject.slice.axis);
  params.slice_world = subject.slice.at_world;
  params.full = ramp_end(subject.view, subject.state ? *subject.state : sim::State());
  params.labels = labels_of(subject.view, params.full);

  // Every view has the same bindings, whatever it reads.
  const gpu::Buffer& level = level_ ? level_ : nothing_;
  const gpu::Buffer& distances = distances_ ? distances_ : nothing_;
  const gpu::Buffer& counters = counters_ ? counters_ : nothing_;
  const gpu::ComputePipeline& pipeline = *pipelines_[static_cast<std::size_t>(subject.view)];
  recorder.bind(pipeline, {in.smoke.bindings(), in.holes.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindAlbedoRoughness, gpu::sampled(in.gbuffer.albedo_roughness, nearest_)},
                    {shared::kBindNormalMetallic, gpu::sampled(in.gbuffer.normal_metallic, nearest_)},
                    {shared::kBindDepth, gpu::sampled(in.surfaces, nearest_)},
                    {shared::kBindLevelWords, gpu::read(level)},
                    {shared::kBindDistances, gpu::read(distances)},
                    {shared::kBindMarchCounters, gpu::read(counters)},
                    {shared::kBindRadiance, gpu::read_stored(in.quads)},
                    {shared::kBindDisplay, gpu::stored(display)},
                },
                params);
  recorder.dispatch_threads(pipeline, display.info().size.x, display.info().size.y);
}

}  // namespace brume::passes
