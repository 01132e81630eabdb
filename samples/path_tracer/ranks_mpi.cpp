// SPDX-License-Identifier: MIT
// With MPI.
#include <mpi.h>

#include <cstdlib>

#include "renderer/ranks.h"

namespace twinray::path_tracer {
namespace {

// Sends any number of bytes, in blocks that fit into the int of a count.
template <class Move>
void in_pieces(std::span<std::byte> bytes, const Move& move) {
    constexpr std::size_t most = 1 << 30;
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(most, bytes.size())))
        move(bytes.data(), static_cast<int>(std::min(most, bytes.size())));
}

void send(std::span<std::byte> bytes) {
    in_pieces(bytes, [](std::byte* data, int size) { MPI_Send(data, size, MPI_BYTE, 0, 0, MPI_COMM_WORLD); });
}

void receive(std::span<std::byte> bytes, int from) {
    in_pieces(bytes, [&](std::byte* data, int size) {
        MPI_Recv(data, size, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
}

// The first message. The pixels and the words of the block set follow.
struct Summary {
    std::uint64_t path_rays, shadow_rays, non_finite, words;
};

template <class T>
std::span<std::byte> bytes_of(std::vector<T>& values) {
    return std::as_writable_bytes(std::span(values));
}

}  // namespace

// A process that neither mpirun nor srun has started needs none of it.
Ranks::Ranks(int& argc, char**& argv) {
    if (!std::getenv("OMPI_COMM_WORLD_SIZE") && !std::getenv("PMIX_RANK") && !std::getenv("PMI_SIZE")) return;
    MPI_Init(&argc, &argv);
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

void Ranks::gather(Film& film, RenderStats& stats) const {
    if (count_ == 1) return;
    if (index_ > 0) {
        std::vector<uint> words = film.blocks.words();
        Summary summary{stats.path_rays, stats.shadow_rays, stats.non_finite, words.size()};
        send(std::as_writable_bytes(std::span(&summary, 1)));
        send(bytes_of(film.pixels));
        send(bytes_of(words));
        return;
    }
    for (uint rank = 1; rank < count_; ++rank) {
        const int from = static_cast<int>(rank);
        Summary summary{};
        receive(std::as_writable_bytes(std::span(&summary, 1)), from);
        Film other = Film::empty(film.width, film.height, film.block_size, film.configuration);
        receive(bytes_of(other.pixels), from);
        std::vector<uint> words(summary.words);
        receive(bytes_of(words), from);
        other.blocks = BlockSet(std::move(words));
        film.merge(other, "rank 0", "rank " + std::to_string(rank));
        stats.path_rays += summary.path_rays, stats.shadow_rays += summary.shadow_rays;
        stats.non_finite += summary.non_finite;
    }
}

}  // namespace twinray::path_tracer
