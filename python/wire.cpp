#include "python/wire.hpp"

#include <pybind11/stl.h>

#include <mutex>
#include <optional>

#include "python/bytes.hpp"
#include "python/world.hpp"
#include "wire/receiver.hpp"
#include "wire/sender.hpp"

namespace brume::python {
namespace {

/// One thread at a time.
class Sender {
 public:
  explicit Sender(std::uint32_t history) : sender_({checked(history)}) {}
  py::bytes push(const Smoke& smoke) {
    return bytes_of(smoke.read([&](const sim::World& world) {
      const std::lock_guard lock(mutex_);
      return sender_.push(world.state()).value_or_throw();
    }));
  }
  py::bytes answer(const py::bytes& request) {
    const std::vector<std::byte> copy = copy_of(request);
    return bytes_of(released([&] {
      const std::lock_guard lock(mutex_);
      return sender_.answer(copy).value_or_throw();
    }));
  }

 private:
  static std::uint32_t checked(std::uint32_t history) {
    if (history < 1) refuse("history", "expected at least 1 tick");
    return history;
  }

  std::mutex mutex_;
  wire::Sender sender_;
};

/// One thread at a time.
class Receiver {
  template <typename Work>
  auto with(const Work& work) {
    return released([&] {
      const std::lock_guard lock(mutex_);
      return work();
    });
  }
  const sim::State* state() const { return receiver_.state(); }

 public:
  Receiver(const Level* level, std::uint32_t hold_ticks) : receiver_(settings_of(level, hold_ticks)) {}
  const char* receive(const py::bytes& packet) {
    const std::vector<std::byte> copy = copy_of(packet);
    const wire::Reception reception = with([&] { return receiver_.receive(copy).value_or_throw(); });
    if (reception == wire::Reception::foreign)
      throw Error(ErrorCode::bad_input, "packet: of another level than the receiver's; load the sender's");
    return reception == wire::Reception::applied ? "applied"
           : reception == wire::Reception::old   ? "old"
           : reception == wire::Reception::held  ? "held"
                                                 : "missed";
  }
  py::bytes request() {
    return bytes_of(with([&] { return receiver_.request(); }));
  }
  bool behind() {
    return with([&] { return receiver_.behind(); });
  }
  std::optional<std::uint32_t> tick() {
    return with([&] { return state() ? std::optional(state()->tick) : std::nullopt; });
  }
  std::optional<std::uint64_t> state_hash() {
    return with([&] { return state() ? std::optional(state()->hash()) : std::nullopt; });
  }
  void restore(World& world) {
    const std::optional<sim::State> copy =
        with([&] { return state() ? std::optional(*state()) : std::nullopt; });
    if (!copy) throw Error(ErrorCode::bad_input, "the receiver has no state yet");
    world.restore_state(*copy);
  }

 private:
  static wire::ReceiverSettings settings_of(const Level* level, std::uint32_t hold_ticks) {
    if (hold_ticks > wire::kMaxHoldTicks) refuse("hold_ticks", "expected at most 64");
    wire::ReceiverSettings settings;
    settings.hold_ticks = hold_ticks;
    if (level) settings.level_hash = level->voxels->level_hash();
    return settings;
  }

  std::mutex mutex_;
  wire::Receiver receiver_;
};

}  // namespace

void bind_wire(py::module_& module) {
  using namespace py::literals;
  py::class_<Sender>(module, "Sender", R"(Turns the states of a world into small packets of bytes, one a tick.

Every receiver gets the same packet; one that missed some sends a request.)")
      .def(py::init<std::uint32_t>(), py::kw_only(), "history"_a = 128,
           "history: ticks whose states are stored for answers, at least 1.")
      .def("push", &Sender::push, "smoke"_a,
           R"(The packet of a World's or Scenario's present tick, as bytes: what changed since the last push.

Raises ValueError when the tick is not above the last one's, or the world is another.)")
      .def("answer", &Sender::answer, "request"_a,
           R"(The reply to Receiver.request(), as bytes: empty when the receiver has the newest state.

Raises ValueError for bytes that are no request, and before the first push.)");
  py::class_<Receiver>(
      module, "Receiver",
      "Turns packets, in any order and with gaps, into the sender's states, without a world.")
      .def(py::init<const Level*, std::uint32_t>(), py::kw_only(), "level"_a = py::none(), "hold_ticks"_a = 0,
           R"(level: the level that states must be of; None: any.
hold_ticks: by how many ticks packets may overtake others, 0 to 64; early ones are held until those before them
    arrive.)")
      .def("receive", &Receiver::receive, "packet"_a,
           R"(Takes a packet of Sender.push or Sender.answer.

Returns "applied", "old" (of an earlier tick; ignored), "held" (early) or "missed" (what it builds on is missing;
send a request). Raises ValueError for damaged bytes, and for a whole state of another level than the receiver's;
the state stays as it was.)")
      .def("request", &Receiver::request, "What to send to the sender when states are missing, as bytes.")
      .def_property_readonly("behind", &Receiver::behind, "Whether a state is known to be missing.")
      .def_property_readonly("tick", &Receiver::tick, "Tick of the newest state; None before the first one.")
      .def_property_readonly("state_hash", &Receiver::state_hash,
                             "Hash of the newest state; None before the first one.")
      .def("restore", &Receiver::restore, "world"_a,
           R"(Gives the newest state to a World of the same level, for queries.

Raises ValueError before the first state, and for a world of another level, tick rate or other masks.)");
}

}  // namespace brume::python
