// SPDX-License-Identifier: MIT
// Submissions that are not known to be done: for the error of a device that stops answering.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace twinray {

// A pass of submitted commands, and how many groups its dispatches of known size have.
struct PassWork {
    std::string name;
    std::uint64_t groups = 0;
};

class SubmissionLog {
  public:
    // `value`: the timeline's value when they are done.
    void submitted(std::uint64_t value, std::string commands, std::vector<PassWork> passes);
    void reached(std::uint64_t value);
    // Says "; in flight: 'trace' (1 pass: 'swtlas_trace closest' of 625 groups)", the passes with the most groups
    // first; empty if nothing is.
    std::string sentence() const;

  private:
    struct Submission {
        std::uint64_t value;
        std::string commands;
        std::vector<PassWork> passes;
    };
    std::deque<Submission> submissions_;
};

}  // namespace twinray
