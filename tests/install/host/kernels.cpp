// A program outside twinray with a kernel and a trace program of its own. Exits with 0 if both trace.
#include <cmath>
#include <iostream>
#include <stdexcept>

#include "cube.trace_program.h"
#include "host_kernel_hw.spv.h"
#include "host_kernel_sw.spv.h"
#include <twinray/tlas.h>

namespace {

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
}

struct Args {
    std::uint64_t accel;
    twinray::Ref<twinray::Hit> hit;
};

void run(twinray::AbstractAccel& accel) {
    using namespace twinray;
    Context& context = accel.context();
    const AccelHandle sphere = accel.push(make_icosphere(3));
    accel.sync();
    const std::span<const uint> spirv =
        accel.is_software() ? std::span<const uint>(host_kernel_sw_spirv) : std::span<const uint>(host_kernel_hw_spirv);
    const Kernel<Args> kernel(context, {.name = "host kernel", .spirv = spirv, .group_size = 1, .constants = {}});
    const Buffer hit(context, {.name = "hit", .bytes = sizeof(Hit)});
    Commands commands(context, "host kernel");
    kernel.dispatch(commands, {accel.view().scene, hit.ref<Hit>()}, 1);
    commands.submit();
    const Ray ray{.origin = vec3(0.1f, 0.2f, 5), .t_min = 0, .direction = vec3(0, 0, -1), .t_max = 100};
    const Hit found = download<Hit>(context, hit, 1).front(), expected = accel.closest_hits({&ray, 1}).front();
    require(found.hit == 1 && found.t == expected.t && found.primitive_index == expected.primitive_index,
            "the kernel's hit is not the batch's");

    accel.erase(sphere);
    const Bounds box{vec3(-1), vec3(1)};
    accel.push(BoxesView{"box", {&box, 1}});
    const auto program = accel.make_program(cube);
    TraceDesc desc;
    desc.program = program.get();
    require(accel.closest_hits({&ray, 1}, desc).front().t == 50, "the trace program's hit is missing");
}

}  // namespace

int main() try {
    twinray::Context context;
    twinray::SwTlas software(context);
    run(software);
    if (context.properties().ray_query) {
        twinray::HwTlas hardware(context);
        run(hardware);
    }
    std::cout << "kernels of a host trace\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
