// SPDX-License-Identifier: MIT
// Checks of Context's device: it may be lost, or belong to another process.
#include "engine/core/context.h"
#include "engine/core/device_fault.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/vulkan.h"

namespace twinray {

std::string Context::State::words_of_loss() const {
    if (!fault_) fault_ = properties_.device_fault ? sentence(query_device_fault(vk_, device_)) : "";
    return name_of(VK_ERROR_DEVICE_LOST) + submission_log_.sentence() + *fault_;
}

VkResult Context::State::note_hang() const {
    is_hung_ = true;
    fault_ = text("; it has ended none of its submissions for ", most_wait_seconds_, " s");
    return VK_ERROR_DEVICE_LOST;
}

void Context::State::check(VkResult result, const char* action) const {
    is_lost_ |= result == VK_ERROR_DEVICE_LOST;
    if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(text(action, ": ", words_of_loss()));
    vk_check(result, action);
}

bool Context::State::is_of_this_process() const noexcept { return process_ == platform::process_id(); }

void Context::State::check_process() const {
    if (!is_of_this_process())
        fail("device '", properties_.name, "': process ", process_, " opened it, and a fork made process ",
             platform::process_id(),
             " of that; a device does not outlive a fork. Open one in the new process, or start that by spawn");
}

void Context::State::check_alive() const {
    check_process();
    if (is_lost_) throw DeviceLost(text("device '", properties_.name, "': ", words_of_loss()));
}

}  // namespace twinray
