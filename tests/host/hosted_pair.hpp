// The renderer and the interface, which draw the same frames on a host's device.
#pragma once

#include <bit>
#include <deque>
#include <functional>
#include <glm/gtc/packing.hpp>

#include "gpu/read_back.hpp"
#include "render/renderer.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"
#include "tests/host/hosted_smoke.hpp"
#include "tests/passes/half.hpp"

namespace brume::host {

using Texels = std::vector<std::uint64_t>;  // of half floats

inline gpu::Buffer readback_buffer(gpu::Context& context) {
  return gpu::readback_buffer(context, sizeof(Texels::value_type) * kSize.x * kSize.y);
}

inline Texels texels_of(const gpu::Buffer& buffer) {
  const auto texels = gpu::values_of<Texels::value_type>(buffer);
  return {texels.begin(), texels.end()};
}

using Pixels = std::vector<glm::dvec4>;

inline Pixels pixels_of(const gpu::Buffer& halves) {
  Pixels pixels;
  for (const std::uint64_t texel : gpu::values_of<Texels::value_type>(halves))
    pixels.emplace_back(passes::from_half(std::bit_cast<passes::Half4>(texel)));
  return pixels;
}

/// The largest difference of two images of half floats.
inline double most_apart(const Texels& a, const Texels& b) {
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

/// Draws frames by the renderer itself and by the interface, over the depth of the former.
class HostedPair : public testing::Test {
 protected:
  HostedPair() : scenario_(render::two_smokes(0.6f)) { scenario_.timeline.doors.clear(); }

  void make_sides(std::size_t in_flight, std::uint32_t march_scale) {
    host_.emplace(in_flight, kind_);
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
    radiances_.clear();
    shadows_.clear();
    occlusions_.clear();
    whole_.reset();
    recording_.reset();
    gpu_.reset();
    for (const std::string& message : host_->take_messages()) ADD_FAILURE() << message;
  }

  /// Draws a time by both.
  void draw_both(double seconds, std::uint32_t march_scale) {
    simulation_->advance_to(seconds);
    smoke_->advance_to(seconds);
    EXPECT_EQ(smoke_->world.hash(), simulation_->world().state_hash());
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      if (!whole_) {
        render::RendererOptions options{.size_px = kSize};
        options.smoke.march_scale = march_scale;
        options.smoke.temporal = HostedSmoke::is_temporal;
        whole_ = std::make_unique<render::Renderer>(*gpu_, *recording_, scenario_.scene, options);
      }
      planning::FrameInput input = scenario::frame_input(scenario_, *simulation_, seconds, holes_);
      input.view.frame_index = static_cast<std::uint32_t>(frame);
      if (change_input_) change_input_(input);
      const planning::FramePlan plan = whole_->plan(input);
      whole_->record_frame(recording_->recorder(), plan);
      copies_.push_back(readback_buffer(*gpu_));
      recording_->recorder().read_back(whole_->media(), copies_.back());
      if (reads_radiance_) {
        radiances_.push_back(readback_buffer(*gpu_));
        recording_->recorder().read_back(whole_->radiance(), radiances_.back());
      }
      if (reads_occlusion_ && whole_->occlusion()) {
        occlusions_.push_back(readback_buffer(*gpu_));
        recording_->recorder().read_back(*whole_->occlusion(), occlusions_.back());
      }
      recording_->end();
      record_interface(commands, frame, completed, seconds);
    });
  }
  void record_interface(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed,
                        double seconds) {
    brume_frame_params params = frame_of(scenario_, seconds);
    params.commands = commands;
    params.frame_number = frame;
    params.completed_frame = completed;
    params.jitter_index = static_cast<std::uint32_t>(frame);
    const gpu::Image& depth = whole_->targets().gbuffer.depth;
    params.depth.view = depth.view();
    params.depth.layout = depth.last_use.get(*gpu_).layout;
    if (change_params_) change_params_(params);
    const brume_field* field = shows_field_ ? smoke_->field.get() : nullptr;
    ASSERT_OK(brume_renderer_record(smoke_->renderer, field, &params));
    VkImage image = VK_NULL_HANDLE;
    ASSERT_OK(brume_renderer_smoke(smoke_->renderer, &image, nullptr));
    copies_.push_back(readback_buffer(*gpu_));
    host_->copy(commands, image, {kSize.x, kSize.y}, copies_.back().handle());
    const auto copy = [&](std::deque<gpu::Buffer>& to) {
      to.push_back(readback_buffer(*gpu_));
      host_->copy(commands, image, {kSize.x, kSize.y}, to.back().handle());
    };
    if (reads_shadows_) {
      ASSERT_OK(brume_renderer_shadows(smoke_->renderer, &image, nullptr));
      copy(shadows_);
    }
    if (reads_occlusion_ && params.decal_count > 0) {
      ASSERT_OK(brume_renderer_occlusion(smoke_->renderer, &image, nullptr));
      copy(occlusions_);
    }
  }
  /// Frame i of both within 1/255; what the interface drew.
  Texels expect_same(std::size_t i) const {
    const Texels drawn = texels_of(copies_[2 * i + 1]);
    EXPECT_LE(most_apart(texels_of(copies_[2 * i]), drawn), 1 / 255.0) << "frame " << i;
    return drawn;
  }

  scenario::Scenario scenario_;
  gpu::HostKind kind_ = gpu::kUsualHost;
  std::optional<gpu::HostApplication> host_;
  std::unique_ptr<gpu::Context> gpu_;
  std::unique_ptr<gpu::HostRecording> recording_;
  std::unique_ptr<scenario::Simulation> simulation_;
  std::vector<shared::Hole> holes_;
  std::unique_ptr<render::Renderer> whole_;
  std::unique_ptr<HostedSmoke> smoke_;
  std::deque<gpu::Buffer> copies_;  // of each frame two: whole, interface
  std::deque<gpu::Buffer> radiances_, shadows_;
  std::deque<gpu::Buffer> occlusions_;  // of each frame two, where both have decals in view

  // How frames differ from those of the scenario.
  std::function<void(planning::FrameInput&)> change_input_;
  std::function<void(brume_frame_params&)> change_params_;
  bool shows_field_ = true, reads_radiance_ = false, reads_shadows_ = false, reads_occlusion_ = false;
};

}  // namespace brume::host
