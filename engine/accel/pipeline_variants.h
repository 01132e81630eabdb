// SPDX-License-Identifier: MIT
// The programs that an accelerator traces with where the scene needs none of the user's: one for each set of features.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "engine/accel/trace_program.h"

namespace twinray {

// The first trace compiles the leanest program that fits, and waits for it. The next one has the program that fits all
// scenes compiled in the background, which serves from then on while leaner ones are compiled there, too: who traces
// once pays for one program. There are at most 32 sets of features of an accelerator (see features_of.h), so that none
// has to go.
//
// Used by one thread at a time; one of its own compiles. The context must outlive it.
class PipelineVariants {
  public:
    using Create = std::function<std::unique_ptr<TraceProgram>(uint features)>;
    // `in_background`: false lets every first trace wait for the program that fits. `all` holds the features of every
    // get().
    PipelineVariants(Create create, uint all, bool in_background);
    // Waits for the program that is being compiled, if there is one; those not begun are dropped.
    ~PipelineVariants();
    PipelineVariants(const PipelineVariants&) = delete;
    PipelineVariants& operator=(const PipelineVariants&) = delete;

    // A program, ready to record, for these features or more. Throws Error where none can be compiled.
    const TraceProgram& get(uint features, Query query, Level level);
    // Until nothing is left to compile.
    void wait() const;

  private:
    struct Job {
        const TraceProgram* program;
        Query query;
        Level level;

        auto operator<=>(const Job&) const = default;
    };
    enum class State : std::uint8_t { missing, queued, ready, failed };

    Job job(uint features, Query query, Level level);
    State state(const Job& job) const;
    void queue(const Job& job);
    void compile_now(const Job& job);
    void work();

    Create create_;
    uint all_;
    bool in_background_;
    std::map<uint, std::unique_ptr<TraceProgram>> programs_;  // by features
    mutable std::mutex mutex_;                                // of what follows
    mutable std::condition_variable changed_;
    std::map<Job, State> states_;
    std::deque<Job> queue_;  // the first one is being compiled
    bool is_ending_ = false;
    std::thread worker_;  // from the first job on
};

}  // namespace twinray
