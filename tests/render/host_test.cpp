// A renderer on a host's device, whose commands the host submits, draws what one with a device of its own
// draws.
#include <deque>
#include <set>

#include "planning/device_camera.hpp"
#include "render/renderer.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/gpu/host_application.hpp"
#include "tests/render/two_smokes.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{64, 36};
using Texels = std::vector<std::uint64_t>;  // of half floats

/// The times of frames: smoke that grows, a second one, a shot, a door that opens.
constexpr double kTimes[] = {0.5, 1, 2, 3.25, 3.5, 5.1, 5.2, 9, 9.1, 9.5};

gpu::Buffer readback_buffer(gpu::Context& context) {
  return gpu::readback_buffer(context, sizeof(Texels::value_type) * kSize.x * kSize.y);
}

Texels texels_of(const gpu::Buffer& buffer) {
  const auto texels = gpu::values_of<Texels::value_type>(buffer);
  return {texels.begin(), texels.end()};
}

class HostTest : public gpu::GpuTest {
 protected:
  HostTest()
      : scenario_(two_smokes(0.6f)), simulation_(scenario::Simulation::create(scenario_).value_or_throw()) {}

  FrameInput input_at(double seconds) {
    simulation_->advance_to(seconds);
    return scenario::frame_input(scenario_, *simulation_, seconds, holes_);
  }
  /// The media of all frames as a device of its own draws them.
  std::vector<Texels> drawn() {
    Renderer renderer(context(), runner(), scenario_.scene, {.size_px = kSize});
    std::vector<Texels> frames;
    for (const double seconds : kTimes) {
      renderer.draw(input_at(seconds));
      frames.push_back(read_back<std::uint64_t>(renderer.media()));
      EXPECT_GT(std::set(frames.back().begin(), frames.back().end()).size(), 30u) << "smoke is in view";
    }
    return frames;
  }

  scenario::Scenario scenario_;
  std::unique_ptr<scenario::Simulation> simulation_;
  std::vector<shared::Hole> holes_;
};

/// Records a frame of a renderer that is made in the first one, and a copy of its media.
class HostedRenderer {
 public:
  HostedRenderer(const gpu::HostDevice& device, const scenario::Scenario& scenario)
      : context(device), recording(context, true), scenario_(scenario) {}

  void record(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed,
              const FrameInput& input) {
    recording.begin(commands, frame, completed);
    if (!renderer) renderer.emplace(context, recording, scenario_.scene, RendererOptions{.size_px = kSize});
    const FramePlan plan = renderer->plan(input);
    renderer->record_frame(recording.recorder(), plan);
    copies.push_back(readback_buffer(context));
    recording.recorder().read_back(renderer->media(), copies.back());
    recording.end();
  }

  gpu::Context context;
  gpu::HostRecording recording;
  std::optional<Renderer> renderer;
  std::deque<gpu::Buffer> copies;

 private:
  const scenario::Scenario& scenario_;
};

TEST_F(HostTest, DrawsTheSameWithAnyNumberOfFramesInFlight) {
  const std::vector<Texels> expected = drawn();
  for (const std::size_t in_flight : {1, 2, 3}) {
    gpu::HostApplication host(in_flight);
    {
      HostedRenderer hosted(host.device(), scenario_);
      simulation_ = scenario::Simulation::create(scenario_).value_or_throw();
      for (const double seconds : kTimes)
        host.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
          hosted.record(commands, frame, completed, input_at(seconds));
        });
      host.wait();
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(texels_of(hosted.copies[i]), expected[i]) << in_flight << " in flight, frame " << i;
      EXPECT_FALSE(hosted.recording.timings().empty());
    }
    for (const std::string& message : host.take_messages()) ADD_FAILURE() << message;
  }
}

// A renderer of media alone takes the surfaces from a depth image: that of another renderer.
TEST_F(HostTest, DrawsMediaOverSurfacesOfTheHost) {
  Renderer whole(context(), runner(), scenario_.scene, {.size_px = kSize});
  for (const std::uint32_t scale : {1u, 2u}) {
    whole.set_march_scale(scale);
    RendererOptions options{.size_px = kSize, .media_alone = true};
    options.smoke.march_scale = scale;
    Renderer alone(context(), runner(), scenario_.scene, options);
    simulation_ = scenario::Simulation::create(scenario_).value_or_throw();
    for (const double seconds : {2.0, 5.1}) {
      const FrameInput input = input_at(seconds);
      whole.draw(input);
      const gpu::Image& depth = whole.targets().gbuffer.depth;
      const gpu::Image lent(
          {depth.handle(), depth.view(), depth.info().format, kSize, depth.last_use.get(context()).layout});
      const FramePlan plan = alone.plan(input);
      runner().run([&](gpu::Recorder& recorder) {
        alone.record_over(recorder, plan, {.surfaces = {lent, {planning::kNearPlane, INFINITY, true}}});
      });
      const Texels media = read_back<std::uint64_t>(alone.media());
      EXPECT_GT(std::set(media.begin(), media.end()).size(), 30u);
      EXPECT_EQ(media, read_back<std::uint64_t>(whole.media())) << scale << ", " << seconds;
    }
  }
}

}  // namespace
}  // namespace brume::render
