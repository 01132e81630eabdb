// SPDX-License-Identifier: MIT
#include "samples/support/ranks.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "engine/core/platform.h"
#include "samples/support/text.h"

namespace twinray::samples {
namespace {

std::optional<MpiCalls> load_mpi() {
    const std::filesystem::path file = platform::this_program().parent_path().parent_path() / TWINRAY_MPI_LIBRARY;
    void* library = platform::open_library(file.string().c_str());
    if (!library) return {};
    MpiCalls calls{};
    reinterpret_cast<decltype(&twinray_mpi_calls)>(platform::symbol_of(library, "twinray_mpi_calls"))(calls);
    return calls;
}

}  // namespace

// A process that neither mpirun nor srun has started needs none of it.
Ranks::Ranks() {
    if (!std::getenv("OMPI_COMM_WORLD_SIZE") && !std::getenv("PMIX_RANK") && !std::getenv("PMI_SIZE")) return;
    mpi_ = load_mpi();
    if (mpi_) {
        int index = 0, count = 1, local = 0;
        mpi_->begin(index, count, local);
        index_ = static_cast<uint>(index), count_ = static_cast<uint>(count), local_index_ = static_cast<uint>(local);
        return;
    }
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})  // of Open MPI; of MPICH and srun
        if (const char* size = std::getenv(name); size && std::string(size) != "1")
            fail("started as one of ", size, " ranks (", name, "), but there is no ", TWINRAY_MPI_LIBRARY,
                 ", which is built where there is MPI (Debian: libopenmpi-dev); use --shard");
}

Ranks::~Ranks() {
    if (mpi_ && !is_abandoned_) mpi_->end();
}

void Ranks::send(std::span<const std::byte> bytes) const { mpi_->send(bytes); }

void Ranks::receive(std::span<std::byte> bytes, uint from) const { mpi_->receive(bytes, static_cast<int>(from)); }

void Ranks::wait_for_all() const {
    if (count_ > 1) mpi_->wait_for_all();
}

std::size_t device_of_rank(std::span<const DeviceProperties> devices, uint local_index) {
    const int best = choose_device(devices, "").index;
    if (best < 0) return 0;
    const auto is_alike = [&](const DeviceProperties& device) {
        return device.kind == devices[static_cast<std::size_t>(best)].kind && missing_for_software(device).empty();
    };
    std::vector<std::size_t> alike;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (is_alike(devices[i])) alike.push_back(i);
    return alike[local_index % alike.size()];
}

}  // namespace twinray::samples
