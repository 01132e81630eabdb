// The programs that an accelerator traces with if the scene needs none of the user's: one for each set of features.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "engine/accel/trace_program.h"
#include "engine/core/platform.h"

namespace twinray {

// The first trace compiles the leanest program that fits, and waits for it. The next one has the program that fits all
// scenes compiled in the background. That one serves from then on while leaner ones are also compiled there: a user who
// traces once pays for one program. None is dropped: an accelerator has at most 32 sets of features without a trace
// program (features_of() in trace_desc.h).
//
// It is used by one thread at a time and compiles on a thread of its own. The context must outlive it.
class PipelineVariants {
  public:
    using Create = std::function<std::unique_ptr<TraceProgram>(uint features)>;
    // If `in_background` is false, every first trace waits for its program. `all` holds the features of every get().
    PipelineVariants(Create create, uint all, bool in_background);
    // Waits for the program that is being compiled, if there is one; those not begun are dropped.
    ~PipelineVariants();
    PipelineVariants(const PipelineVariants&) = delete;
    PipelineVariants& operator=(const PipelineVariants&) = delete;

    // Returns a program, ready to record, for these features or more. Throws Error if none can be compiled.
    const TraceProgram& get(uint features, Query query, Level level);
    // Waits until nothing is left to compile.
    void wait() const;

  private:
    struct Job {
        const TraceProgram* program;
        Query query;
        Level level;

        auto operator<=>(const Job&) const = default;
    };
    enum class State : std::uint8_t { missing, queued, ready, failed };
    struct Background {
        int process = platform::process_id();  // the only process that has the worker
        std::mutex mutex;                      // for the members below
        std::condition_variable changed;
        std::map<Job, State> states;
        std::deque<Job> queue;  // the first one is being compiled
        bool is_ending = false;
        std::thread worker;  // exists from the first job on
    };

    Job job(uint features, Query query, Level level);
    State state(const Job& job) const;
    void queue(const Job& job);
    void compile_now(const Job& job);
    void work();

    Create create_;
    uint all_;
    bool in_background_;
    std::map<uint, std::unique_ptr<TraceProgram>> programs_;  // by features
    std::unique_ptr<Background> background_ = std::make_unique<Background>();
};

}  // namespace twinray
