// SPDX-License-Identifier: MIT
// Buffers, commands and kernels, with which an application prepares rays on the device and reads the results.
//
//     Buffer rays(context, {.name = "rays", .bytes = count * sizeof(Ray)});
//     Kernel<Args> make_rays(context, {.name = "make rays", .spirv = make_rays_spirv});
//     Commands commands(context, "frame");
//     make_rays.dispatch(commands, {rays.ref<Ray>(), count}, count);
//     commands.submit();
#pragma once

#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <twinray/context.h>

namespace twinray {

struct CompiledKernel;

// The memory of a buffer that is shared with other programs or APIs.
struct ExternalMemory {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;
};

// Describes a buffer.
struct BufferDesc {
    std::string name;         // required: shows in errors, debuggers and validation messages
    std::uint64_t bytes = 0;  // 0 is allowed and gives an empty buffer with address 0
    Memory memory = Memory::device;
    VkBufferUsageFlags usage = 0;  // beyond storage, transfer and device address
    std::uint64_t alignment = 16;  // of the device address; a power of two
};

// Memory for other programs or APIs to import: an opaque file descriptor, on Windows an opaque HANDLE, which CUDA, HIP
// and Vulkan can import, and the size of the whole memory, which they must be given.
struct ExportedMemory {
    std::intptr_t handle = -1;  // -1: none
    std::uint64_t bytes = 0;
};

// A named range of device memory. Move-only; when destroyed, it is freed after all work submitted so far.
class Buffer {
  public:
    Buffer() = default;
    // Throws Error naming the buffer and its size if there is not enough memory.
    Buffer(Context& context, const BufferDesc& desc);
    // Makes device memory that other programs and APIs can share (VK_KHR_external_memory_fd, on Windows _win32). Throws
    // Error naming the buffer if the device does not support this, or for another Memory than device.
    static Buffer exportable(Context& context, const BufferDesc& desc);
    // Imports memory that another program or API on the same device or driver has exported. The handle becomes the
    // buffer's; if this throws, it stays the caller's. The two sides must wait for each other's writes themselves:
    // twinray does not order work of two APIs.
    static Buffer imported(Context& context, const BufferDesc& desc, const ExportedMemory& memory);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return made_.buffer; }    // null if it is empty
    std::uint64_t address() const { return address_; }  // on the device; 0 if it is empty
    std::uint64_t bytes() const { return bytes_; }      // as BufferDesc asked for
    const std::string& name() const { return name_; }   // as in BufferDesc
    // Returns a new handle, which the caller closes or passes to an import that takes it over. Throws Error
    // unless the buffer is exportable.
    ExportedMemory exported() const;
    std::byte* mapped() const { return static_cast<std::byte*>(made_.mapped); }  // not null for upload and readback

    // Returns the typed address of the data at an offset, for kernels.
    template <class T>
    Ref<T> ref(std::uint64_t byte_offset = 0) const {
        return {address_ + byte_offset};
    }

  private:
    Buffer(Context& context, const BufferDesc& desc, const ExportedMemory& memory);
    void take_address(std::uint64_t alignment);

    Context* context_ = nullptr;
    AllocatedBuffer made_;
    ExternalMemory external_;  // the memory, if it is not the allocator's
    std::uint64_t address_ = 0;
    std::uint64_t bytes_ = 0;
    std::string name_;
};

// GPU time of one named pass.
struct PassTiming {
    std::string name;
    double ms = 0;
};

// A command buffer of the caller: begun, outside a render pass, for a queue of Context::queue_family(), submitted once.
struct CallerCommands {
    VkCommandBuffer handle = VK_NULL_HANDLE;
    // A value of a timeline semaphore of the caller that the submission will signal. Until it is reached, twinray keeps
    // the resources; so it must be reached, from the host or by a later value, even if the commands are dropped.
    SyncPoint done;
    // The caller's earlier work whose writes twinray must see, and the later work that uses twinray's writes.
    VkPipelineStageFlags producer_stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkAccessFlags producer_access = VK_ACCESS_MEMORY_WRITE_BIT;
    VkPipelineStageFlags consumer_stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkAccessFlags consumer_access = VK_ACCESS_MEMORY_READ_BIT;
};

// A sequence of named passes. The end of a pass is a global memory barrier, so that each pass sees all that earlier
// passes wrote; dispatches inside one pass must not depend on each other. Own commands may become several command
// buffers, cut between passes, so that none keeps the device busy for too long (see Pace).
class Commands {
  public:
    // Makes own commands, submitted by submit().
    Commands(Context& context, const std::string& name);
    // Records into the caller's command buffer. Throws Error unless caller.handle and caller.done are set.
    Commands(Context& context, const std::string& name, const CallerCommands& caller);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // A scope: everything recorded while it lives belongs to it.
    class Pass {
      public:
        // Begins the pass; see Commands::pass.
        Pass(Commands& commands, const std::string& name);
        ~Pass();
        Pass(const Pass&) = delete;
        Pass& operator=(const Pass&) = delete;

      private:
        Commands& commands_;
    };
    [[nodiscard]] Pass pass(const std::string& name) { return Pass(*this, name); }  // begins one
    bool in_pass() const;                                                           // whether a pass is open
    // Makes later commands of a pass see the writes of earlier ones, as from one pass to the next.
    void barrier();

    // Copies into `target` through a staging buffer that lives until the GPU has read it.
    void upload(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data);
    template <class T>
    void upload(const Buffer& target, std::span<const T> data, std::uint64_t offset = 0) {
        upload(target, offset, std::as_bytes(data));
    }
    // Writes a value of at most 64 KiB, without staging.
    template <class T>
    void write(const Buffer& target, const T& value, std::uint64_t offset = 0) {
        write_bytes(target, offset, std::as_bytes(std::span(&value, 1)));
    }
    // Uploads many pieces through one staging buffer and one copy.
    struct Region {
        std::uint64_t offset;  // in the target
        std::span<const std::byte> data;
    };
    // Throws Error for a region beyond the target.
    void upload_regions(const Buffer& target, std::span<const Region> regions);
    // Copies a range of one buffer into another.
    void copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
              std::uint64_t bytes);
    // Fills a range with `word`; `bytes` must be a multiple of 4.
    void fill(const Buffer& target, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);

    // Reports a dispatch of so many groups in the current pass: errors about a lost device name it, and it decides
    // where commands are cut.
    void count_groups(std::uint64_t groups);
    // The same for work of the driver that is as large as so many groups.
    void count_work(std::uint64_t groups);

    // Takes ownership until the GPU has finished these commands.
    void retain(Buffer&& temporary);

    // Call it once, at the end, even if it fails. The object may then be destroyed at any time. Throws Error for
    // commands of the caller.
    SyncPoint submit();
    // The same, and waits. Returns the seconds that the GPU was busy; without timestamps, that the host waited.
    double submit_and_wait();
    // The same for the passes recorded so far: more may follow. Not allowed within a pass.
    double submit_part();
    bool is_of_caller() const;  // whether they were made with CallerCommands
    // Returns the point at which these commands are done: CallerCommands::done, or the one that submit() returned.
    SyncPoint done() const;
    // Returns a point that they will reach, for work that relies on them before they are submitted, such as a sync
    // recorded into them. Own commands for which it was called are submitted in the order of those calls.
    SyncPoint promise();

    // Waits for the GPU, after the submission. Returns an entry per pass; none if the queue has no timestamps.
    std::vector<PassTiming> timings() const;

    Context& context() const;        // that they were made on
    VkCommandBuffer handle() const;  // of the next pass, until it ends

  private:
    void write_bytes(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data);

    struct State;
    std::unique_ptr<State> state_;
};

// Copies a range back to the host; submits and waits.
void download_bytes(Context& context, const Buffer& buffer, std::uint64_t offset, std::span<std::byte> into);

// The same for values of one type.
template <class T>
std::vector<T> download(Context& context, const Buffer& buffer, std::uint64_t count, std::uint64_t byte_offset = 0) {
    std::vector<T> values(count);
    download_bytes(context, buffer, byte_offset, std::as_writable_bytes(std::span(values)));
    return values;
}

// A constant of a kernel, given when its pipeline is made.
struct SpecializationConstant {
    std::uint32_t id;
    std::uint32_t value;  // VkBool32 for bools
};

// Describes a kernel.
struct KernelDesc {
    std::string name = {};                      // folder_stem: also the label and the name of the timing
    std::span<const std::uint32_t> spirv = {};  // embedded at build time
    std::uint32_t group_size = 64;              // local_size_x of the shader
    std::vector<SpecializationConstant> constants = {};
    bool compiles_when_used =
        false;                // by the first dispatch, which then throws as the constructor would; spirv stays valid
    bool has_images = false;  // it reads an ImageArray, which each dispatch then takes
};

// A compute pipeline whose only inputs are one push-constant block and, if it has images, an ImageArray. All pipelines
// of a context that are made from the same description share one. Use Kernel<Args>.
class ComputePipeline {
  public:
    // Compiles the kernel. Throws Error.
    ComputePipeline(Context& context, const KernelDesc& desc, std::uint32_t args_bytes);
    ~ComputePipeline();
    ComputePipeline(const ComputePipeline&) = delete;
    ComputePipeline& operator=(const ComputePipeline&) = delete;

    // Dispatches so many groups, spread over x and y if there are many.
    void dispatch_groups(Commands& commands, const void* args, std::uint64_t group_count,
                         VkDescriptorSet images = VK_NULL_HANDLE) const;
    // Dispatches as many groups as the VkDispatchIndirectCommand at `offset` of `counts` says.
    void dispatch_indirect(Commands& commands, const void* args, const Buffer& counts, std::uint64_t offset) const;

    const std::string& name() const { return desc_.name; }         // as in KernelDesc
    std::uint32_t group_size() const { return desc_.group_size; }  // as in KernelDesc

  private:
    void bind(Commands& commands, const void* args, VkDescriptorSet images) const;

    Context& context_;
    KernelDesc desc_;
    std::uint32_t args_bytes_;
    mutable std::shared_ptr<CompiledKernel> compiled_;  // null: not compiled yet
};

// A compute kernel that takes one Args struct, shared with its GLSL, as push constants (128 bytes are guaranteed).
template <class Args>
class Kernel {
    static_assert(sizeof(Args) <= 128 && sizeof(Args) % 4 == 0);

  public:
    // See ComputePipeline.
    Kernel(Context& context, const KernelDesc& desc) : pipeline_(context, desc, sizeof(Args)) {}

    // Runs at least `count` invocations; the shader must ignore global_index() >= count. Opens a pass with the kernel's
    // name unless one is open. `images` belongs to a TextureStore, for kernels made with KernelDesc::has_images.
    void dispatch(Commands& commands, const Args& args, std::uint64_t count,
                  VkDescriptorSet images = VK_NULL_HANDLE) const {
        dispatch_groups(commands, args, (count + pipeline_.group_size() - 1) / pipeline_.group_size(), images);
    }
    // Dispatches so many groups.
    void dispatch_groups(Commands& commands, const Args& args, std::uint64_t group_count,
                         VkDescriptorSet images = VK_NULL_HANDLE) const {
        pipeline_.dispatch_groups(commands, &args, group_count, images);
    }
    // See ComputePipeline::dispatch_indirect.
    void dispatch_indirect(Commands& commands, const Args& args, const Buffer& counts, std::uint64_t offset) const {
        pipeline_.dispatch_indirect(commands, &args, counts, offset);
    }
    const std::string& name() const { return pipeline_.name(); }  // as in KernelDesc

  private:
    ComputePipeline pipeline_;
};

// Cuts work of one kind into submissions of less than ContextDesc::most_submission_seconds each, from the times of the
// previous ones. Results must not depend on where it cuts. It remembers the rate from one use to the next.
class Pace {
  public:
    explicit Pace(const Context& context);  // with the limit of this context

    // Calls `record(first, count)` to record all of `count` items in order, in as many parts as needed: all but the
    // last are submitted and waited for, with what the commands held before. Commands of the caller are never cut.
    template <class Record>
    void record(Commands& commands, std::uint64_t count, const Record& record) {
        for (std::uint64_t first = 0; first < count; first += pending_) {
            if (first > 0) took(commands.submit_part());
            pending_ = commands.is_of_caller() ? count : next(count - first);
            record(first, pending_);
        }
    }
    // Submits the last part, waits for it and updates the rate.
    void finish(Commands& commands);

  private:
    std::uint64_t next(std::uint64_t left) const;
    void took(double seconds);

    double most_seconds_;  // 0: no limit
    std::uint64_t allowed_;
    std::uint64_t pending_ = 0;  // items that are recorded
};

}  // namespace twinray
