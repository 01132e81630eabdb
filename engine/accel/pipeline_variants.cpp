#include "engine/accel/pipeline_variants.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {

PipelineVariants::PipelineVariants(Create create, uint all, bool in_background)
    : create_(std::move(create)), all_(all), in_background_(in_background) {}

PipelineVariants::~PipelineVariants() {
    if (background_->process != platform::process_id()) {
        // This process does not have its worker: there is nothing to wait for.
        static_cast<void>(background_.release());
        return;
    }
    {
        const std::lock_guard lock(background_->mutex);
        background_->is_ending = true;
    }
    background_->changed.notify_all();
    if (background_->worker.joinable()) background_->worker.join();
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
    if (background_->process != platform::process_id()) return;
    std::unique_lock lock(background_->mutex);
    background_->changed.wait(lock, [&] { return background_->queue.empty(); });
}

PipelineVariants::Job PipelineVariants::job(uint features, Query query, Level level) {
    std::unique_ptr<TraceProgram>& program = programs_[features];
    if (!program) program = create_(features);
    return {program.get(), query, level};
}

PipelineVariants::State PipelineVariants::state(const Job& job) const {
    const std::lock_guard lock(background_->mutex);
    const auto found = background_->states.find(job);
    return found == background_->states.end() ? State::missing : found->second;
}

// A variant that has failed in the background is not tried there again.
void PipelineVariants::queue(const Job& job) {
    {
        const std::lock_guard lock(background_->mutex);
        State& state = background_->states[job];
        if (state != State::missing) return;
        state = State::queued;
        background_->queue.push_back(job);
        if (!background_->worker.joinable()) background_->worker = std::thread([this] { work(); });
    }
    background_->changed.notify_all();
}

void PipelineVariants::compile_now(const Job& job) {
    {
        std::unique_lock lock(background_->mutex);
        background_->changed.wait(lock, [&] { return background_->states[job] != State::queued; });
        if (background_->states[job] == State::ready) return;
    }
    job.program->prepare(job.query, job.level);
    const std::lock_guard lock(background_->mutex);
    background_->states[job] = State::ready;
}

void PipelineVariants::work() {
    std::unique_lock lock(background_->mutex);
    for (;;) {
        background_->changed.wait(lock, [&] { return background_->is_ending || !background_->queue.empty(); });
        if (background_->is_ending) return;
        const Job job = background_->queue.front();
        lock.unlock();
        State result = State::ready;
        try {
            job.program->prepare(job.query, job.level);
        } catch (const std::exception&) {
            result = State::failed;  // the program that serves meanwhile goes on serving
        }
        lock.lock();
        background_->states[job] = result;
        background_->queue.pop_front();
        background_->changed.notify_all();
    }
}

}  // namespace twinray
