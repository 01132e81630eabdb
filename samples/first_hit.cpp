// SPDX-License-Identifier: MIT
#include <cmath>
#include <iostream>

#include <twinray/geometry.h>
#include <twinray/tlas.h>

int main() try {
    using namespace twinray;
    Context context;  // or adopt your VkDevice: Context(AdoptedDevice{...})
    const auto accel = make_accel(context, choose_accel(context.properties(), "auto"));  // "sw" and "hw" force one
    accel->push(make_icosphere(5), Transform::translation({0, 0, -3}));
    const Ray ray{.origin = vec3(0.1f, 0.2f, 0), .t_min = 0, .direction = vec3(0, 0, -1), .t_max = INFINITY};
    const Hit hit = accel->closest_hits({&ray, 1}).front();  // builds what changed, traces, waits
    std::cout << accel->name() << ": instance " << hit.instance_index << " at t = " << hit.t << '\n';
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
