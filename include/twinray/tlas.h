// SPDX-License-Identifier: MIT
// The two accelerators, and the choice of one.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>

namespace twinray {

class SwBackend;

// The software accelerator: a two-level BVH built and traversed by compute shaders. Needs no ray tracing extension.
class SwTlas final : public AbstractAccel {
  public:
    explicit SwTlas(Context& context, const AccelOptions& options = {});  // throws Error naming what the device lacks

    // Returns the software accelerator's support for a feature on a device that it runs on.
    static Capability capability_on(const DeviceProperties& device, Feature feature);

    // Writes the built geometries and their instances, without the data of AccelOptions::keeps_surfaces. Throws Error
    // if edits are pending or the file cannot be written; an existing file is then unchanged.
    void save(const std::filesystem::path& file) const;
    // The result of load().
    struct Loaded {
        std::unique_ptr<SwTlas> accel;
        std::vector<AccelHandle> handles;  // in the order in which they were pushed
    };
    // Makes a new accelerator from a file written by save(). Its first sync() builds the top level only; closest hits
    // are equal to the last bit, as are any hits unless the saved top level had been refitted. If the file is missing,
    // damaged, of another format version or not a saved SwTlas, throws Error naming the file, what was found and what
    // was expected.
    static Loaded load(Context& context, const std::filesystem::path& file);

    // Internal: the library's own parts use it.
    SwBackend& backend() const;
};

// The order in which triangles and instances go to the driver. Results do not depend on it.
enum class BuildOrder : std::uint8_t {
    automatic,  // morton if the driver is known to build in the order of its input, else input
    input,      // as pushed; needs no table to map ids back
    morton,
};

// The hardware accelerator, on VK_KHR_acceleration_structure. Traces with ray queries if they are enabled, else with a
// ray tracing pipeline. If two triangles are at the same distance, the driver chooses.
class HwTlas final : public AbstractAccel {
  public:
    // Throws Error naming the device and the features that it lacks.
    explicit HwTlas(Context& context, BuildOrder order = BuildOrder::automatic, const AccelOptions& options = {});

    // Returns the hardware accelerator's support for a feature on a device that it runs on.
    static Capability capability_on(const DeviceProperties& device, Feature feature);

    // "ray query" or "ray tracing pipeline".
    const char* trace_path() const;
    // Returns whether the driver gets the input along a Morton curve, so that its ids are mapped back to the user's.
    bool reorders() const;
};

// The features that the program will need.
struct AccelNeeds {
    Level level = Level::watertight;
    bool kernel_queries = false;  // Feature::kernel_queries
};

// The choice of choose_accel() and its reason.
struct AccelChoice {
    bool is_software = false;
    std::string why;  // "device 'cpu' is a CPU, without hardware for rays"

    const char* name() const { return is_software ? "sw" : "hw"; }  // the value of --accel

    bool operator==(const AccelChoice&) const = default;
};

// Returns "SwTlas" or "HwTlas", as AbstractAccel::name() does.
const char* name_of(const AccelChoice& choice);

// Chooses by `request`, the value of --accel: "sw", "hw" or "auto". "auto" is hardware, but software on a CPU device,
// whose acceleration structures are code too, and if hardware lacks a need. For "hw", a lacking need throws Error
// naming it.
AccelChoice choose_accel(const DeviceProperties& device, const std::string& request, const AccelNeeds& needs = {});
// Makes the chosen accelerator, empty. Throws Error as its constructor does.
std::unique_ptr<AbstractAccel> make_accel(Context& context, const AccelChoice& choice,
                                          const AccelOptions& options = {});

}  // namespace twinray
