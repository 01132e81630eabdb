// SPDX-License-Identifier: MIT
#include "engine/accel/pipeline_variants.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {

PipelineVariants::PipelineVariants(Create create, uint all, bool in_background)
    : create_(std::move(create)), all_(all), in_background_(in_background) {}

PipelineVariants::~PipelineVariants() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    changed_.notify_all();
    if (worker_.joinable()) worker_.join();
}

const TraceProgram& PipelineVariants::get(uint features, Query query, Level level) {
    const Job wanted = job(features, query, level), general = job(all_, query, level);
    if (state(wanted) == State::ready) {
        if (in_background_) queue(general);
        return *wanted.program;
    }
    if (in_background_ && state(general) == State::ready) {
        queue(wanted);
        return *general.program;
    }
    compile_now(wanted);
    return *wanted.program;
}

void PipelineVariants::wait() const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return queue_.empty(); });
}

PipelineVariants::Job PipelineVariants::job(uint features, Query query, Level level) {
    std::unique_ptr<TraceProgram>& program = programs_[features];
    if (!program) program = create_(features);
    return {program.get(), query, level};
}

PipelineVariants::State PipelineVariants::state(const Job& job) const {
    const std::lock_guard lock(mutex_);
    const auto found = states_.find(job);
    return found == states_.end() ? State::missing : found->second;
}

// A variant that has failed in the background is not tried there again.
void PipelineVariants::queue(const Job& job) {
    {
        const std::lock_guard lock(mutex_);
        State& state = states_[job];
        if (state != State::missing) return;
        state = State::queued;
        queue_.push_back(job);
        if (!worker_.joinable()) worker_ = std::thread([this] { work(); });
    }
    changed_.notify_all();
}

void PipelineVariants::compile_now(const Job& job) {
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return states_[job] != State::queued; });
        if (states_[job] == State::ready) return;
    }
    job.program->prepare(job.query, job.level);
    const std::lock_guard lock(mutex_);
    states_[job] = State::ready;
}

void PipelineVariants::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return is_ending_ || !queue_.empty(); });
        if (is_ending_) return;
        const Job job = queue_.front();
        lock.unlock();
        State result = State::ready;
        try {
            job.program->prepare(job.query, job.level);
        } catch (const std::exception&) {
            result = State::failed;  // the program that serves meanwhile goes on serving
        }
        lock.lock();
        states_[job] = result;
        queue_.pop_front();
        changed_.notify_all();
    }
}

}  // namespace twinray
