#include <vector>

#include <twinray/queries.h>
#include <twinray/twinray.h>

// Names that lines about collisions and distances use.
void lines_of_a_page(twinray::Context& context, const twinray::Scene& scene, twinray::AbstractAccel& accel,
                     twinray::AbstractAccel& accel_a, twinray::AbstractAccel& accel_b, twinray::AccelHandle handle_a,
                     twinray::AccelHandle handle_b, const std::vector<twinray::TrianglePair>& pairs,
                     const std::vector<twinray::dvec3>& points, double max_distance, double radius) {
    using namespace twinray;
    BLOCK
}
