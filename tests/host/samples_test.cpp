// A host's depth with four samples per pixel.
#include <algorithm>
#include <array>

#include "brume_host_test_shaders.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/read_back.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

constexpr std::size_t kSamples = 4;

/// What is drawn, and the image for depth, have four samples per pixel.
struct FourSamples {
  static VkResult call(PFN_vkCreateImage real, VkDevice device, const VkImageCreateInfo* info,
                       const VkAllocationCallbacks* callbacks, VkImage* image) {
    VkImageCreateInfo changed = *info;
    if (info->usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) changed.samples = VK_SAMPLE_COUNT_4_BIT;
    return real(device, &changed, callbacks, image);
  }
  static VkResult call(PFN_vkCreateGraphicsPipelines real, VkDevice device, VkPipelineCache cache,
                       std::uint32_t count, const VkGraphicsPipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
    EXPECT_EQ(count, 1u);
    VkGraphicsPipelineCreateInfo changed = *infos;
    VkPipelineMultisampleStateCreateInfo samples = *infos->pMultisampleState;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_4_BIT;
    changed.pMultisampleState = &samples;
    return real(device, cache, count, &changed, callbacks, pipelines);
  }
};

class SamplesTest : public YardTest {
 protected:
  SamplesTest() : YardTest(gpu::HostKind::validated) {}
  void SetUp() override {
    is_temporal_ = false;
    make_smoky();
    gpu::HostDevice on = host_.device();
    on.get_instance_proc_addr = gpu::Interposer::over(
        on.get_instance_proc_addr,
        {BRUME_INTERPOSED(FourSamples, CreateImage), BRUME_INTERPOSED(FourSamples, CreateGraphicsPipelines)});
    drawer_ = std::make_unique<gpu::Context>(on);
    draws_ = std::make_unique<gpu::HostRecording>(*drawer_);
    multisampled_ = gpu::Image(
        *drawer_, {.format = VK_FORMAT_D32_SFLOAT,
                   .size = {kSize, 1},
                   .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    draw_surfaces();
  }
  ~SamplesTest() override {
    host_.wait();
    multisampled_ = {};
    draws_.reset();
    drawer_.reset();
  }
  /// Draws the surfaces; what each sample holds.
  void draw_surfaces() {
    const gpu::GraphicsPipeline pipeline(*drawer_, {&shaders::depth_samples_vert, nullptr, {}});
    const gpu::ComputePipeline probe(*drawer_, shaders::depth_samples_comp);
    const gpu::Sampler nearest(*drawer_, {VK_FILTER_NEAREST});
    const VkDeviceSize bytes = sizeof(float) * kSamples * kSize.x * kSize.y;
    const gpu::Buffer found(*drawer_, bytes,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
        copy = gpu::readback_buffer(*drawer_, bytes);
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      draws_->begin(commands, frame, completed);
      gpu::Recorder& recorder = draws_->recorder();
      gpu::Recorder::Attachments attachments;
      attachments.depth = &multisampled_;
      recorder.begin_rendering(attachments, kSize);
      recorder.bind_for_draws(pipeline, {});
      recorder.draw(9);
      recorder.end_rendering();
      recorder.bind(probe, {{shared::BindingIndex{0, "depth"}, gpu::sampled(multisampled_, nearest)},
                            {shared::BindingIndex{1, "samples"}, gpu::write(found)}});
      recorder.dispatch_threads(probe, kSize.x, kSize.y);
      recorder.read_back(found, copy, bytes);
      draws_->end();
    });
    host_.wait();
    const auto values = gpu::values_of<float>(copy);
    samples_.assign(values.begin(), values.end());
  }
  struct Depth {
    VkImageView view;
    VkImageLayout layout;
    bool has_samples;
  };
  Texels draw_smoke(const Depth& depth) {
    const gpu::Buffer copy = readback_buffer(gpu_);
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      brume_frame_params params = brume_frame_defaults();
      params.commands = commands;
      params.frame_number = frame;
      params.completed_frame = completed;
      params.camera.position = {1.5f, 1.6f, 3};
      params.camera.forward = {1, -0.1f, 0.1f};
      params.depth = {depth.view, depth.layout, 0.1f, INFINITY, 1};
      params.depth_has_samples = depth.has_samples;
      params.seconds = 2.5;
      ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
      VkImage image = VK_NULL_HANDLE;
      ASSERT_OK(brume_renderer_smoke(renderer_, &image, nullptr));
      host_.copy(commands, image, {kSize.x, kSize.y}, copy.handle());
    });
    host_.wait();
    return texels_of(copy);
  }
  Texels draw_multisampled() {
    return draw_smoke({multisampled_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, true});
  }
  /// Over one depth for each pixel.
  Texels draw_resolved(const std::vector<float>& reverse) {
    upload_depths(reverse);
    return draw_smoke({depth_.view(), VK_IMAGE_LAYOUT_GENERAL, false});
  }
  template <typename Choose>
  std::vector<float> resolved(Choose choose) const {
    std::vector<float> depths;
    for (std::size_t i = 0; i < samples_.size(); i += kSamples)
      depths.push_back(choose(std::span(samples_).subspan(i, kSamples)));
    return depths;
  }

  static Pixels pixels(const Texels& texels) {
    Pixels found;
    for (const std::uint64_t texel : texels)
      found.emplace_back(passes::from_half(std::bit_cast<passes::Half4>(texel)));
    return found;
  }
  template <typename Choose>
  Pixels chosen(Choose choose) {
    return pixels(draw_resolved(resolved(choose)));
  }
  Pixels of_sample(std::size_t s) {
    return chosen([&](auto samples) { return samples[s]; });
  }
  /// The root mean square over pixels with several surfaces; objects have radiance 0.3.
  double error_at_edges(const Pixels& drawn, const std::array<Pixels, kSamples>& each, double wall) const {
    double square = 0;
    int edges = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const auto samples = std::span(samples_).subspan(kSamples * i, kSamples);
      if (std::ranges::min(samples) == std::ranges::max(samples)) continue;
      double truth = 0, colour = 0;
      for (std::size_t s = 0; s < kSamples; ++s) {
        const double own = samples[s] < 0.1f / 8 ? wall : 0.3;
        truth += (each[s][i].r + each[s][i].a * own) / kSamples;
        colour += own / kSamples;
      }
      square += std::pow(drawn[i].r + drawn[i].a * colour - truth, 2);
      ++edges;
    }
    return std::sqrt(square / edges);
  }

  std::unique_ptr<gpu::Context> drawer_;
  std::unique_ptr<gpu::HostRecording> draws_;
  gpu::Image multisampled_;
  std::vector<float> samples_;
};

TEST_F(SamplesTest, SmokeEndsAtTheFarthestSample) {
  int edges = 0;
  const Texels drawn = draw_multisampled(), expected = draw_resolved(resolved([&](auto samples) {
                                              edges += std::ranges::min(samples) != std::ranges::max(samples);
                                              return std::ranges::min(samples);
                                            }));
  EXPECT_EQ(drawn, expected);
  EXPECT_GT(edges, 40) << "pixels with several surfaces";
  EXPECT_NE(drawn, draw_resolved(resolved([](auto samples) { return std::ranges::max(samples); })));
}

// Pictures of each sample alone, which a host that shades per sample would show the mean of: no pixel shows
// more of what is behind the smoke than the most hidden of its samples does. A ray that ends earlier samples
// its last step, up to 0.4 voxels long, elsewhere.
TEST_F(SamplesTest, SmokeHidesWhatItHidesOfAnySample) {
  const double step = std::exp(double{brume_field_defaults().extinction} * 0.4 * 0.25);
  const Pixels drawn = pixels(draw_multisampled());
  for (std::size_t s = 0; s < kSamples; ++s) {
    const Pixels one = of_sample(s);
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_LE(drawn[i].a, one[i].a * step + 1 / 4096.0) << i;
  }
}

// How far a pixel with several surfaces is off the mean of its samples, each with its own smoke and colour:
// dark objects before a wall. Over a dark wall every choice does; a bright one shines around objects unless
// the farthest is chosen.
TEST_F(SamplesTest, TheFarthestSampleIsTheLeastWrongAtWorst) {
  std::array<Pixels, kSamples> each;
  for (std::size_t s = 0; s < kSamples; ++s) each[s] = of_sample(s);
  const auto worst = [&](const Pixels& drawn) {
    return std::max(error_at_edges(drawn, each, 0.0), error_at_edges(drawn, each, 1.0));
  };
  const double farthest = worst(pixels(draw_multisampled()));
  const double nearest = worst(chosen([](auto samples) { return std::ranges::max(samples); }));
  const double middle = worst(chosen([](auto samples) {
    std::array<float, kSamples> sorted{};
    std::ranges::copy(samples, sorted.begin());
    std::ranges::sort(sorted);
    return sorted[1];
  }));
  EXPECT_LT(farthest, 0.06);
  EXPECT_LT(farthest, middle);
  EXPECT_LT(3 * farthest, worst(each[0]));
  EXPECT_LT(4 * farthest, nearest);
}

}  // namespace
}  // namespace brume::host
