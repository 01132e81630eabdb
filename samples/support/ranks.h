// SPDX-License-Identifier: MIT
// The processes that mpirun started; else this one alone.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <twinray/context.h>

namespace twinray::samples {

// The calls of MPI that Ranks needs. They are a library of their own, because Open MPI's take a tenth of a second to
// load.
struct MpiCalls {
    void (*begin)(int& index, int& count, int& index_on_machine);
    void (*end)();
    void (*send)(std::span<const std::byte> bytes);  // to rank 0
    void (*receive)(std::span<std::byte> bytes, int from);
    void (*wait_for_all)();
};

class Ranks {
  public:
    // Throws Error where mpirun started a program that has no MPI.
    Ranks();
    // Waits for the others, unless abandon() was called.
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    uint index() const { return index_; }
    uint count() const { return count_; }
    uint local_index() const { return local_index_; }  // among those on this machine

    // Rank 0 receives what others send, in their order.
    void send(std::span<const std::byte> bytes) const;
    void receive(std::span<std::byte> bytes, uint from) const;
    void wait_for_all() const;
    // Ends without the others, one of which is lost: from now on nothing waits for them.
    void abandon() { is_abandoned_ = true; }

  private:
    uint index_ = 0, count_ = 1, local_index_ = 0;
    bool is_abandoned_ = false;
    std::optional<MpiCalls> mpi_;  // set if a launcher of MPI started this
};

// Processes of one machine take turns on its best devices. Returns the index of the device.
std::size_t device_of_rank(std::span<const DeviceProperties> devices, uint local_index);

}  // namespace twinray::samples

extern "C" void twinray_mpi_calls(twinray::samples::MpiCalls& calls);
