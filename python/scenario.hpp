// The classes Scenario and Renderer of the module.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "python/smoke.hpp"
#include "scenario/simulation.hpp"

namespace brume::python {

/// What was loaded. Renderers share it with the Scenario.
struct Loaded {
  scenario::Scenario scenario;
  std::mutex drawing;  ///< Volumes stream through one loader.
};

class Scenario : public Smoke {
 public:
  explicit Scenario(std::shared_ptr<Loaded> loaded);

  Level level() const override;
  void advance_to(double seconds);
  const std::shared_ptr<Loaded>& loaded() const { return loaded_; }

 protected:
  const sim::World& world() const override { return simulation_->world(); }
  const smoke::Field& update_field() override { return simulation_->field(); }
  smoke::SightLook sight_look(bool drawn) const override;

 private:
  std::shared_ptr<Loaded> loaded_;
  std::unique_ptr<scenario::Simulation> simulation_;
};

/// (position, target) or (position, target, degrees), as --camera of brume render; None: none.
std::optional<scene::Camera> camera_of(const py::object& value);

/// After bind_smoke.
void bind_scenario(py::module_& module);
void bind_renderer(py::module_& module);

}  // namespace brume::python
