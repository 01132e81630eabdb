// SPDX-License-Identifier: MIT
// Without MPI.
#include <cstdlib>

#include "samples/support/ranks.h"
#include "samples/support/text.h"

namespace twinray::samples {

Ranks::Ranks() {
    if (const char* size = std::getenv("OMPI_COMM_WORLD_SIZE"); size && std::string(size) != "1")
        fail("started by mpirun, but built without MPI (Debian: libopenmpi-dev); use --shard");
}

Ranks::~Ranks() = default;

void Ranks::send(std::span<const std::byte>) const {}
void Ranks::receive(std::span<std::byte>, uint) const {}
void Ranks::wait_for_all() const {}

}  // namespace twinray::samples
