#include "bench/frames.hpp"

#include "film/read_back.hpp"
#include "planning/device_camera.hpp"

namespace brume::bench {

RepeatedFrame::RepeatedFrame(gpu::Context& context, const scenario::Scenario& scenario,
                             const render::RendererOptions& options, double seconds)
    : context_(context),
      simulation_(scenario::Simulation::create(scenario).value_or_throw()),
      runner_(context),
      renderer_(context, runner_, scenario.scene, options),
      counter_(gpu::readback_buffer(context, sizeof(std::uint32_t))) {
  simulation_->advance_to(seconds);
  input_ = scenario::frame_input(scenario, *simulation_, seconds, holes_);
  input_.quality.rebuild_light = true;
  input_.quality.indirect_update_fraction = 0.125f;  // as the viewer
}

FrameCost RepeatedFrame::draw() {
  ++input_.view.frame_index;
  if (renderer_.is_antialiased() && input_.view.continues)  // but for the first frame of the film
    input_.view.sample = planning::film_sample(input_.view.frame_index);
  FrameCost cost;
  const double start = thread_cpu_ms();
  const render::FramePlan plan = renderer_.plan(input_);
  cost.prepare_cpu = thread_cpu_ms() - start;
  runner_.run([&](gpu::Recorder& recorder) {
    const double begin = thread_cpu_ms();
    renderer_.record_frame(recorder, plan);
    cost.record_cpu = thread_cpu_ms() - begin;
    recorder.read_back(renderer_.march().counters(), counter_, sizeof(std::uint32_t));
  });
  if (renderer_.is_antialiased()) input_.view.continues = true;
  for (const auto& scope : runner_.timings()) cost.passes[std::string(scope.name)] = scope.milliseconds;
  return cost;
}

std::vector<glm::vec4> RepeatedFrame::radiance() {
  return film::unpack_halves(
      gpu::read_back(context_, runner_, renderer_.targets().radiance, sizeof(std::uint64_t)));
}

std::uint32_t RepeatedFrame::texture_samples() const {
  return gpu::values_of<std::uint32_t>(counter_).front();
}

FrameTimes time_frames(Bench& bench, const std::string& name, const scenario::Scenario& scenario,
                       const render::RendererOptions& options, double seconds,
                       const std::function<void(planning::Quality&)>& change) {
  const bool slow = bench.is_slow();
  const unsigned count = bench.repetitions(slow ? 3 : 200);
  const VkDeviceSize before = bench.context().memory().bytes_in_use();
  RepeatedFrame frame(bench.context(), scenario, options, seconds);
  if (change) change(frame.input().quality);
  for (unsigned i = 0; i < (slow ? 1u : 50u); ++i) frame.draw();
  std::map<std::string, std::vector<double>> details;
  std::vector<double> sums;
  for (unsigned i = 0; i < count; ++i) {
    const FrameCost cost = frame.draw();
    double sum = 0;
    for (const auto& [pass, milliseconds] : cost.passes) {
      details[pass + "_ms"].push_back(milliseconds);
      if (pass != "gbuffer") sum += milliseconds;
    }
    details["prepare_cpu_ms"].push_back(cost.prepare_cpu);
    details["record_cpu_ms"].push_back(cost.record_cpu);
    sums.push_back(sum);
  }
  FrameTimes times{summarize(name, "ms", "gpu", sums), summarize(name, "ms", "gpu", details["march_ms"])};
  for (const auto& [detail, values] : details)
    times.all.details[detail] = summarize(detail, "ms", "gpu", values).median;
  times.all.details["device_mb"] =
      static_cast<double>(bench.context().memory().bytes_in_use() - before) / 1e6;
  times.all.details["volume_mb"] = static_cast<double>(frame.simulation().volume().bytes()) / 1e6;
  return times;
}

}  // namespace brume::bench
