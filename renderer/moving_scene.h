// A scene on the device that is posed again for each picture.
#pragma once

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "renderer/scene_upload.h"

namespace twinray::path_tracer {

// Returns the handle of each mesh. push_scene makes one for each mesh that has instances, in their order.
std::vector<AccelHandle> handles_by_mesh(const Scene& scene, const std::vector<AccelHandle>& handles);

// The times of one pose, in milliseconds.
struct MotionTimes {
    double host = 0;          // lights, records
    double vertices = 0;      // skins and morph targets on the device
    double refit = 0;         // of the accelerator, until it is done
    double refit_device = 0;  // the device's share of it
};

// Brings poses of a scene's rig to the device: vertices by a Deformer, whose memory the path tracer and the accelerator
// read in place, instances by their transforms, the accelerator by a refit, and lights with the densities of their
// positions. Poses leave views valid.
class MovingScene {
  public:
    // The scene has a rig, its meshes are at rest, and the accelerator holds it as from push_scene; its views end. All
    // three must outlive this, and need it from then on.
    MovingScene(Context& context, Scene& scene, DeviceScene& device_scene, AbstractAccel& accel);

    // Waits until it is done. Also moves the scene's instances, cameras and lights, and those of its meshes that emit.
    MotionTimes move_to(const Pose& pose);

  private:
    // Makes the path tracer and the accelerator read the deformer's memory.
    void share_vertices();
    void move_records();
    void move_emitters(const Pose& pose);
    void move_vertices(const Pose& pose);
    // Returns false if nothing moved.
    bool edit_accel(const std::vector<Instance>& before);

    Context& context_;
    Scene& scene_;
    DeviceScene& device_scene_;
    AbstractAccel& accel_;
    std::vector<AccelHandle> handles_;   // by mesh
    std::vector<uint> deformed_;         // deformed_meshes() of the rig
    std::vector<std::size_t> emitting_;  // indices into deformed_
    Deformer deformer_;
    Buffer transforms_;  // by instance
};

}  // namespace twinray::path_tracer
