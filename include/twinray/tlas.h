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
    explicit SwTlas(Context& context, const AccelOptions& options = {});  // throws Error naming what is lacking

    // What the software accelerator can do on a device that it runs on.
    static Capability capability_on(const DeviceProperties& device, Feature feature);

    // Writes the built geometries and their instances, without what AccelOptions::keeps_surfaces keeps. Throws Error
    // when edits are pending and when the file cannot be written, which is then as it was before.
    void save(const std::filesystem::path& file) const;
    // What load() has read.
    struct Loaded {
        std::unique_ptr<SwTlas> accel;
        std::vector<AccelHandle> handles;  // in the order in which they were pushed
    };
    // A new accelerator with what save() has written. Its first sync() builds the top level alone; closest hits
    // are equal to the last bit, any hits too unless the saved top level had been refitted. Throws Error naming the
    // file, what was found and what was expected when it is missing, damaged, of another format version, or not a saved
    // SwTlas.
    static Loaded load(Context& context, const std::filesystem::path& file);

    // What the library itself needs of it.
    SwBackend& backend() const;
};

// The order in which triangles and instances go to the driver. Results do not depend on it.
enum class BuildOrder : std::uint8_t {
    automatic,  // morton where the driver is known to build in the order of its input, else input
    input,      // as pushed; no table to map ids back exists then
    morton,
};

// The hardware accelerator, on VK_KHR_acceleration_structure. Traces with ray queries where they are enabled, else with
// a ray tracing pipeline. Where the driver finds two triangles at the same distance, the driver chooses.
class HwTlas final : public AbstractAccel {
  public:
    // Throws Error naming the device and what it lacks.
    explicit HwTlas(Context& context, BuildOrder order = BuildOrder::automatic, const AccelOptions& options = {});

    // What the hardware accelerator can do on a device that it runs on.
    static Capability capability_on(const DeviceProperties& device, Feature feature);

    // "ray query" or "ray tracing pipeline".
    const char* trace_path() const;
    // Whether the driver gets the input along a Morton curve, so that its ids are mapped back to the user's.
    bool reorders() const;
};

// What the program will ask for.
struct AccelNeeds {
    Level level = Level::watertight;
    bool kernel_queries = false;  // Feature::kernel_queries
};

// What choose_accel() chose, and why.
struct AccelChoice {
    bool is_software = false;
    std::string why;  // "device 'cpu' is a CPU, without hardware for rays"

    const char* name() const { return is_software ? "sw" : "hw"; }  // as --accel takes it

    bool operator==(const AccelChoice&) const = default;
};

// "SwTlas" or "HwTlas", as AbstractAccel::name() is.
const char* name_of(const AccelChoice& choice);

// request, as --accel takes it: "sw", "hw" or "auto": hardware, but software where the device is a CPU, on which a
// driver's structures are code, too, and where hardware lacks something. Throws Error for "hw" in the latter case; it
// names what is lacking.
AccelChoice choose_accel(const DeviceProperties& device, const std::string& request, const AccelNeeds& needs = {});
// The one that was chosen, empty. Throws Error as its constructor does.
std::unique_ptr<AbstractAccel> make_accel(Context& context, const AccelChoice& choice,
                                          const AccelOptions& options = {});

}  // namespace twinray
