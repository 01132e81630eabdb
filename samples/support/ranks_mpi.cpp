// SPDX-License-Identifier: MIT
#include <mpi.h>

#include <algorithm>

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

void begin(int& index, int& count, int& index_on_machine) {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &index);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &index_on_machine);
    MPI_Comm_free(&machine);
}

void end() { MPI_Finalize(); }

void send(std::span<const std::byte> bytes) {
    in_pieces(bytes, [](const std::byte* data, int size) { MPI_Send(data, size, MPI_BYTE, 0, 0, MPI_COMM_WORLD); });
}

void receive(std::span<std::byte> bytes, int from) {
    in_pieces(bytes, [&](std::byte* data, int size) {
        MPI_Recv(data, size, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
}

void wait_for_all() { MPI_Barrier(MPI_COMM_WORLD); }

}  // namespace
}  // namespace twinray::samples

void twinray_mpi_calls(twinray::samples::MpiCalls& calls) {
    using namespace twinray::samples;
    calls = {&begin, &end, &send, &receive, &wait_for_all};
}
