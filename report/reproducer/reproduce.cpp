// SPDX-License-Identifier: MIT
#include "report/reproducer/reproduce.h"

#include <chrono>

#include "engine/core/error.h"
#include "report/reproducer/driver_test.h"
#include "report/reproducer/simplify.h"

namespace twinray::reproducer {
namespace {

// Whether the driver reorders this scene's triangles is known by an accelerator as users have it.
bool reorders(suite::Devices& devices, suite::Backend backend) { return HwTlas(devices.context(backend)).reorders(); }

// By the intervals that a program without twinray compares with. The answer is a fault, so a miss is none.
bool is_allowed(const ReferenceScene& reference, const Ray& ray, const Hit& answer) {
    if (!answer.hit || answer.instance_index >= reference.instance_count()) return false;
    if (!reference.geometry(answer.instance_index).find(answer.primitive_index)) return false;
    const auto right = right_hit(reference, ray, answer.instance_index, answer.primitive_index);
    return right && right->allows(answer);
}

}  // namespace

Reproduction reproduce(suite::Devices& devices, suite::Backend backend, const Scene& scene, const Ray& ray,
                       double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    DriverTest driver(devices, backend);
    Reproduction found;
    found.backend = backend;
    FaultCase fault = case_of(scene, ray, reorders(devices, backend));
    found.triangles_before = fault.triangles.size();
    const Scene whole = scene_of(fault);
    found.answer = driver.answer(whole, ray);
    found.kind = class_of(ReferenceScene::of(whole), ray, found.answer);
    if (!is_fault_of_hardware(found.kind))
        fail("the driver's own answer is ", name_of(found.kind), ", no fault, so there is nothing to reproduce");

    const auto is_late = [&] { return std::chrono::duration<double>(Clock::now() - begin).count() > seconds; };
    const CaseTest shows_fault = [&](const FaultCase& smaller) {
        if (smaller.triangles.empty() || is_late()) {
            found.was_cut_short |= !smaller.triangles.empty();
            return false;
        }
        ++found.questions;
        const Scene small = scene_of(smaller);
        const Hit answer = driver.answer(small, smaller.ray);
        const ReferenceScene reference = ReferenceScene::of(small);
        return class_of(reference, smaller.ray, answer) == found.kind && !is_allowed(reference, smaller.ray, answer);
    };
    if (FaultCase near = near_the_ray(fault, found.answer.instance_index, found.answer.primitive_index);
        shows_fault(near))
        fault = std::move(near);
    fault = simplified(std::move(fault), shows_fault);
    if (FaultCase built = as_built(fault); shows_fault(built)) fault = std::move(built);

    found.scene = scene_of(fault);
    found.ray = fault.ray;
    found.answer = driver.answer(found.scene, found.ray);
    found.right = right_answers(ReferenceScene::of(found.scene), found.ray);
    return found;
}

}  // namespace twinray::reproducer
