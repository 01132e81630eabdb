// SPDX-License-Identifier: MIT
// The calls of MPI that Ranks needs. They are a library of their own, because Open MPI's take a tenth of a second to
// load.
#pragma once

#include <cstddef>
#include <span>

namespace twinray::samples {

struct MpiCalls {
    void (*begin)(int& index, int& count, int& index_on_machine);
    void (*end)();
    void (*send)(std::span<const std::byte> bytes);  // to rank 0
    void (*receive)(std::span<std::byte> bytes, int from);
    void (*wait_for_all)();
};

}  // namespace twinray::samples

extern "C" void twinray_mpi_calls(twinray::samples::MpiCalls& calls);
