// Loops on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>

#include "engine/core/interruption.h"

namespace twinray {

// Calls body(begin, end) for disjoint ranges that cover [0, count), or body(i) for each i of them where the body takes
// one number, on `threads` threads (0: one per core). Ranges are handed out in any order, so a body must write only
// within its range: results then do not depend on the thread count. If bodies throw, the exception of the first range
// that fails is thrown here, after all threads have ended.
template <class Body>
void parallel_for(std::size_t count, const Body& body, unsigned threads = 0) {
    if (count == 0) return;
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t grain = std::clamp<std::size_t>(count / (std::size_t{threads} * 16), 1, 4096);
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::size_t failed = count;  // the range's begin
    std::mutex failure_mutex;

    const auto work = [&] {
        std::size_t begin = 0;
        try {
            for (begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain)) {
                const std::size_t end = std::min(begin + grain, count);
                if constexpr (std::is_invocable_v<const Body&, std::size_t, std::size_t>)
                    body(begin, end);
                else
                    for (std::size_t i = begin; i < end; ++i) body(i);
                look_for_interruption();
            }
        } catch (...) {
            next = count;  // the other threads stop at their next range; all before this one have been begun
            const std::lock_guard lock(failure_mutex);
            if (begin < failed) failed = begin, failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> team;
        for (unsigned i = 1; i < threads; ++i) team.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace twinray
