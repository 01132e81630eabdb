// SPDX-License-Identifier: MIT
#include "samples/path_tracer/interrupts.h"

#include <csignal>

namespace twinray::path_tracer {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int number) {
    noted = number;
    std::signal(number, SIG_DFL);
}

}  // namespace

Interrupts::Interrupts() {
    noted = 0;
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
}

Interrupts::~Interrupts() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

int Interrupts::signal() const { return noted; }

}  // namespace twinray::path_tracer
