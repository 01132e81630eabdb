// A geometry as an accelerator holds it, and a sync's records before it is certain to run.
#pragma once

#include "engine/accel/accel_backend.h"
#include "engine/accel/surface_tables.h"
#include "engine/accel/mesh_store.h"

namespace twinray {

// A geometry, of one handle or more.
struct AccelBackend::HeldGeometry {
    Geometry geometry;
    Buffer block;                          // see GeometryInput
    std::unique_ptr<BuiltGeometry> built;  // null: `geometry` is not built yet
    SyncPoint built_at = {};
    StoredMesh stored = {};
    SurfaceSlice surface = {};
    std::size_t handles = 0;  // alive
    bool has_source = false;  // the block's GeometrySource is that of `geometry`
    bool is_listed = false;   // among edited_
};

// The records of a sync, to be committed once it is certain to run.
struct AccelBackend::Staged {
    MeshStore::Staged meshes;
    std::vector<HeldGeometry*> sources;  // their GeometrySource was written
    std::vector<bool> is_rebuilt;        // by moved item of `meshes`, which come first
    std::optional<Buffer> refinement;
    SurfaceTables::Staged surfaces;
    std::vector<HeldGeometry*> building;
    std::vector<std::unique_ptr<BuiltGeometry>> built;      // by `building`
    std::vector<std::shared_ptr<HeldGeometry>> geometries;  // those that it examined
    std::vector<std::weak_ptr<HeldGeometry>> uncompacted;   // their compacted sizes are not known yet
    std::vector<InstanceSlice*> slices;                     // those that were edited, or all
    InstanceArray::Staged instances;
    std::unique_ptr<BuiltTlas> scene;
    bool has_bound = false;
    bool is_scene_built = false;  // not refitted
    bool has_moved = false;

    void add(const Work& work, std::vector<std::unique_ptr<BuiltGeometry>>&& done);
};

}  // namespace twinray
