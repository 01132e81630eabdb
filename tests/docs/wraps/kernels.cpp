INCLUDES
#include <array>
#include <span>
#include <vector>

#include <twinray/twinray.h>

struct MeshInfo {
    float density;
};
struct WaterArgs {
    twinray::Address positions;
};

// Names that lines about the user's kernels use.
void lines_of_a_page(twinray::Context& context, twinray::AbstractAccel& accel, twinray::Commands& commands,
                     const twinray::Mesh& mesh, const twinray::Mesh& leaf_mesh, const twinray::Transform& transform,
                     const std::vector<twinray::Bounds>& boxes, const std::vector<twinray::Ray>& rays,
                     const std::vector<twinray::Hit>& hits, const std::vector<float>& temperatures, MeshInfo info,
                     const twinray::Buffer& ray_buffer, const twinray::Buffer& hit_buffer,
                     const twinray::Buffer& sphere_buffer, const twinray::Buffer& vertices,
                     const twinray::Buffer& indices, const twinray::Buffer& counter, twinray::uint count, std::size_t n,
                     std::size_t most, twinray::TraceDesc desc, const twinray::Kernel<WaterArgs>& make_water,
                     WaterArgs args, twinray::uint cells) {
    using namespace twinray;
    { BLOCK }
}
