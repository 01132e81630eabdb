// Instances: ids, masks, flags, transforms.
#include "report/conformance/case_run.h"

namespace twinray::conformance {
namespace {

constexpr uint instanced_triangles = 12;
constexpr uint largest_index = (1u << 24) - 1;

// Makes instances of one or two bottom levels, each in another place.
SceneInput many_instances(CaseRun& run, uint count) {
    SceneInput scene;
    scene.bottoms.push_back({{random_triangles(run.draws(), instanced_triangles)}});
    scene.bottoms.push_back({{random_triangles(run.draws(), instanced_triangles), random_triangles(run.draws(), 4)}});
    for (uint i = 0; i < count; ++i) {
        InstanceInput& instance = scene.top.instances.emplace_back();
        instance.bottom = run.draws().below(2);
        instance.to_world = random_instance_transform(run.draws());
    }
    return scene;
}

void ids(CaseRun& run) {
    SceneInput scene = many_instances(run, 6);
    for (InstanceInput& instance : scene.top.instances) {
        instance.custom_index = run.draws().below(largest_index + 1);
        instance.sbt_offset = run.draws().below(largest_index + 1);
    }
    scene.top.instances[0].custom_index = scene.top.instances[1].sbt_offset = largest_index;
    scene.top.instances[2].custom_index = scene.top.instances[3].sbt_offset = 0;
    run.check_hits(scene, run.shots());
}

SceneInput masked_instances(CaseRun& run) {
    SceneInput scene = many_instances(run, 6);
    for (InstanceInput& instance : scene.top.instances) instance.mask = run.draws().below(256);
    scene.top.instances[0].mask = 0;
    scene.top.instances[1].mask = 0xff;
    return scene;
}

uint any_mask(Draws& draws) { return draws.chance(0.1) ? 0 : draws.below(256); }
uint single_bit(Draws& draws) { return 1u << draws.below(8); }
uint mask_above_8_bits(Draws& draws) { return draws.below(1u << 16) << 8 | single_bit(draws); }

template <uint mask(Draws&)>
void masked(CaseRun& run) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.cull_mask = mask(run.draws());
    run.check_hits(masked_instances(run), shots);
}

// Half of the rays cull each side.
void check_culled(CaseRun& run, const SceneInput& scene) {
    std::vector<Shot> shots = run.shots();
    for (Shot& shot : shots) shot.flags = run.draws().chance(0.5) ? ray_culls_back : ray_culls_front;
    run.check_hits(scene, shots);
}

// Half of the instances have the flags.
template <VkGeometryInstanceFlagsKHR flags>
void facing(CaseRun& run) {
    SceneInput scene = many_instances(run, 5);
    for (InstanceInput& instance : scene.top.instances) instance.flags = run.draws().chance(0.5) ? flags : 0;
    scene.top.instances[0].flags = flags;
    check_culled(run, scene);
}

// Mixes opaque geometries with others and instances with the flag with others; random refusals show which is which.
template <VkGeometryInstanceFlagsKHR flags>
void opacity(CaseRun& run) {
    SceneInput scene = many_instances(run, 5);
    scene.bottoms[1].geometries[0].flags = 0;
    for (InstanceInput& instance : scene.top.instances) instance.flags = run.draws().chance(0.5) ? flags : 0;
    for (uint i = 0; i < 2; ++i) scene.top.instances[i].flags = flags;
    scene.top.instances[0].bottom = 0;
    scene.top.instances[1].bottom = 1;
    std::vector<Shot> shots = run.shots(2);
    for (Shot& shot : shots) shot.refused = run.draws().below(1u << instanced_triangles);
    run.check_hits(scene, shots);
    run.check_candidates(scene, shots);
}

void transforms(CaseRun& run) { run.check_hits(many_instances(run, 4), run.shots()); }

// Facing is decided in the object's space, so a mirror does not change it.
void mirrors(CaseRun& run) {
    SceneInput scene = many_instances(run, 3);
    for (InstanceInput& instance : scene.top.instances)
        instance.to_world = instance.to_world * Transform::scaling(vec3(run.draws().chance(0.5) ? -1 : 1, -1, 1));
    check_culled(run, scene);
}

void many(CaseRun& run) {
    SceneInput scene = scene_of(random_triangles(run.draws(), 2));
    scene.top.instances.resize(48);
    for (InstanceInput& instance : scene.top.instances)
        instance.to_world = Transform::translation(run.draws().point(3)) * random_instance_transform(run.draws());
    run.check_hits(scene, random_shots(run.draws(), run.rays(), 3));
}

}  // namespace

std::vector<Case> instance_cases() {
    using enum Misdeed;
    constexpr Topic topic = Topic::instances;
    constexpr VkGeometryInstanceFlagsKHR flip = VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR,
                                         no_cull = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
                                         force = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR,
                                         force_not = VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR;
    const std::string same = "hits are those of float64";
    return {
        {"K34", topic, "custom indices and record offsets of 24 bits", "VK-GL-CTS instance ids, slang-rhi instances",
         "hits return the given values", forgets_instance_ids, ids},
        {"K35", topic, "masks of instances, 0 and 0xff too", "VK-GL-CTS masks, slang-rhi masks",
         "instances that share no bit are not hit", forgets_instance_masks, masked<any_mask>},
        {"K36", topic, "masks of rays of a single bit", "VK-GL-CTS masks", "instances without it are not hit",
         forgets_ray_masks, masked<single_bit>},
        {"K37", topic, "masks of rays with bits above the eighth", "VK-GL-CTS masks", "the higher bits are ignored",
         forgets_ray_masks, masked<mask_above_8_bits>},
        {"K38", topic, "FACING_CULL_DISABLE against rays that cull", "VK-GL-CTS instance flags, culling",
         "nothing is culled there", forgets_instance_flags, facing<no_cull>},
        {"K39", topic, "FLIP_FACING against rays that cull", "VK-GL-CTS instance flags, culling",
         "front and back are swapped", forgets_instance_flags, facing<flip>},
        {"K40", topic, "both of these", "VK-GL-CTS instance flags, culling", "nothing is culled, and facing is swapped",
         forgets_instance_flags, facing<flip | no_cull>},
        {"K41", topic, "FORCE_OPAQUE", "VK-GL-CTS instance flags, opacity", "no candidate is offered there",
         forgets_instance_flags, opacity<force>},
        {"K42", topic, "FORCE_NO_OPAQUE", "VK-GL-CTS instance flags, opacity", "every candidate is offered there",
         forgets_instance_flags, opacity<force_not>},
        {"K43", topic, "rotation, scale and shear", "VK-GL-CTS transforms, slang-rhi transforms",
         same + ", and so are the ray and transform in object space", forgets_transforms, transforms},
        {"K44", topic, "mirrors, against rays that cull", "VK-GL-CTS culling under transforms",
         "facing is that of the object's space", forgets_transforms, mirrors},
        {"K45", topic, "48 instances of one bottom level", "VK-GL-CTS many instances", same, forgets_transforms, many},
    };
}

}  // namespace twinray::conformance
