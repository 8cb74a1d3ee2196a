#include "apps/viewer/tank_job.hpp"

namespace brume::viewer {

TankJob::TankJob(TankMaker make)
    : made_(std::async(std::launch::async,
                       [this, make = std::move(make)] { return make([this] { return stops_.load(); }); })) {}

TankJob::~TankJob() {
  stops_ = true;
  if (made_.valid()) made_.wait();
}

double TankJob::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool TankJob::is_ready() const {
  return made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace brume::viewer
