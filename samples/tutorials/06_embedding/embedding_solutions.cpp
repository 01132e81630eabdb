// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <iostream>
#include <set>

#include "renderer.h"
#include "shadows.h"

using namespace renderer;

namespace {

constexpr VkExtent2D size{210, 180};
using Picture = std::vector<twinray::Rgb>;

// [exercise1]
Picture shadowed_picture(RayTracing ray_tracing, const std::string& accel) {
    const Device device(ray_tracing);
    const Scene scene = make_scene(device);
    Renderer renderer(device, scene, size);
    Shadows shadows(device, scene, size, accel);
    std::cout << "1: " << twinray::name_of(shadows.choice()) << ", " << shadows.choice().why << '\n';
    return renderer.picture(renderer.submit(scene, &shadows));
}

std::size_t differing_pixels(const Picture& a, const Picture& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
    return count;
}

// [exercise2]
// Memory that twinray gets from the renderer: that of a Buffer, each with memory of its own.
struct Lender {
    const Device& device;
    std::set<VkBuffer> lent = {};
    std::uint64_t bytes = 0;  // all that was ever lent
};

VkResult allocate(void* user, const twinray::BufferRequest& request, twinray::AllocatedBuffer& result) {
    auto& lender = *static_cast<Lender*>(user);
    // request.alignment: memory of its own begins at large powers of two; parts of a block must heed it.
    const auto place = request.memory == twinray::Memory::device ? Buffer::Place::device : Buffer::Place::host;
    try {
        auto buffer = std::make_unique<Buffer>(lender.device, request.bytes, place, request.usage);
        result.buffer = buffer->handle();
        result.mapped = buffer->mapped();
        result.allocation = buffer.release();  // twinray hands it back to free()
    } catch (const std::exception&) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;  // hooks do not throw
    }
    lender.lent.insert(result.buffer);
    lender.bytes += request.bytes;
    return VK_SUCCESS;
}

void free(void* user, const twinray::AllocatedBuffer& buffer) {
    static_cast<Lender*>(user)->lent.erase(buffer.buffer);
    delete static_cast<Buffer*>(buffer.allocation);
}
// [/exercise2]

void trace_in_lent_memory() {
    const Device device(RayTracing::if_there);
    Lender lender{device};
    {
        // [lend]
        twinray::AdoptedDevice adopted = device.adopted();
        adopted.allocator = {.allocate = allocate, .free = free, .user = &lender};
        twinray::Context context(adopted);
        // [/lend]
        twinray::SwTlas accel(context);
        accel.push(twinray::make_icosphere(5));
        const twinray::Ray ray{.origin = {0, 0, 4}, .t_min = 0, .direction = {0, 0, -1}, .t_max = 9};
        const twinray::Hit hit = accel.closest_hits({&ray, 1}).front();
        std::cout << "2: a hit at t = " << hit.t << "; " << lender.lent.size() << " buffers are lent\n";
        if (!hit.hit || lender.lent.empty()) throw twinray::Error("twinray does not use the renderer's memory");
    }
    std::cout << "2: at the end " << lender.lent.size() << " buffers are lent; " << lender.bytes
              << " bytes were in all\n";
    if (!lender.lent.empty()) throw twinray::Error("twinray kept memory of the renderer's");
}

// [exercise3]
// Prints twinray's error for a mistake.
template <class Mistake>
void make(const char* name, const Mistake& mistake) {
    try {
        mistake();
    } catch (const twinray::Error& error) {
        std::cout << "3: " << name << ": " << error.what() << '\n';
        return;
    }
    throw std::runtime_error(std::string(name) + " was not noticed");
}

void make_mistakes() {
    const Device device(RayTracing::off);
    make("hardware where there is none", [&] {
        const twinray::Context context(device.adopted());
        choose_accel(context.properties(), "hw");
    });
    make("a feature that is not enabled", [&] {
        twinray::AdoptedDevice adopted = device.adopted();
        adopted.enabled.scalar_block_layout = false;
        const twinray::Context context(adopted);
    });
    const Scene scene = make_scene(device);
    Renderer renderer(device, scene, size);
    Shadows shadows(device, scene, size);
    renderer.submit(scene, &shadows);
    make("a view of before a push", [&] {
        const twinray::AccelView view = shadows.accel().view();
        shadows.accel().push(twinray::make_icosphere(2));
        shadows.accel().sync();
        twinray::Commands commands(shadows.accel().context(), "stale");
        shadows.accel().trace(commands, view, {});
    });
    shadows.accel().push(twinray::make_icosphere(2), {}, {.non_opaque = true});
    make("a thing that wants a program", [&] { renderer.submit(scene, &shadows); });
}
// [/exercise3]

}  // namespace

int main() try {
    const Picture software = shadowed_picture(RayTracing::if_there, "sw");
    const Picture without = shadowed_picture(RayTracing::off, "auto");
    if (differing_pixels(software, without) > 0) throw twinray::Error("what is enabled changes the picture");
    const Device device(RayTracing::if_there);
    if (twinray::missing_for_hardware(device.adopted().enabled).empty()) {
        const std::size_t differing = differing_pixels(software, shadowed_picture(RayTracing::if_there, "hw"));
        std::cout << "1: " << differing << " of " << software.size() << " pixels differ\n";
        if (differing > software.size() / 1000) throw twinray::Error("the accelerators show different pictures");
    }
    trace_in_lent_memory();
    make_mistakes();
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
