// The devices of scenes, one for each process, and how a scene comes to another one.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

#include "bindings/python/scene.h"

namespace twinray::python {
namespace {

// Each process has its own. None is destroyed: no driver is called at static ends, nor by a child for its parent.
struct Registry {
    const pid_t process = getpid();
    bool is_of_child = false;  // a fork made the process
    std::mutex mutex;          // guards `devices`
    std::map<std::string, std::shared_ptr<Device>> devices;
    std::mutex reopening;  // scenes in a child process
};
Registry& registry() {
    static std::atomic<Registry*> current = new Registry;
    Registry* known = current;
    if (known->process == getpid()) return *known;
    auto fresh = std::make_unique<Registry>();
    fresh->is_of_child = true;
    if (current.compare_exchange_strong(known, fresh.get())) return *fresh.release();
    return *known;
}

// Mesa's handler joins the threads of the parent's drivers, which a child does not have, and would crash.
void end_without_drivers(int status, void*) {
    std::fflush(nullptr);
    _exit(status);
}

ContextDesc desc_for(const std::string& request, std::vector<std::string>& log) {
    ContextDesc desc;
    desc.device = request;
    desc.pipeline_folder = user_pipeline_folder();
    desc.log = [&log](std::string_view message) { log.emplace_back(message); };
    return desc;
}

}  // namespace

Device::Device(const std::string& request) : context(desc_for(request, log)) {}

std::shared_ptr<Device> device_for(const std::string& request) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    std::shared_ptr<Device>& device = all.devices[request];
    if (device) return device;
    device = std::make_shared<Device>(request);
    if (std::exchange(all.is_of_child, false)) on_exit(&end_without_drivers, nullptr);
    return device;
}

void forget_devices() {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    all.devices.clear();
}

bool TurnMutex::try_lock_until(Clock::time_point end) {
    if (owner_ != std::this_thread::get_id()) {
        const std::unique_lock next(next_, end);
        if (!next || !held_.try_lock_until(end)) return false;
        owner_ = std::this_thread::get_id();
    }
    ++depth_;
    return true;
}

void TurnMutex::unlock() {
    if (--depth_ > 0) return;
    owner_ = std::thread::id();
    held_.unlock();
}

DeviceLock::DeviceLock(Device& device) : device_(device) {
    if (!device.is_of_this_process())
        throw Error("what process " + std::to_string(device.process) +
                    " keeps on a device is of no use here: a device does not outlive a fork. Make it anew in this "
                    "process, or start processes by spawn or forkserver");
    while (!device.mutex.try_lock_until(TurnMutex::Clock::now() + std::chrono::milliseconds(100)))
        look_for_interruption();
}

void Scene::make_empty() {
    device_ = device_for(request_);
    const DeviceLock lock(*device_);
    choice_ = choose_accel(device_->context.properties(), accel_name_, {.level = level_});
    accel_ = make_accel(device_->context, choice_, {.level = level_});
    changed();
}

// Destroys nothing of another process: its threads are not here, and its mutexes may be locked.
void Scene::leave() {
    static_cast<void>(all_hits_.release());
    static_cast<void>(lister_.release());
    static_cast<void>(points_.release());
    static_cast<void>(accel_.release());
    static_cast<void>(new std::shared_ptr<Device>(std::move(device_)));
}

std::shared_ptr<Device> Scene::device() {
    const Lock lock(*this);
    return device_;
}

Device& Scene::open_device() {
    if (process_ == getpid()) return *device_;
    const std::lock_guard lock_of_scenes(registry().reopening);
    if (process_ == getpid()) return *device_;
    if (device_ && !device_->is_of_this_process()) {
        if (!device_->mutex.try_lock())
            throw Error(
                "another thread was in a call on the device when a fork made this process: make a scene anew, "
                "or start processes by spawn or forkserver");
        leave();
    }
    try {
        make_empty();
        const DeviceLock lock_of_device(*device_);
        push_parts(*accel_, &Part::handle);
    } catch (const Error& error) {
        throw Error(std::string("a device does not outlive a fork, and none could be opened in the new process: ") +
                    error.what() + "; start processes by spawn or forkserver");
    }
    process_ = getpid();
    return *device_;
}

// Instances keep sharing meshes.
void Scene::push_parts(AbstractAccel& accel, AccelHandle Part::*handle) {
    std::map<const SharedMesh*, AccelHandle> pushed;
    for (uint number = 0; number < parts_.size(); ++number) {
        if (!parts_[number]) continue;
        Part& part = *parts_[number];
        const InstanceOptions options{.custom_index = number};
        const auto [known, is_new] = pushed.try_emplace(part.mesh.get());
        part.*handle = is_new ? accel.push(*part.mesh, part.transform, options)
                              : push_instance(accel, known->second, part.transform, options);
        if (is_new) known->second = part.*handle;
    }
}

AccelHandle Scene::push_instance(AbstractAccel& accel, AccelHandle pushed, const Transform& transform,
                                 const InstanceOptions& options) {
    return accel.push_instances_of(pushed, std::span(&transform, 1), std::span(&options, 1));
}

Content Scene::content() {
    const Lock lock(*this);
    Content content{.meshes = {}, .geometries = {}, .count = static_cast<uint>(parts_.size())};
    std::map<const SharedMesh*, uint> numbers;
    for (uint number = 0; number < parts_.size(); ++number) {
        if (!parts_[number]) continue;
        const Part& part = *parts_[number];
        const auto [known, is_new] = numbers.try_emplace(part.mesh.get(), static_cast<uint>(content.meshes.size()));
        if (is_new) content.meshes.push_back(*part.mesh);
        content.geometries.push_back({number, known->second, part.transform, part.is_flat});
    }
    return content;
}

void Scene::restore(Content&& content) {
    const Lock lock(*this);
    std::vector<std::shared_ptr<KeptMesh>> meshes;
    for (SharedMesh& mesh : content.meshes) meshes.push_back(std::make_shared<KeptMesh>(KeptMesh{std::move(mesh)}));
    if (content.count > most_geometries)
        throw Error("a scene has at most " + std::to_string(most_geometries) + " geometries, not " +
                    std::to_string(content.count));
    parts_.resize(content.count);
    for (const auto& [number, mesh, transform, is_flat] : content.geometries) {
        if (number >= content.count || mesh >= meshes.size())
            throw Error("a kept scene of " + std::to_string(content.count) + " geometries and " +
                        std::to_string(meshes.size()) + " meshes names geometry " + std::to_string(number) +
                        " and mesh " + std::to_string(mesh));
        meshes[mesh]->name = "geometry " + std::to_string(number);
        parts_[number] = Part{{}, meshes[mesh], transform, {}, is_flat};
    }
    push_parts(*accel_, &Part::handle);
}

}  // namespace twinray::python
