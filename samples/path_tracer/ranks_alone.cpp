// SPDX-License-Identifier: MIT
// Without MPI.
#include <cstdlib>

#include "renderer/ranks.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;

Ranks::Ranks(int&, char**&) {
    if (const char* size = std::getenv("OMPI_COMM_WORLD_SIZE"); size && std::string(size) != "1")
        fail("started by mpirun, but built without MPI (Debian: libopenmpi-dev); use --shard and path_tracer merge");
}

Ranks::~Ranks() = default;

void Ranks::gather(Film&, RenderStats&) const {}

}  // namespace twinray::path_tracer
