// SPDX-License-Identifier: MIT
// With MPI.
#include <mpi.h>

#include <algorithm>
#include <cstdlib>

#include "samples/support/ranks.h"

namespace twinray::samples {
namespace {

// Passes on any number of bytes, in blocks that fit into the int of a count.
template <class Byte, class Move>
void in_pieces(std::span<Byte> bytes, const Move& move) {
    constexpr std::size_t most = 1 << 30;
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(most, bytes.size())))
        move(bytes.data(), static_cast<int>(std::min(most, bytes.size())));
}

}  // namespace

// A process that neither mpirun nor srun has started needs none of it.
Ranks::Ranks() {
    if (!std::getenv("OMPI_COMM_WORLD_SIZE") && !std::getenv("PMIX_RANK") && !std::getenv("PMI_SIZE")) return;
    MPI_Init(nullptr, nullptr);
    int index = 0, count = 1, local = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &index);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &local);
    MPI_Comm_free(&machine);
    index_ = static_cast<uint>(index), count_ = static_cast<uint>(count), local_index_ = static_cast<uint>(local);
}

Ranks::~Ranks() {
    int is_on = 0;
    MPI_Initialized(&is_on);
    if (is_on && !is_abandoned_) MPI_Finalize();
}

void Ranks::send(std::span<const std::byte> bytes) const {
    in_pieces(bytes, [](const std::byte* data, int size) { MPI_Send(data, size, MPI_BYTE, 0, 0, MPI_COMM_WORLD); });
}

void Ranks::receive(std::span<std::byte> bytes, uint from) const {
    in_pieces(bytes, [&](std::byte* data, int size) {
        MPI_Recv(data, size, MPI_BYTE, static_cast<int>(from), 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
}

void Ranks::wait_for_all() const {
    if (count_ > 1) MPI_Barrier(MPI_COMM_WORLD);
}

}  // namespace twinray::samples
