// SPDX-License-Identifier: MIT
#include "viewer/events.h"

#include "tests/fuzz/contract.h"

namespace twinray::fuzz {

void events(Input input) {
    is_taken([&] {
        for (const viewer::Event& event : viewer::read_events(file_of(input, "input.txt"))) viewer::text_of(event);
    });
}

}  // namespace twinray::fuzz
