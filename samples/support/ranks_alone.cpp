// SPDX-License-Identifier: MIT
// Without MPI.
#include <cstdlib>

#include "samples/support/ranks.h"
#include "samples/support/text.h"

namespace twinray::samples {

Ranks::Ranks() {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})  // of Open MPI; of MPICH and srun
        if (const char* size = std::getenv(name); size && std::string(size) != "1")
            fail("started as one of ", size, " ranks (", name,
                 "), but built without MPI (Debian: libopenmpi-dev); use --shard");
}

Ranks::~Ranks() = default;

void Ranks::send(std::span<const std::byte>) const {}
void Ranks::receive(std::span<std::byte>, uint) const {}
void Ranks::wait_for_all() const {}

}  // namespace twinray::samples
