#include "engine/core/pipelines.h"

#include <algorithm>
#include <iomanip>

#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/platform.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// The constants of twinray/glsl/common.glsl.
constexpr std::uint32_t fused_fma_constant = 105, compares_numbers_constant = 106;

std::string key_of(const KernelDesc& desc, std::uint32_t args_bytes) {
    std::string key;
    const auto add = [&](const void* data, std::size_t bytes) { key.append(static_cast<const char*>(data), bytes); };
    add(&args_bytes, sizeof(args_bytes));
    add(&desc.has_images, sizeof(desc.has_images));
    const std::size_t constants = desc.constants.size();
    add(&constants, sizeof(constants));
    add(desc.constants.data(), constants * sizeof(SpecializationConstant));
    add(desc.spirv.data(), desc.spirv.size_bytes());
    return key;
}

VkPipeline new_pipeline(Context& context, const KernelDesc& desc, VkPipelineLayout layout, Telling telling) {
    std::vector<SpecializationConstant> constants = desc.constants;
    constants.push_back({fused_fma_constant, context.state().tuning().has_fused_fma});
    constants.push_back({compares_numbers_constant, context.state().tuning().compares_numbers});
    const VkShaderModule module = create_shader_module(context, desc.spirv, constants, desc.name);
    VkComputePipelineCreateInfo info = OfType{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    if (telling == Telling::statistics) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkPipelineCache cache = telling == Telling::statistics ? VK_NULL_HANDLE : context.state().pipeline_cache();
    const VkResult result =
        context.state().vk().vkCreateComputePipelines(context.device(), cache, 1, &info, nullptr, &pipeline);
    context.state().vk().vkDestroyShaderModule(context.device(), module, nullptr);
    if (result != VK_SUCCESS) fail("kernel '", desc.name, "': create the pipeline: ", name_of(result));
    context.state().set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), desc.name);
    return pipeline;
}

namespace fs = std::filesystem;

constexpr std::string_view prefix = "pipelines-";
constexpr std::string_view suffix = ".bin";

std::string name_for(const VkPhysicalDeviceProperties& driver) {
    std::ostringstream name;
    name << prefix << std::hex << driver.vendorID << '-' << driver.deviceID << '-' << driver.driverVersion << '-'
         << std::setfill('0');
    for (const std::uint8_t byte : driver.pipelineCacheUUID) name << std::setw(2) << uint{byte};
    name << suffix;
    return name.str();
}

bool is_ours(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.starts_with(prefix) && name.ends_with(suffix);
}

// Returns whether data of a pipeline cache begins with the header of this driver (VkPipelineCacheHeaderVersionOne).
bool is_of_driver(std::span<const std::byte> pipelines, const VkPhysicalDeviceProperties& driver) {
    VkPipelineCacheHeaderVersionOne header;
    if (pipelines.size() < sizeof header) return false;
    std::memcpy(&header, pipelines.data(), sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == driver.vendorID &&
           header.deviceID == driver.deviceID &&
           std::equal(std::begin(header.pipelineCacheUUID), std::end(header.pipelineCacheUUID),
                      driver.pipelineCacheUUID);
}

void remove_oldest(const fs::path& folder, std::size_t keep) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_ours(entry.path())) files.emplace_back(entry.last_write_time(), entry.path());
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i + keep < files.size(); ++i) fs::remove(files[i].second);
}

}  // namespace

CompiledKernel::~CompiledKernel() {
    vk.vkDestroyPipeline(device, pipeline, nullptr);
    vk.vkDestroyPipelineLayout(device, layout, nullptr);
}

std::shared_ptr<CompiledKernel> compile(Context& context, const KernelDesc& desc, std::uint32_t args_bytes,
                                        Telling telling) {
    auto kernel = std::make_shared<CompiledKernel>(context.state().vk(), context.device());
    kernel->layout =
        create_push_constant_layout(context, VK_SHADER_STAGE_COMPUTE_BIT, args_bytes,
                                    desc.has_images ? context.state().image_array_layout() : VK_NULL_HANDLE);
    kernel->pipeline = new_pipeline(context, desc, kernel->layout, telling);
    kernel->addresses = kernel_addresses(desc.spirv);
    return kernel;
}

// Compiles unlocked: if two threads compile the same, the first result is used.
std::shared_ptr<CompiledKernel> PipelineTable::get(Context& context, const KernelDesc& desc, std::uint32_t args_bytes) {
    context.state().check_process();
    std::string key = key_of(desc, args_bytes);
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = entries_.find(key); found != entries_.end()) return found->second.kernel;
    }
    std::shared_ptr<CompiledKernel> kernel = compile(context, desc, args_bytes, Telling::nothing);
    const std::lock_guard lock(mutex_);
    return entries_.try_emplace(std::move(key), Entry{std::move(kernel)}).first->second.kernel;
}

void PipelineTable::give_back(Context& context, std::shared_ptr<CompiledKernel> kernel) {
    if (!context.state().is_of_this_process()) return;
    std::shared_ptr<CompiledKernel> gone;
    {
        const std::lock_guard lock(mutex_);
        for (auto& [key, entry] : entries_)
            if (entry.kernel == kernel) entry.given_back = ++given_back_;
        kernel.reset();
        gone = take_oldest_unused();
    }
    if (gone) context.state().retire([gone] {});
}

// Returns null while there are not too many.
std::shared_ptr<CompiledKernel> PipelineTable::take_oldest_unused() {
    std::size_t unused = 0;
    auto oldest = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (entry->second.kernel.use_count() > 1) continue;
        ++unused;
        if (oldest == entries_.end() || entry->second.given_back < oldest->second.given_back) oldest = entry;
    }
    if (unused <= most_unused) return nullptr;
    return std::move(entries_.extract(oldest).mapped().kernel);
}

std::size_t PipelineTable::size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

void PipelineTable::clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
}

PipelineStore::PipelineStore(fs::path folder, const VkPhysicalDeviceProperties& driver)
    : file_(folder.empty() ? fs::path() : folder / name_for(driver)), driver_(driver) {}

Bytes PipelineStore::load(const std::function<void(std::string_view)>& log) const {
    std::error_code error;
    if (file_.empty() || !fs::exists(file_, error)) return {};
    try {
        Bytes pipelines = read_file(file_);
        if (is_of_driver(std::as_bytes(std::span(pipelines)), driver_)) return pipelines;
        log(text("'", file_.string(), "': its pipelines are not of this driver; they are compiled again"));
    } catch (const std::exception& failure) {
        log(failure.what());
    }
    return {};
}

void PipelineStore::save(std::span<const std::byte> pipelines,
                         const std::function<void(std::string_view)>& log) const noexcept try {
    if (file_.empty()) return;
    fs::create_directories(file_.parent_path());
    if (pipelines.size() > most_bytes || !is_of_driver(pipelines, driver_)) {
        fs::remove(file_);
        return;
    }
    write_file(file_, std::span(&pipelines, 1));
    remove_oldest(file_.parent_path(), most_files);
} catch (const std::exception& failure) {
    log(failure.what());
}

fs::path user_pipeline_folder() { return platform::cache_folder(); }

}  // namespace twinray
