// A scenario at a time with its renderer.
#pragma once

#include <memory>
#include <vector>

#include "render/renderer.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"

namespace brume::render {

/// At a fixed address, since the input refers to the simulation and the holes.
struct Studio {
  scenario::Scenario scenario;
  std::unique_ptr<scenario::Simulation> simulation;
  std::vector<shared::Hole> holes;
  FrameInput input;
  std::unique_ptr<Renderer> renderer;
};

inline std::unique_ptr<Studio> make_studio(gpu::Context& context, gpu::CommandRunner& runner,
                                           scenario::Scenario scenario, double seconds, glm::uvec2 size_px) {
  auto made = std::make_unique<Studio>(Studio{std::move(scenario), {}, {}, {}, {}});
  made->simulation = scenario::Simulation::create(made->scenario).value_or_throw();
  made->simulation->advance_to(seconds);
  made->input = scenario::frame_input(made->scenario, *made->simulation, seconds, made->holes);
  made->renderer =
      std::make_unique<Renderer>(context, runner, made->scenario.scene, RendererOptions{.size_px = size_px});
  return made;
}

}  // namespace brume::render
