#include <cmath>
#include <mutex>
#include <vector>

#include <twinray/analysis.h>
#include <twinray/queries.h>
#include <twinray/scene.h>
#include <twinray/twinray.h>

// Names that the pages' lines use.
void lines_of_a_page(twinray::Context& context, twinray::AbstractAccel& accel, const twinray::Mesh& mesh,
                     const std::vector<twinray::Ray>& rays, twinray::Ray ray) {
    using namespace twinray;
    BLOCK
}
