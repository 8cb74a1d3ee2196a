// The C interface of the renderer draws, in the frames of a host, what the renderer draws by itself.
#include <cstring>
#include <deque>
#include <glm/gtc/packing.hpp>
#include <set>

#include "planning/scenario_frame.hpp"
#include "render/renderer.hpp"
#include "scenario/simulation.hpp"
#include "tests/host/hosted_smoke.hpp"

namespace brume::host {
namespace {

using Texels = std::vector<std::uint64_t>;  // of half floats

gpu::Buffer readback_buffer(gpu::Context& context) {
  return {context, Texels::value_type{8} * kSize.x * kSize.y, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
          gpu::MemoryUse::readback};
}

Texels texels_of(const gpu::Buffer& buffer) {
  Texels texels(buffer.size() / 8);
  std::memcpy(texels.data(), buffer.mapped(), buffer.size());
  return texels;
}

/// The largest difference of two images of half floats.
double most_apart(const Texels& a, const Texels& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int half = 0; half < 4; ++half) {
      const auto value = [&](std::uint64_t texel) {
        return double{glm::unpackHalf1x16(static_cast<std::uint16_t>(texel >> 16 * half))};
      };
      most = std::max(most, std::abs(value(a[i]) - value(b[i])));
    }
  return most;
}

class RendererTest : public testing::Test {
 protected:
  RendererTest() : scenario_(render::two_smokes(0.6f)) { scenario_.timeline.doors.clear(); }

  void make_sides(std::size_t in_flight, std::uint32_t march_scale) {
    host_.emplace(in_flight);
    gpu_ = std::make_unique<gpu::Context>(host_->device());
    recording_ = std::make_unique<gpu::HostRecording>(*gpu_);
    simulation_ = scenario::Simulation::create(scenario_).value_or_throw();
    smoke_ = std::make_unique<HostedSmoke>(host_->device(), scenario_, march_scale);
  }
  void TearDown() override {
    if (!host_) return;
    host_->wait();
    smoke_.reset();
    copies_.clear();
    whole_.reset();
    recording_.reset();
    gpu_.reset();
    for (const std::string& message : host_->take_messages()) ADD_FAILURE() << message;
  }

  /// Draws a time by the renderer itself, then by the interface over the depth of the former.
  void draw_both(double seconds, std::uint32_t march_scale) {
    simulation_->advance_to(seconds);
    smoke_->advance_to(seconds);
    EXPECT_EQ(smoke_->world.hash(), simulation_->world().state_hash());
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      if (!whole_) {
        render::RendererOptions options{.size_px = kSize};
        options.smoke.march_scale = march_scale;
        whole_ = std::make_unique<render::Renderer>(*gpu_, *recording_, scenario_.scene, options);
      }
      planning::FrameInput input = planning::frame_input(scenario_, *simulation_, seconds, holes_);
      input.view.frame_index = static_cast<std::uint32_t>(frame);
      whole_->record_frame(recording_->recorder(), whole_->plan(input));
      copies_.push_back(readback_buffer(*gpu_));
      recording_->recorder().read_back(whole_->media(), copies_.back());
      recording_->end();
      record_interface(commands, frame, completed, seconds);
    });
  }
  void record_interface(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed,
                        double seconds) {
    brume_frame_params params = frame_of(scenario_, seconds);
    params.commands = commands;
    params.frame = frame;
    params.completed = completed;
    params.jitter_index = static_cast<std::uint32_t>(frame);
    const gpu::Image& depth = whole_->targets().gbuffer.depth;
    params.depth.view = depth.view();
    params.depth.layout = depth.last_use.layout;
    ASSERT_OK(brume_renderer_record(smoke_->renderer, smoke_->field.get(), &params));
    VkImage image = VK_NULL_HANDLE;
    ASSERT_OK(brume_renderer_smoke(smoke_->renderer, &image, nullptr));
    copies_.push_back(readback_buffer(*gpu_));
    host_->copy(commands, image, {kSize.x, kSize.y}, copies_.back().handle());
  }

  scenario::Scenario scenario_;
  std::optional<gpu::HostApplication> host_;
  std::unique_ptr<gpu::Context> gpu_;
  std::unique_ptr<gpu::HostRecording> recording_;
  std::unique_ptr<scenario::Simulation> simulation_;
  std::vector<shared::Hole> holes_;
  std::unique_ptr<render::Renderer> whole_;
  std::unique_ptr<HostedSmoke> smoke_;
  std::deque<gpu::Buffer> copies_;  // of each frame two: whole, interface
};

TEST_F(RendererTest, DrawsWhatTheRendererDraws) {
  for (const std::uint32_t march_scale : {1u, 2u}) {
    for (const std::size_t in_flight : {1, 3}) {
      make_sides(in_flight, march_scale);
      for (const double seconds : {0.5, 2.0, 3.25, 3.5, 5.125, 5.25, 6.0}) draw_both(seconds, march_scale);
      host_->wait();
      for (std::size_t i = 0; i < copies_.size(); i += 2) {
        const Texels expected = texels_of(copies_[i]), drawn = texels_of(copies_[i + 1]);
        EXPECT_GT(std::set(drawn.begin(), drawn.end()).size(), 30u) << "smoke is in view";
        EXPECT_LE(most_apart(expected, drawn), 1 / 255.0) << "frame " << i / 2 << ", scale " << march_scale;
      }
      std::size_t count = 0;
      EXPECT_OK(brume_renderer_timings(smoke_->renderer, nullptr, 0, &count));
      EXPECT_GT(count, 3u);
      TearDown();
      host_.reset();
    }
  }
}

// Also while frames that use the images of the size before are in flight.
TEST_F(RendererTest, DrawsTheSameAfterItWasResizedAndBack) {
  make_sides(3, 2);
  draw_both(2.0, 2);
  EXPECT_OK(brume_renderer_resize(smoke_->renderer, 7, 500));
  EXPECT_OK(brume_renderer_resize(smoke_->renderer, kSize.x, kSize.y));
  EXPECT_EQ(brume_renderer_resize(smoke_->renderer, 0, 5), BRUME_ERROR_ARGUMENT);
  draw_both(2.0, 2);
  host_->wait();
  EXPECT_LE(most_apart(texels_of(copies_[2]), texels_of(copies_[3])), 1 / 255.0);
}

TEST_F(RendererTest, RefusesWhatTheHeaderForbids) {
  make_sides(1, 1);
  brume_frame_params params = frame_of(scenario_, 1);
  const auto refused = [&](brume_result expected, const char* words) {
    EXPECT_EQ(brume_renderer_record(smoke_->renderer, smoke_->field.get(), &params), expected);
    EXPECT_NE(std::string(brume_last_error()).find(words), std::string::npos) << brume_last_error();
  };
  refused(BRUME_ERROR_ARGUMENT, "commands");
  host_->frame([&](VkCommandBuffer commands, std::uint64_t, std::uint64_t) {
    params.commands = commands;
    refused(BRUME_ERROR_ORDER, "frame");
    params.frame = 1;
    refused(BRUME_ERROR_ARGUMENT, "depth.view");
    params.depth.view = reinterpret_cast<VkImageView>(1);
    params.depth.near_plane = NAN;
    refused(BRUME_ERROR_ARGUMENT, "near_plane");
    params.depth.near_plane = 0.1f;
    params.camera.forward = {0, 0, 0};
    refused(BRUME_ERROR_ARGUMENT, "camera.forward");
    params.camera.forward = {0, 0, -1};
    params.camera.position.x = INFINITY;
    refused(BRUME_ERROR_ARGUMENT, "camera.position");
    params.camera.position.x = 0;
    params.look.noise_size = 0;
    refused(BRUME_ERROR_ARGUMENT, "noise_size");
    params.look.noise_size = 1;
    params.light_count = 1;
    refused(BRUME_ERROR_ARGUMENT, "lights");
    params.light_count = 0;
    params.struct_size = 3;
    refused(BRUME_ERROR_ARGUMENT, "struct_size");
  });
  EXPECT_EQ(brume_renderer_record(nullptr, smoke_->field.get(), &params), BRUME_ERROR_HANDLE);
  EXPECT_EQ(brume_device_destroy(smoke_->device), BRUME_ERROR_ORDER);
  EXPECT_EQ(brume_renderer_smoke(smoke_->renderer, nullptr, nullptr), BRUME_ERROR_ORDER);
}

}  // namespace
}  // namespace brume::host
