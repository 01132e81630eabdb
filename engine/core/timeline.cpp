// Context's timeline: submits, waits, and frees resources that the GPU has passed.
#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/core/context.h"
#include "engine/core/error.h"
#include "engine/core/interruption.h"
#include "engine/core/vulkan.h"

namespace twinray {

VkSemaphore Context::State::new_timeline(const char* name) {
    VkSemaphoreTypeCreateInfo type = OfType{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore = OfType{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    semaphore.pNext = &type;
    const VkSemaphore made = created(vk_.vkCreateSemaphore, device_, semaphore, "create a timeline semaphore");
    set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<std::uint64_t>(made), name);
    return made;
}

SyncPoint Context::State::promise() {
    if (!promised_timeline_) promised_timeline_ = new_timeline("twinray promises");
    const SyncPoint point{promised_timeline_, promised_.promise()};
    announce(point);
    return point;
}

void Context::State::give_up(std::uint64_t promised) noexcept {
    promised_.give_up(promised);
    if (!is_of_this_process() || is_lost_ || !promised_.is_due(promised)) return;
    const std::uint64_t value = promised_.value_of(promised);
    VkTimelineSemaphoreSubmitInfo timeline = OfType{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO};
    timeline.signalSemaphoreValueCount = 1;
    timeline.pSignalSemaphoreValues = &value;
    VkSubmitInfo info = OfType{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.pNext = &timeline;
    info.signalSemaphoreCount = 1;
    info.pSignalSemaphores = &promised_timeline_;
    if (enqueue(std::span(&info, 1)) == VK_SUCCESS)
        promised_.pass(promised);
    else
        warn("discarded commands still count as pending, because the device refused the submission that marks them");
}

void Context::State::wait_before_next_submission(SyncPoint point, VkPipelineStageFlags stages) {
    if (!point.semaphore || !point.value || !stages)
        fail("wait before the next submission: the semaphore, its value and the stages must not be 0");
    awaited_.push_back({point, stages});
}

// The driver gets each submission separately, since each signals: merged ones would count as one that takes longer.
VkResult Context::State::enqueue(std::span<const Submission> submissions, std::uint64_t promised) const {
    std::vector<VkSemaphore> semaphores;
    std::vector<std::uint64_t> awaited, signalled(submissions.size());
    std::vector<VkPipelineStageFlags> stages;
    for (const Wait& wait : awaited_) {
        semaphores.push_back(wait.point.semaphore);
        awaited.push_back(wait.point.value);
        stages.push_back(wait.stages);
    }
    std::vector<VkTimelineSemaphoreSubmitInfo> timelines(submissions.size());
    std::vector<VkSubmitInfo> infos(submissions.size());
    for (std::size_t i = 0; i < submissions.size(); ++i) {
        signalled[i] = submitted_ + i + 1;
        timelines[i].sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
        timelines[i].signalSemaphoreValueCount = 1;
        timelines[i].pSignalSemaphoreValues = &signalled[i];
        infos[i].sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        infos[i].pNext = &timelines[i];
        infos[i].commandBufferCount = 1;
        infos[i].pCommandBuffers = &submissions[i].commands;
        infos[i].signalSemaphoreCount = 1;
        infos[i].pSignalSemaphores = &timeline_;
    }
    timelines.front().waitSemaphoreValueCount = static_cast<std::uint32_t>(awaited.size());
    timelines.front().pWaitSemaphoreValues = awaited.data();
    infos.front().waitSemaphoreCount = static_cast<std::uint32_t>(semaphores.size());
    infos.front().pWaitSemaphores = semaphores.data();
    infos.front().pWaitDstStageMask = stages.data();
    const VkSemaphore both[] = {timeline_, promised_timeline_};
    const std::uint64_t both_values[] = {signalled.back(), promised ? promised_.value_of(promised) : 0};
    if (promised) {
        timelines.back().signalSemaphoreValueCount = infos.back().signalSemaphoreCount = 2;
        timelines.back().pSignalSemaphoreValues = both_values;
        infos.back().pSignalSemaphores = both;
    }
    return enqueue(infos);
}

VkResult Context::State::enqueue(std::span<const VkSubmitInfo> infos) const {
    if (lock_queue_) lock_queue_();
    const VkResult result =
        vk_.vkQueueSubmit(queue_, static_cast<std::uint32_t>(infos.size()), infos.data(), VK_NULL_HANDLE);
    if (unlock_queue_) unlock_queue_();
    return result;
}

SyncPoint Context::State::submit(const std::string& name, std::vector<Submission> submissions, std::uint64_t promised) {
    check_alive();
    if (submissions.empty()) return last_submission();
    check(enqueue(submissions, promised), "submit to the queue");
    if (promised) promised_.pass(promised);
    for (Submission& submission : submissions)
        submission_log_.submitted(++submitted_, name, std::move(submission.passes));
    awaited_.clear();
    collect();
    return last_submission();
}

bool Context::State::is_reached(SyncPoint point) const {
    check_alive();
    std::uint64_t value = 0;
    check(vk_.vkGetSemaphoreCounterValue(device_, point.semaphore, &value), "read the timeline");
    return value >= point.value;
}

void Context::State::check_submitted(SyncPoint point) const {
    if (!point.semaphore || point.semaphore != promised_timeline_) return;
    if (promised_.is_lost(point.value))
        fail(
            "the commands into which a sync was recorded were discarded: its results do not exist, and the objects to "
            "be synced must be created again");
    if (!promised_.is_passed(point.value)) fail("the commands into which a sync was recorded must be submitted first");
}

void Context::State::wait(SyncPoint point) const {
    check_submitted(point);
    wait_for(point);
}

void Context::State::wait_for(SyncPoint point) const {
    check_alive();
    if (!point.semaphore || !point.value) return;
    VkSemaphoreWaitInfo info = OfType{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &point.semaphore;
    info.pValues = &point.value;
    check(wait_for(info), "wait for the GPU");
    if (point.semaphore == timeline_) submission_log_.reached(point.value);
}

// Keeps waiting while the device finishes submissions.
VkResult Context::State::wait_for(const VkSemaphoreWaitInfo& info) const {
    if (most_wait_seconds_ <= 0) return wait_patiently(info, UINT64_MAX);
    const auto most = static_cast<std::uint64_t>(most_wait_seconds_ * 1e9);
    for (std::uint64_t ended = reached(timeline_);;) {
        const VkResult result = wait_patiently(info, most);
        if (result != VK_TIMEOUT) return result;
        const std::uint64_t now = reached(timeline_);
        if (now == ended) {
            is_hung_ = true;
            fault_ = text("; it has ended none of its submissions for ", most_wait_seconds_, " s");
            return VK_ERROR_DEVICE_LOST;
        }
        ended = now;
    }
}

// Waits for so many nanoseconds; in pieces if somebody may want to end the wait.
VkResult Context::State::wait_patiently(const VkSemaphoreWaitInfo& info, std::uint64_t most) const {
    if (!is_interruptible()) return vk_.vkWaitSemaphores(device_, &info, most);
    constexpr auto piece = static_cast<std::uint64_t>(seconds_between_looks * 1e9);
    for (std::uint64_t left = most;; left -= piece) {
        look_for_interruption();
        const VkResult result = vk_.vkWaitSemaphores(device_, &info, std::min(left, piece));
        if (result != VK_TIMEOUT || left <= piece) return result;
    }
}

void Context::State::wait_for_gpu() {
    wait(last_submission());
    for (SyncPoint point : announced_) {
        // Commands that are not submitted yet are no work of the GPU.
        if (point.semaphore == promised_timeline_) point.value = std::min(point.value, promised_.last_passed());
        wait_for(point);
    }
    std::erase_if(announced_, [&](const SyncPoint& point) {
        return point.semaphore != promised_timeline_ || promised_.is_passed(point.value);
    });
    collect();
}

void Context::State::announce(SyncPoint point) {
    for (SyncPoint& known : announced_) {
        if (known.semaphore != point.semaphore) continue;
        known.value = std::max(known.value, point.value);
        return;
    }
    announced_.push_back(point);
}

void Context::State::retire(std::function<void()> destroy) {
    retired_.push_back({submitted_, announced_, std::move(destroy)});
}

std::uint64_t Context::State::reached(VkSemaphore semaphore) const noexcept {
    std::uint64_t value = 0;
    const VkResult result = vk_.vkGetSemaphoreCounterValue(device_, semaphore, &value);
    is_lost_ |= result == VK_ERROR_DEVICE_LOST;
    return result == VK_SUCCESS ? value : 0;
}

void Context::State::collect() noexcept {
    if (retired_.empty() || !timeline_ || !is_of_this_process()) return;
    std::erase_if(announced_, [&](SyncPoint point) { return reached(point.semaphore) >= point.value; });
    const std::uint64_t own = reached(timeline_);
    submission_log_.reached(own);
    const auto is_past = [&](SyncPoint point) { return reached(point.semaphore) >= point.value; };
    while (!retired_.empty() && retired_.front().submitted <= own &&
           std::ranges::all_of(retired_.front().announced, is_past)) {
        retired_.front().destroy();
        retired_.pop_front();
    }
}

// Resources that the GPU still uses must not be destroyed, even if waiting fails: reading the timeline needs no memory.
void Context::State::finish() noexcept {
    const InterruptScope patient([] { return true; });
    try {
        wait(last_submission());
        wait_for({promised_timeline_, promised_.last_passed()});
    } catch (const Error& error) {
        warn(error.what());
        while (!is_lost_ && reached(timeline_) < submitted_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

}  // namespace twinray
