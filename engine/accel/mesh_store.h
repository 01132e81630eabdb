// The positions and triangles of meshes in device memory. Accelerators own them and lend them to analyses, contacts and
// distances.
#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/accel/geometry.h"
#include "engine/accel/mesh_gather.h"
#include "engine/accel/surface_area.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/copies.h"
#include "twinray/glsl/cpp_end.h"

// A mesh in device memory, which exists as long as somebody holds this. Syncs write moved vertices into the copy of an
// accelerator.
struct MeshOnDevice {
    std::shared_ptr<Buffer> buffer;  // may also hold other meshes
    PackedMesh mesh;
    float scale = 1;  // the unit of the positions

    explicit operator bool() const { return buffer != nullptr; }
};

// Uploads meshes, and other arrays that a build reads, one behind the other into a buffer from an offset on. The arrays
// must live until record().
class MeshUpload {
  public:
    explicit MeshUpload(const Buffer& target, std::uint64_t offset = 0) : target_(target), next_(offset) {}

    // Returns the address that the array will have.
    std::uint64_t add(std::span<const std::byte> array);
    PackedMesh add(std::span<const vec3> positions, std::span<const uvec3> triangles);
    void record(Commands& commands) const { commands.upload_regions(target_, regions_); }

  private:
    const Buffer& target_;
    std::uint64_t next_;
    std::vector<Commands::Region> regions_;
};

// Records the upload of meshes in host memory, many into one buffer.
std::vector<MeshOnDevice> upload_meshes(Commands& commands, std::span<const MeshView> meshes);
// Returns the memory of all of them, each buffer once.
std::uint64_t bytes_of(std::span<const MeshOnDevice> meshes);

// The parts of one geometry's mesh that the device has and lacks. It has no copy until a vertex is first moved, unless
// level refined or AccelOptions::keeps_surfaces needs it; from then on everything is built from the copy. For a
// DeviceMesh in place it only holds costs: each sync that builds or refits it makes its copy anew.
struct StoredMesh {
    MeshOnDevice copy;
    CostLog costs;               // of the geometry's tree
    std::weak_ptr<Buffer> lent;  // the copy that others asked for, where it has none
    bool edited = false;         // moved since the last sync, by the host, by `incoming` or in Geometry::device
    bool device_wrote = false;   // positions that Geometry::positions lacks
    bool gathers = false;        // the next sync reads Geometry::device
    bool rebuilds = false;       // it is another mesh of the same size
    Floats incoming;             // device memory in the user's units that the next sync copies the positions from; 0 =
                                 // Geometry::positions

    bool on_device() const { return bool(copy); }
    std::uint64_t bytes() const { return (copy ? copy.buffer->bytes() : 0) + costs.bytes(); }
    void read_again() { edited = gathers = device_wrote = true, incoming = {}; }
};

// Brings meshes and moved vertices to the device.
class MeshStore {
  public:
    explicit MeshStore(Context& context);

    struct Item {
        const Geometry* geometry;  // has triangles
        StoredMesh* stored;        // edited, or not on the device yet
    };
    // The result of stage(), to be committed once its commands are certain to run.
    struct Staged {
        std::vector<Item> items;
        std::vector<MeshOnDevice> made;  // by item; empty if the present copy serves
        std::vector<CostLog> costs;      // by item; empty if the item has one
        std::unordered_map<const StoredMesh*, std::size_t> item_of;
        MeshGather::Faults faults;

        PackedMesh mesh(std::size_t item) const { return (made[item] ? made[item] : items[item].stored->copy).mesh; }
        // Returns null for a mesh that is neither staged nor on the device.
        PackedMesh mesh_of(const StoredMesh& stored) const;
        CostTarget cost_target(std::size_t item) const;
        // Keeps copies of meshes in place, once all commands that read them are recorded.
        void retain_temporaries(Commands& commands);
    };
    Staged stage(Commands& commands, std::vector<Item> items) const;
    // Returns the stored meshes, by item.
    std::vector<StoredMesh*> commit(Staged&& staged, SyncPoint done);

    // Returns the mesh as the last sync left it, one in place as it is now. If it is not on the device, this records
    // the commands that bring it there; the caller drops it unless they are submitted.
    MeshOnDevice lend(Commands& commands, const Geometry& geometry, StoredMesh& stored) const;
    // Waits. Downloads the part of the mesh that the host lacks.
    void download(Geometry& geometry, const StoredMesh& stored) const;
    void warn_of_faults(const std::string& accel) { gather_.warn_of_faults(accel); }

  private:
    MeshOnDevice make_copy(const Geometry& geometry) const;
    void record_positions(Commands& commands, const Staged& staged) const;

    Context& context_;
    MeshGather gather_;
    Kernel<CopyFloatsArgs> copy_floats_;
};

}  // namespace twinray
