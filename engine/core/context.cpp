// SPDX-License-Identifier: MIT
// What hosts call, of what Context::State does.
#include "engine/core/context.h"

namespace twinray {

Context::Context(const ContextDesc& desc) : state_(std::make_unique<State>(desc)) {}
Context::Context(const AdoptedDevice& adopted) : state_(std::make_unique<State>(adopted)) {}
Context::~Context() = default;
VkDevice Context::device() const { return state_->device(); }
VkPhysicalDevice Context::physical_device() const { return state_->physical_device(); }
std::uint32_t Context::queue_family() const { return state_->queue_family(); }
const DeviceProperties& Context::properties() const { return state_->properties(); }
std::uint64_t Context::allocated_bytes() const { return state_->allocator().live_bytes() - State::absent_bytes; }
std::uint64_t Context::absent() const { return state_->absent(); }
void Context::wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages) {
    state_->wait_before_next_submission(point, stages);
}
SyncPoint Context::last_submission() const { return state_->last_submission(); }
bool Context::is_reached(SyncPoint point) const { return state_->is_reached(point); }
void Context::wait(SyncPoint point) const { state_->wait(point); }
void Context::wait_for_gpu() { state_->wait_for_gpu(); }
void Context::announce(SyncPoint point) { state_->announce(point); }
std::vector<std::string> Context::validation_messages() const { return state_->validation_messages(); }

}  // namespace twinray
