// Commands in the command buffers of a host, which submits them.
#pragma once

#include <cstdint>
#include <list>
#include <optional>

#include "gpu/recorder.hpp"

namespace brume::gpu {

class HostRecording : public CommandStream {
 public:
  /// `context` is of a host's device and must outlive it. `timed`: measures the time of frames, for
  /// timings().
  explicit HostRecording(Context& context, bool timed = false) : context_(context), is_timed_(timed) {}
  /// Frees nothing that the device uses: see Context::retire.
  ~HostRecording() override = default;
  HostRecording(const HostRecording&) = delete;
  HostRecording& operator=(const HostRecording&) = delete;

  /// Begins to collect a frame for `commands`, which are in the recording state. The device has completed the
  /// commands of all frames up to `completed`; those after it may be in flight, as many as there are. Frames
  /// never fall, and their commands are submitted in that order to one queue, or not at all together with all
  /// that follow.
  void begin(VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed);
  /// Begins one more view of the frame, behind the commands collected so far.
  void begin_view();
  /// Ends the frame: records the commands of its views, which belong to the host again.
  void end();
  /// Ends the frame after a failure: nothing of it is recorded. What `run` collected for its only view comes
  /// with the next frame; of several views that is lost, too, and what relied on it must be made again.
  void discard() noexcept;
  /// Whether begin_view was called in this frame.
  bool has_several_views() const { return view_ != views_.begin(); }

  /// Between begin and end.
  Recorder& recorder();
  /// Collects preparations of a view at once, between its begin and the first call of recorder(). Like on a
  /// device of our own they will be executed once this returns, whatever becomes of the frame; but see
  /// discard().
  void run(const std::function<void(Recorder&)>& record) override;

  /// GPU times of the newest frame that the device had completed when the present one began. Empty: there was
  /// none, or no times are taken. Some drivers wait for the device before they give times.
  const std::vector<Timings::Scope>& timings() const { return timings_; }

 private:
  struct Slot {
    Slot(Context& context, bool timed) : resources(context, timed) {}
    FrameSlot resources;
    std::uint64_t frame = 0;  ///< The last one that it was used for; 0: none.
    bool is_frame = false;    ///< For its own commands, not for preparations.
  };
  /// Commands that are collected.
  struct Part {
    Part(Context& context, Slot& own_slot) : slot(&own_slot), recorder(context, own_slot.resources) {}
    Slot* slot;
    Recorder recorder;
  };
  struct View {
    std::optional<Part> preparations, own;
  };
  Slot& take_slot(bool is_frame);
  void read_timings();

  Context& context_;
  const bool is_timed_;
  std::list<Slot> slots_;                      // as many as frames and preparations were in flight, and one
  VkCommandBuffer commands_ = VK_NULL_HANDLE;  // the frame's; null: outside of a frame
  std::uint64_t frame_ = 0, completed_ = 0;
  std::list<View> views_ = std::list<View>(1);       // as many as a frame has had
  std::list<View>::iterator view_ = views_.begin();  // the one that is collected
  std::vector<Timings::Scope> timings_;
};

}  // namespace brume::gpu
