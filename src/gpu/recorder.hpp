// Collects the commands of a recording and derives the barriers between them.
#pragma once

#include <array>
#include <deque>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/frame_memory.hpp"
#include "gpu/bindings.hpp"
#include "gpu/command_list.hpp"
#include "gpu/frame_slot.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/render_passes.hpp"
#include "gpu/resources.hpp"
#include "gpu/timings.hpp"

namespace brume::gpu {

class Recorder {
 public:
  /// `slot` must not be in use by the device.
  Recorder(Context& context, FrameSlot& slot);
  /// Unless `keep` was called, the commands are dropped, and with them all that they changed (Recorded).
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Binds a pipeline with its resources, in any order, and its push constants, after the barriers that they
  /// need. The resources must match the pipeline's interface (binding_fault).
  void bind(const Pipeline& pipeline, BoundResources resources, std::span<const std::byte> push = {});
  template <typename Push>
  void bind(const Pipeline& pipeline, BoundResources resources, const Push& push) {
    bind(pipeline, resources, std::as_bytes(std::span(&push, 1)));
  }
  /// The same with bundles (with_bundles).
  void bind(const Pipeline& pipeline, Bundles bundles, BoundResources resources,
            std::span<const std::byte> push = {});
  template <typename Push>
  void bind(const Pipeline& pipeline, Bundles bundles, BoundResources resources, const Push& push) {
    bind(pipeline, bundles, resources, std::as_bytes(std::span(&push, 1)));
  }
  /// Runs the bound compute pipeline over at least this many threads.
  void dispatch_threads(const ComputePipeline& pipeline, std::uint32_t x, std::uint32_t y = 1,
                        std::uint32_t z = 1);
  /// Dispatches without dependencies on each other, which `record` binds and dispatches: the barriers of all
  /// come before the first. `record` neither uploads nor dispatches indirectly.
  template <typename Record>
  void concurrently(Record&& record) {
    begin_concurrent();
    record();
    end_concurrent();
  }
  /// Dispatches the number of workgroups in the first three words of `groups`
  /// (VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT).
  void dispatch_indirect(const Buffer& groups);
  void push(const Pipeline& pipeline, std::span<const std::byte> bytes);

  /// Copies bytes through staging memory. Uploads and fills that follow each other share their barriers.
  void upload(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes);
  struct Region {
    std::span<const std::byte> texels;
    glm::ivec3 offset{0};
    glm::uvec3 size{1};
  };
  void upload(const Image& image, std::span<const Region> regions);
  void fill(const Buffer& buffer, std::uint32_t value);
  void clear(const Image& image, VkClearColorValue value);
  /// Copies the first level and layer of an image into a buffer, tightly packed, ready for the CPU.
  void read_back(const Image& image, const Buffer& buffer);
  void read_back(const Buffer& from, const Buffer& to, VkDeviceSize bytes);
  /// Copies a 2D image to one of another size or format.
  void blit(const Image& from, const Image& to, VkFilter filter);
  /// The same to all of a window's image, discarding its content; transitions it for presentation.
  struct WindowImage {
    VkImage handle = VK_NULL_HANDLE;
    glm::uvec2 size_px{0};
  };
  void blit(const Image& from, const WindowImage& to);
  /// Generates the mip levels of an image from its first.
  void make_mip_levels(const Image& image);

  struct Attachments {
    std::array<const Image*, kMostColours> colours{};  ///< Null after the last one.
    const Image* depth = nullptr;
    VkImageView depth_view = VK_NULL_HANDLE;  ///< A view of one layer; null: the image's own.
    std::uint32_t keep = 0;                   ///< Colours whose contents are preserved, a bit each.
    bool keep_depth = false;
    bool overwrite = false;  ///< What no draw writes is undefined in the colours that are not kept: no clear.
  };
  /// Draws into a part of the attachments from `origin_px` on. Clears it in those that are neither kept nor
  /// overwritten to 0 (reverse depth: infinitely far).
  void begin_rendering(const Attachments& attachments, glm::uvec2 size_px, glm::uvec2 origin_px = {0, 0});
  void end_rendering();
  void draw_indexed(const Buffer& indices, std::uint32_t count, std::uint32_t first,
                    std::int32_t first_vertex);
  /// Draws without indices.
  void draw(std::uint32_t vertex_count);
  void set_scissor(glm::ivec2 offset_px, glm::uvec2 size_px);
  /// Barriers for resources that draws read; before begin_rendering.
  void prepare_for_draws(std::initializer_list<Binding> bindings);
  /// The same for all that bind_for_draws will bind.
  void prepare_for_draws(const Pipeline& pipeline, Bundles bundles, BoundResources resources);
  void prepare_indices(const Buffer& indices);
  /// Binds inside a rendering, where no barrier is possible: prepare_for_draws comes first.
  void bind_for_draws(const Pipeline& pipeline, BoundResources resources);
  void bind_for_draws(const Pipeline& pipeline, Bundles bundles, BoundResources resources);

  /// A scope has a time (Timings) and, where debuggers can see it, its name, a constant.
  void begin_scope(const char* name);
  void end_scope();

  /// Calls `record`, all of whose commands are collected or, where it throws, none.
  void collect(const std::function<void(Recorder&)>& record);
  /// Records all that was collected into `commands`, which are in the recording state and remain so. Nothing
  /// is recorded before.
  void record(VkCommandBuffer commands);
  /// The last call: the recorded commands will be executed.
  void keep() { is_kept_ = true; }

  /// Memory for lists that live no longer than this recorder.
  FrameMemory& memory() { return slot_.memory_; }
  /// A value that the commands change, to be changed with them (Recorded).
  template <typename T>
  T& change(Recorded<T>& value) {
    return value.change(context_, id_);
  }
  Context& context() { return context_; }

 private:
  void begin_concurrent();
  void end_concurrent();
  struct Staged {
    const Buffer* buffer;
    VkDeviceSize offset;
  };
  Staged stage_bytes(std::span<const std::byte> bytes);
  VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
  void bind_all(const Pipeline& pipeline, std::span<const BoundResource> resources,
                std::span<const std::byte> push);
  VkDescriptorSet write_set(const Pipeline& pipeline, std::span<const BoundResource> resources);
  void bind_set(const Pipeline& pipeline, VkDescriptorSet set);
  void add_barrier(const Buffer& buffer, VkPipelineStageFlags2 stages, VkAccessFlags2 access);
  void use(const Buffer& buffer, VkPipelineStageFlags2 stages, VkAccessFlags2 access);
  void use(const Image& image, VkPipelineStageFlags2 stages, VkAccessFlags2 access, VkImageLayout layout);
  void use(const Binding& binding, VkPipelineStageFlags2 stages);
  void flush_barriers();
  void add_blit(const Image& from, VkImage to, VkImageLayout layout, const VkImageBlit& blit,
                VkFilter filter);
  void add_dispatch(const std::array<std::uint32_t, 3>& groups);

  /// A write to a buffer that is yet to be recorded: a copy from `from`, where also `bytes` are, or without
  /// it a fill.
  struct Transfer {
    VkBuffer from, to;
    VkBufferCopy region;
    const std::byte* bytes;
    std::uint32_t value;
  };
  void add_transfer(const Buffer& to, const Transfer& transfer);
  void flush_transfers();

  /// A dispatch of `concurrently` that is yet to be recorded.
  struct Dispatch {
    const Pipeline* pipeline;
    VkDescriptorSet set;
    std::span<const std::byte> push;
    std::array<std::uint32_t, 3> groups;
  };

  Context& context_;
  FrameSlot& slot_;
  CommandList list_;
  FrameVector<VkBufferMemoryBarrier2> buffer_barriers_;
  FrameVector<VkImageMemoryBarrier2> image_barriers_;
  FrameVector<Transfer> transfers_;
  FrameVector<Dispatch> dispatches_;
  bool concurrently_ = false;
  RecordingId id_;
  bool is_kept_ = false;
};

/// Measures the GPU time of the commands recorded during its lifetime.
class Scope {
 public:
  Scope(Recorder& recorder, const char* name) : recorder_(recorder) { recorder.begin_scope(name); }
  /// May run out of memory. While another error is on its way nothing is recorded.
  ~Scope() noexcept(false) {
    if (std::uncaught_exceptions() == exceptions_) recorder_.end_scope();
  }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  Recorder& recorder_;
  int exceptions_ = std::uncaught_exceptions();
};

/// Where commands are recorded. Later ones see what earlier ones wrote.
class CommandStream {
 public:
  virtual ~CommandStream() = default;
  /// Records commands; the device executes them before it returns, or later. Throws what `record` throws, or
  /// DeviceLost.
  virtual void run(const std::function<void(Recorder&)>& record) = 0;

 protected:
  CommandStream() = default;
  CommandStream(const CommandStream&) = default;
  CommandStream& operator=(const CommandStream&) = default;
};

/// Its own command buffer, for programs that own the device.
class CommandRunner : public CommandStream {
 public:
  explicit CommandRunner(Context& context);
  ~CommandRunner() override;
  CommandRunner(const CommandRunner&) = delete;
  CommandRunner& operator=(const CommandRunner&) = delete;

  /// Records, submits and waits.
  void run(const std::function<void(Recorder&)>& record) override;
  /// The same without the wait: call Context::wait before the next recording.
  void start(const std::function<void(Recorder&)>& record, const WindowSemaphores& window);
  std::vector<Timings::Scope> timings() const { return slot_.timings().read(); }

 private:
  Context& context_;
  FrameSlot slot_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

}  // namespace brume::gpu
